//! Commands of the operator: lines on standard input.

use std::io::{ErrorKind, Read};
use std::thread;
use std::time::Duration;

use moris_live::{Event, Legs};
use rtrb::Producer;

use super::console;
use super::leg_position::PLACE_COMMANDS;
use super::lines::Lines;
use super::page::Order;

/// Names of the commands.
pub const COMMAND_NAMES: &str = "start, engage, disengage, park, stop, clear";

/// Standard input, which never stops this program.
#[cfg(unix)]
pub fn input() -> impl Read {
    super::terminal::Foreground::new(std::io::stdin())
}

/// Standard input.
#[cfg(not(unix))]
pub fn input() -> impl Read {
    std::io::stdin()
}

/// Passes lines on as commands until the input ends.
pub fn read(mut input: impl Read, mut commands: Producer<Order>) {
    let mut bytes = [0; 4096];
    let mut lines = Lines::default();
    loop {
        let count = match input.read(&mut bytes) {
            Ok(0) => return,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => {
                console::line(&format!("commands cannot be read any more: {error}; a signal parks and ends"));
                return;
            }
        };
        lines.take(&bytes[..count], |line| take(line, &mut commands));
    }
}

/// Takes a line, which may be anything.
fn take(line: &[u8], commands: &mut Producer<Order>) {
    let text = String::from_utf8_lossy(line);
    let word = text.trim();
    let order = Event::of_person(word).map(Order::Event).or_else(|| Legs::of_person(word).map(Order::Legs));
    match order {
        Some(order) => {
            // The loop takes them in its next step: none is lost, least of all a stop.
            while commands.push(order).is_err() && !commands.is_abandoned() {
                thread::sleep(Duration::from_millis(1));
            }
        }
        None if word.is_empty() => (),
        None => console::line(&format!("commands: {COMMAND_NAMES}; for the legs' place: {PLACE_COMMANDS}")),
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use rtrb::RingBuffer;

    use super::*;

    /// Input that a signal interrupts before each read.
    struct Interrupted<'a>(&'a [u8], bool);

    impl Read for Interrupted<'_> {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            self.1 = !self.1;
            if self.1 { Err(ErrorKind::Interrupted.into()) } else { self.0.read(out) }
        }
    }

    /// More lines at once than the loop's ring has room for, as from a clipboard.
    #[test]
    fn a_stop_behind_many_lines_is_not_lost() {
        let (commands, mut taken) = RingBuffer::new(8);
        let input = [b"engage\n".repeat(100), b"stop\n".to_vec()].concat();
        let reader = thread::spawn(move || read(&input[..], commands));
        let mut found = Vec::new();
        while !reader.is_finished() || !taken.is_empty() {
            found.extend(taken.pop());
        }
        assert_eq!((found.len(), found.last()), (101, Some(&Order::Event(Event::Stop))));
    }

    #[test]
    fn lines_are_commands_whatever_stands_between_them() {
        let (commands, mut taken) = RingBuffer::new(8);
        let long = [b'x'; 10_000];
        let input = [b"start\n\xFF\xFE\n", &long[..], b"stop\n park \r\n\0\nfault\nstop\nclear"].concat();
        read(Interrupted(&input, false), commands);
        let found: Vec<Order> = std::iter::from_fn(|| taken.pop().ok()).collect();
        // The end of a line that is too long is no command, and neither is a line without an end.
        assert_eq!(found, [Event::Start, Event::Park, Event::Stop].map(Order::Event));
    }
}
