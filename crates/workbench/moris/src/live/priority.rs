//! Priority, memory and core of the loop, where the system permits it.

use anyhow::Result;

/// Gives the calling thread a real-time priority, and keeps the program's memory from being swapped
/// out. Says what is permitted.
#[cfg(target_os = "linux")]
pub fn claim() -> String {
    use rustix::mm::{MlockAllFlags, mlockall};
    use thread_priority::{
        RealtimeThreadSchedulePolicy, ThreadPriority, ThreadSchedulePolicy, set_thread_priority_and_policy,
        thread_native_id,
    };
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    // Above what is ordinary, and below the system's own threads.
    let priority = match 50_u8.try_into().map(ThreadPriority::Crossplatform) {
        Ok(priority) => set_thread_priority_and_policy(thread_native_id(), priority, policy).map_err(|_| ()),
        Err(_) => Err(()),
    };
    // Without what comes later: the loop takes no more memory, and a limit on locked memory would
    // let other threads fail.
    let locked = mlockall(MlockAllFlags::CURRENT);
    let of_priority =
        if priority.is_ok() { "the loop has a real-time priority" } else { "no real-time priority permitted" };
    let of_memory = if locked.is_ok() { "memory is locked" } else { "no memory lock permitted" };
    format!("real time: {of_priority}, {of_memory}")
}

/// As above, where there is no such thing.
#[cfg(not(target_os = "linux"))]
pub fn claim() -> String {
    "real time: no real-time priority on this system".to_owned()
}

/// Checks that the loop can have this core of the processor, before anything moves.
///
/// # Errors
/// The program may not use this core.
#[cfg(target_os = "linux")]
pub fn check_core(core: usize) -> Result<()> {
    use rustix::thread::{CpuSet, sched_getaffinity};
    let usable = sched_getaffinity(None)?;
    let cores: Vec<String> =
        (0..CpuSet::MAX_CPU).filter(|core| usable.is_set(*core)).map(|core| core.to_string()).collect();
    let is_usable = core < CpuSet::MAX_CPU && usable.is_set(core);
    anyhow::ensure!(is_usable, "--core is {core}, but this program may use the cores {}", cores.join(", "));
    Ok(())
}

/// As above, where a thread cannot choose.
#[cfg(not(target_os = "linux"))]
pub fn check_core(_: usize) -> Result<()> {
    anyhow::bail!("--core needs Linux; leave it out")
}

/// Keeps the calling thread on this core.
///
/// # Errors
/// The system does not permit it.
#[cfg(target_os = "linux")]
pub fn keep_on(core: usize) -> Result<()> {
    use rustix::thread::{CpuSet, sched_setaffinity};
    let mut cores = CpuSet::new();
    cores.set(core);
    Ok(sched_setaffinity(None, &cores)?)
}

/// As above, where a thread cannot choose: [`check_core`] has refused before.
#[cfg(not(target_os = "linux"))]
pub fn keep_on(_: usize) -> Result<()> {
    Ok(())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_thread_stays_on_its_core() {
        use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu};
        let usable = sched_getaffinity(None).unwrap();
        let last = (0..CpuSet::MAX_CPU).rfind(|core| usable.is_set(*core)).unwrap();
        check_core(last).unwrap();
        let on = std::thread::spawn(move || {
            keep_on(last).unwrap();
            std::thread::yield_now();
            sched_getcpu()
        });
        assert_eq!(on.join().unwrap(), last);
        let refused = check_core(CpuSet::MAX_CPU).unwrap_err().to_string();
        assert!(refused.starts_with("--core is 1024, but this program may use the cores "), "{refused}");
    }
}
