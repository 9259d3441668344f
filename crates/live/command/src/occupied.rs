//! A controller that a session has: a second session is refused by a lock file.
//!
//! The system releases the lock with the process, also with one that is killed. Sessions on other
//! machines, and other addresses of the same controller, are not noticed. In the file is whether
//! the last session has parked, as long as the system keeps its folder of temporary files.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read as _, Seek as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use super::console;

/// The lock of a controller, until it is dropped.
#[derive(Debug)]
pub struct Occupied {
    file: Option<File>,
    /// The file has no other text than this program's: something else would be lost.
    is_own: bool,
    /// The session before has not parked.
    was_left: bool,
}

/// The file's text during a session, and after one that has not parked.
const LEFT: &str = "left";

impl Occupied {
    /// Takes the controller that `--to` names.
    ///
    /// # Errors
    /// Another session has it.
    pub fn take(target: &str) -> Result<Self> {
        Self::take_in(&std::env::temp_dir(), target)
    }

    /// True if the session before has left the legs somewhere else than at the lowest pose: it was
    /// killed, has failed, or has been stopped.
    pub fn was_left(&self) -> bool {
        self.was_left
    }

    /// Keeps for the next session whether the legs are left somewhere. A file of another user stays
    /// as it is.
    pub fn leave(&mut self, is_left: bool) {
        if let Some(file) = self.file.as_mut().filter(|_| self.is_own) {
            let text = if is_left { LEFT } else { "" };
            let _ = file.rewind().and_then(|()| file.set_len(0)).and_then(|()| file.write_all(text.as_bytes()));
        }
    }

    fn take_in(directory: &Path, target: &str) -> Result<Self> {
        let path = directory.join(name(target));
        let locked = open(&path).map_err(TryLockError::Error).and_then(|file| file.try_lock().map(|()| file));
        match locked {
            Ok(file) => {
                let mut text = String::new();
                let is_read = (&file).take(1 + LEFT.len() as u64).read_to_string(&mut text).is_ok();
                let is_own = is_read && ["", LEFT].contains(&text.as_str());
                Ok(Occupied { file: Some(file), is_own, was_left: text == LEFT })
            }
            Err(TryLockError::WouldBlock) => {
                bail!("another session of moris-live sends to {target}; end it first (its lock is {})", path.display())
            }
            Err(TryLockError::Error(error)) => {
                let file = path.display();
                console::line(&format!("no lock of the controller: {file}: {error}; a second session is not noticed"));
                Ok(Occupied { file: None, is_own: false, was_left: false })
            }
        }
    }
}

/// Opens a file of any user, or makes it. A link in its place is not followed to make one.
fn open(path: &Path) -> std::io::Result<File> {
    let opened = || OpenOptions::new().read(true).write(true).open(path).or_else(|_| File::open(path));
    match opened() {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            match OpenOptions::new().read(true).write(true).create_new(true).open(path) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => opened(),
                made => made,
            }
        }
        opened => opened,
    }
}

/// Name of the lock file: one for all names of a host or a line.
fn name(target: &str) -> PathBuf {
    let plain = match target.split_once(':') {
        Some(("udp", address)) => {
            // That to which frames go: no address is this machine.
            let found = address.to_socket_addrs().ok().and_then(|mut all| all.find(SocketAddr::is_ipv4));
            let found = found.map(|mut address| {
                if address.ip().is_unspecified() {
                    address.set_ip(Ipv4Addr::LOCALHOST.into());
                }
                format!("udp:{address}")
            });
            found.unwrap_or_else(|| target.to_owned())
        }
        Some(("serial", line)) => {
            let line = line.rsplit_once(':').map_or(line, |(line, _)| line);
            let path = fs::canonicalize(line).unwrap_or_else(|_| line.into());
            format!("serial:{}", path.display())
        }
        _ => target.to_owned(),
    };
    let plain: String = plain.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    format!("moris-live-{plain}.lock").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_session_with_one_controller_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let take = |target: &str| Occupied::take_in(directory.path(), target);
        let first = take("udp:127.0.0.1:5000").unwrap();
        // Frames go by IPv4, and to no address means to this machine.
        for same in ["udp:127.0.0.1:5000", "udp:localhost:5000", "udp:0.0.0.0:5000"] {
            let refused = take(same).unwrap_err().to_string();
            assert!(refused.contains("another session") && refused.contains(".lock"), "{refused}");
        }
        take("udp:127.0.0.1:5001").unwrap();
        drop(first);
        take("udp:127.0.0.1:5000").unwrap();
        // Without a place for the lock the session goes on.
        assert!(Occupied::take_in(Path::new("/nowhere"), "udp:127.0.0.1:5000").is_ok());
    }

    #[test]
    fn the_next_session_knows_whether_the_last_one_has_parked() {
        let directory = tempfile::tempdir().unwrap();
        let take = || Occupied::take_in(directory.path(), "udp:127.0.0.1:5000").unwrap();
        assert!(!take().was_left());
        take().leave(true);
        assert!(take().was_left() && take().was_left());
        let mut parks = take();
        parks.leave(true);
        parks.leave(false);
        drop(parks);
        assert!(!take().was_left());
    }

    /// A link to something that is no lock, as somebody may have made in a folder of all users.
    #[cfg(unix)]
    #[test]
    fn what_is_no_lock_stays_as_it_is() {
        let directory = tempfile::tempdir().unwrap();
        let [theirs, link] =
            [PathBuf::from("theirs"), name("udp:127.0.0.1:5000")].map(|name| directory.path().join(name));
        fs::write(&theirs, "a letter").unwrap();
        std::os::unix::fs::symlink(&theirs, link).unwrap();
        let mut taken = Occupied::take_in(directory.path(), "udp:127.0.0.1:5000").unwrap();
        taken.leave(true);
        assert!(Occupied::take_in(directory.path(), "udp:127.0.0.1:5000").is_err());
        assert_eq!(fs::read_to_string(&theirs).unwrap(), "a letter");
    }

    #[cfg(unix)]
    #[test]
    fn a_line_has_one_lock_under_all_of_its_names() {
        let directory = tempfile::tempdir().unwrap();
        let [line, link] = ["line", "by-id"].map(|name| directory.path().join(name));
        fs::write(&line, "").unwrap();
        std::os::unix::fs::symlink(&line, &link).unwrap();
        let of = |path: &Path, baud: u32| name(&format!("serial:{}:{baud}", path.display()));
        assert_eq!(of(&line, 250_000), of(&link, 115_200));
    }
}
