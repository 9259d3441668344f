//! Standard error, for threads that no reader may stop.
//!
//! A reader that is gone, or does not read, stops no thread: one thread writes, and the others
//! leave it lines that may be lost.

use std::io::{Write, stderr};
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

/// Lines that wait at most; further ones are lost.
const MAX_WAITING_LINES: usize = 4096;

enum Line {
    Text(String),
    /// All lines before it are written.
    Mark(SyncSender<()>),
}

static LINES: OnceLock<SyncSender<Line>> = OnceLock::new();

/// Prints a line. The call neither waits nor fails.
pub fn line(text: &str) {
    let lines = LINES.get_or_init(|| start_writer(stderr()));
    let _ = lines.try_send(Line::Text(format!("{text}\n")));
}

/// Waits for a moment until all lines are written.
pub fn flush() {
    let Some(lines) = LINES.get() else { return };
    wait_for(lines);
}

/// Waits until the lines are written. False if their reader does not read.
fn wait_for(lines: &SyncSender<Line>) -> bool {
    // Time in which the last lines must be written.
    const LAST_LINES_TIME: Duration = Duration::from_millis(500);
    let (mark, written) = sync_channel(1);
    let end = Instant::now() + LAST_LINES_TIME;
    while lines.try_send(Line::Mark(mark.clone())).is_err() {
        if Instant::now() > end {
            return false;
        }
        thread::sleep(Duration::from_millis(1));
    }
    written.recv_timeout(LAST_LINES_TIME).is_ok()
}

/// The thread that writes. Nobody joins it: a reader that does not read may stop it for ever.
fn start_writer(out: impl Write + Send + 'static) -> SyncSender<Line> {
    let (lines, received) = sync_channel(MAX_WAITING_LINES);
    // Without a thread nothing is printed, and the session goes on.
    let _ = thread::Builder::new().name("console".to_owned()).spawn(move || write_lines(out, &received));
    lines
}

fn write_lines(mut out: impl Write, lines: &Receiver<Line>) {
    while let Ok(line) = lines.recv() {
        match line {
            // The reader may be gone.
            Line::Text(text) => drop(out.write_all(text.as_bytes())),
            Line::Mark(written) => drop(written.try_send(())),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, ErrorKind};
    use std::sync::{Arc, Mutex};

    use super::*;

    /// A reader that is gone after some bytes, or blocks.
    struct Reader {
        taken: Arc<Mutex<Vec<u8>>>,
        room: usize,
        blocks: bool,
    }

    impl Write for Reader {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let mut taken = self.taken.lock().unwrap();
            if taken.len() >= self.room {
                drop(taken);
                if self.blocks {
                    thread::sleep(Duration::from_secs(60));
                }
                return Err(ErrorKind::BrokenPipe.into());
            }
            taken.extend(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_that_is_gone_or_blocks_stops_nobody() {
        for blocks in [false, true] {
            let taken = Arc::default();
            let lines = start_writer(Reader { taken: Arc::clone(&taken), room: 8, blocks });
            let begin = Instant::now();
            for _ in 0..3 * MAX_WAITING_LINES {
                let _ = lines.try_send(Line::Text("line\n".to_owned()));
            }
            assert_eq!(wait_for(&lines), !blocks);
            assert!(begin.elapsed() < Duration::from_secs(5));
            assert!(taken.lock().unwrap().starts_with(b"line\nline\n"));
        }
    }
}
