//! The terminal of a program in the background belongs to another one: a read of it would stop this
//! program, and with it the frames.

use std::io::{self, Read};
use std::os::fd::{AsFd, BorrowedFd};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::getpgrp;
use rustix::termios::tcgetpgrp;

use super::console;

/// Time between looks for input, and for the foreground.
const INPUT_CHECK_INTERVAL: Duration = Duration::from_millis(100);

/// Standard input, read while this program is in the foreground of its terminal.
pub struct Foreground<T> {
    input: T,
    is_told: bool,
}

impl<T: AsFd> Foreground<T> {
    /// Input that may be a terminal.
    pub fn new(input: T) -> Self {
        Foreground { input, is_told: false }
    }
}

impl<T: AsFd> Read for Foreground<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            let input = self.input.as_fd();
            if is_of_another(input) {
                if !std::mem::replace(&mut self.is_told, true) {
                    console::line("commands are read once this program is in the foreground; signals park and end");
                }
                std::thread::sleep(INPUT_CHECK_INTERVAL);
            } else if is_ready(input)? {
                return Ok(rustix::io::read(input, &mut *bytes)?);
            }
        }
    }
}

/// True for the terminal of another program in the foreground.
fn is_of_another(input: BorrowedFd) -> bool {
    tcgetpgrp(input).is_ok_and(|group| group != getpgrp())
}

/// Waits for a moment. True once there is something to read, or the end.
fn is_ready(input: BorrowedFd) -> io::Result<bool> {
    let mut polled = [PollFd::from_borrowed_fd(input, PollFlags::IN)];
    let most = Timespec { tv_sec: 0, tv_nsec: i64::from(INPUT_CHECK_INTERVAL.subsec_nanos()) };
    Ok(poll(&mut polled, Some(&most))? > 0)
}
