//! Priority and memory of the loop, where the system permits it.

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
