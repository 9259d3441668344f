//! Priority, memory and core of the loop, where the system permits it.

#[cfg(target_os = "linux")]
pub use on_linux::{check_core, claim, claim_below, pin_to_core};
#[cfg(not(target_os = "linux"))]
pub use without::{check_core, claim, claim_below, pin_to_core};

#[cfg(target_os = "linux")]
mod on_linux {
    use anyhow::{Result, ensure};
    use rustix::mm::{MlockAllFlags, mlockall};
    use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
    use thread_priority::{
        RealtimeThreadSchedulePolicy, ThreadPriority, ThreadSchedulePolicy, set_thread_priority_and_policy,
        thread_native_id,
    };

    /// Priorities of the loop, and of threads that it needs on time: just below it.
    pub const OF_LOOP: u8 = 50;
    const OF_OTHERS: u8 = 48;

    /// Gives the calling thread a real-time priority. True if that is permitted.
    pub fn raise(priority: u8) -> bool {
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        let priority = priority.try_into().map(ThreadPriority::Crossplatform);
        priority.is_ok_and(|priority| set_thread_priority_and_policy(thread_native_id(), priority, policy).is_ok())
    }

    /// Gives the calling thread, which sends frames or receives telemetry, a priority just below
    /// the loop's where that is permitted.
    pub fn claim_below() {
        raise(OF_OTHERS);
    }

    /// Gives the calling thread, the loop's, a real-time priority, and keeps the program's memory
    /// from being swapped out. Says what is permitted.
    pub fn claim() -> String {
        // Above what is ordinary, and below the system's own threads.
        let is_raised = raise(OF_LOOP);
        // Without what comes later: the loop takes no more memory, and a limit on locked memory
        // would let other threads fail.
        let locked = mlockall(MlockAllFlags::CURRENT);
        let of_priority =
            if is_raised { "the loop has a real-time priority" } else { "no real-time priority permitted" };
        let of_memory = if locked.is_ok() { "memory is locked" } else { "no memory lock permitted" };
        format!("real time: {of_priority}, {of_memory}")
    }

    /// Checks that the loop can have this core of the processor, before anything moves.
    ///
    /// # Errors
    /// The program may not use this core.
    pub fn check_core(core: usize) -> Result<()> {
        let usable = sched_getaffinity(None)?;
        let cores: Vec<String> =
            (0..CpuSet::MAX_CPU).filter(|core| usable.is_set(*core)).map(|core| core.to_string()).collect();
        let is_usable = core < CpuSet::MAX_CPU && usable.is_set(core);
        ensure!(is_usable, "--core is {core}, but this program may use the cores {}", cores.join(", "));
        Ok(())
    }

    /// Keeps the calling thread on this core.
    ///
    /// # Errors
    /// The system does not permit it.
    pub fn pin_to_core(core: usize) -> Result<()> {
        let mut cores = CpuSet::new();
        cores.set(core);
        Ok(sched_setaffinity(None, &cores)?)
    }
}

/// The same where a thread cannot choose.
#[cfg(not(target_os = "linux"))]
mod without {
    use anyhow::{Result, bail};

    pub fn claim_below() {}

    pub fn claim() -> String {
        "real time: no real-time priority on this system".to_owned()
    }

    pub fn check_core(_: usize) -> Result<()> {
        bail!("--core needs Linux; leave it out")
    }

    /// Does nothing: [`check_core`] has refused before.
    pub fn pin_to_core(_: usize) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use super::on_linux::{OF_LOOP, raise};
    use super::*;

    #[test]
    fn threads_below_the_loop_are_raised_where_the_loop_is() {
        let stat = || std::fs::read_to_string("/proc/thread-self/stat").unwrap();
        // Fields 18 and 41 of proc(5): the priority, and the policy, 1 for SCHED_FIFO.
        let policy = |stat: &str| stat.rsplit(')').next().unwrap().split_whitespace().nth(38).unwrap().to_owned();
        let priority = |stat: &str| stat.rsplit(')').next().unwrap().split_whitespace().nth(15).unwrap().parse::<i32>();
        let of_loop = std::thread::spawn(move || (raise(OF_LOOP), stat())).join().unwrap();
        let below = std::thread::spawn(move || {
            claim_below();
            stat()
        });
        let below = below.join().unwrap();
        assert_eq!(policy(&below) == "1", of_loop.0);
        // Real-time priorities are below -1 there: the lower, the more urgent.
        assert!(!of_loop.0 || priority(&of_loop.1).unwrap() < priority(&below).unwrap());
    }

    #[test]
    fn a_thread_stays_on_its_core() {
        use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu};
        let usable = sched_getaffinity(None).unwrap();
        let last = (0..CpuSet::MAX_CPU).rfind(|core| usable.is_set(*core)).unwrap();
        check_core(last).unwrap();
        let on = std::thread::spawn(move || {
            pin_to_core(last).unwrap();
            std::thread::yield_now();
            sched_getcpu()
        });
        assert_eq!(on.join().unwrap(), last);
        let refused = check_core(CpuSet::MAX_CPU).unwrap_err().to_string();
        assert!(refused.starts_with("--core is 1024, but this program may use the cores "), "{refused}");
    }
}
