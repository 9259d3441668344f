//! The recording of a session, by a thread of its own: a disk that hangs may stop it for ever.

use std::io::{self, BufWriter, ErrorKind, Write};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::Duration;

use moris_live::log::Entry;

/// Entries that wait at most: those of seconds with a thousand samples a second.
const QUEUE_CAPACITY: usize = 8192;

/// A recording.
#[derive(Debug)]
pub struct Recorder {
    entries: SyncSender<Entry>,
    ended: Receiver<io::Result<()>>,
}

impl Recorder {
    /// A recording to a file.
    ///
    /// # Errors
    /// The system has no thread for it.
    pub fn new(file: impl Write + Send + 'static) -> io::Result<Self> {
        let (entries, received) = sync_channel(QUEUE_CAPACITY);
        let (ends, ended) = sync_channel(1);
        let write = move || {
            let result = write(BufWriter::new(file), &received);
            let _ = ends.send(result);
            // Until then nobody sees that it has ended.
            drop(received);
        };
        thread::Builder::new().name("recorder".to_owned()).spawn(write)?;
        Ok(Recorder { entries, ended })
    }

    /// Takes an entry without waiting.
    ///
    /// # Errors
    /// The file cannot be written, or not in time: nothing more is recorded.
    pub fn take(&self, entry: Entry) -> io::Result<()> {
        match self.entries.try_send(entry) {
            Ok(()) => Ok(()),
            Err(TrySendError::Full(_)) => Err(hangs()),
            Err(TrySendError::Disconnected(_)) => self.ended.try_recv().unwrap_or_else(|_| Err(hangs())),
        }
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// The last entries cannot be written, or not in time.
    pub fn end(self) -> io::Result<()> {
        // Time in which the last entries must be written.
        const FINAL_WRITE_TIMEOUT: Duration = Duration::from_secs(2);
        drop(self.entries);
        self.ended.recv_timeout(FINAL_WRITE_TIMEOUT).unwrap_or_else(|_| Err(hangs()))
    }
}

fn write(mut file: impl Write, entries: &Receiver<Entry>) -> io::Result<()> {
    while let Ok(entry) = entries.recv() {
        writeln!(file, "{entry}")?;
    }
    file.flush()
}

fn hangs() -> io::Error {
    io::Error::new(ErrorKind::TimedOut, "its disk hangs")
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use moris_live::log::Happening;

    use super::*;

    /// A disk that takes nothing, and never answers or says so.
    struct Disk {
        hangs: bool,
    }

    impl Write for Disk {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            if self.hangs {
                thread::sleep(Duration::from_secs(600));
            }
            Err(ErrorKind::StorageFull.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_disk_that_hangs_or_is_full_stops_nobody() {
        for (hangs, expected) in [(true, ErrorKind::TimedOut), (false, ErrorKind::StorageFull)] {
            let recorder = Recorder::new(Disk { hangs }).unwrap();
            let begin = Instant::now();
            let mut taken = (0..4 * QUEUE_CAPACITY as u64).map(|step| {
                thread::sleep(Duration::from_micros(10));
                recorder.take(Entry { step, happening: Happening::Retune })
            });
            let error = taken.find_map(Result::err).unwrap();
            assert_eq!(error.kind(), expected);
            assert!(begin.elapsed() < Duration::from_secs(20));
        }
        // Few entries: the end sees it.
        let recorder = Recorder::new(Disk { hangs: true }).unwrap();
        recorder.take(Entry { step: 1, happening: Happening::Retune }).unwrap();
        assert_eq!(recorder.end().unwrap_err().kind(), ErrorKind::TimedOut);
    }
}
