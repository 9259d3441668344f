//! A controller that a session has: a second session is refused by lock files.
//!
//! One lies in the folder of temporary files, which may be a session's own. The others lie in
//! [`COMMON_FOLDERS`], which all sessions of a computer see. The system releases the locks with the
//! process, also with one that is killed. Sessions on other machines, and other addresses of the
//! same controller, are not noticed. In the first file is whether the last session has parked, as
//! long as the system keeps that folder.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read as _, Seek as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};

use super::console;

/// Folders that all sessions of a computer see, whoever runs them and whatever their folder of
/// temporary files. Those that take no file are left out.
const COMMON_FOLDERS: &[&str] = if cfg!(target_os = "linux") {
    &["/dev/shm", "/run/lock", "/tmp"]
} else if cfg!(windows) {
    &["C:\\ProgramData"]
} else {
    &["/tmp", "/var/tmp"]
};

/// The lock of a controller, until it is dropped.
#[derive(Debug)]
pub struct Occupied {
    file: Option<File>,
    /// Locks in folders of all sessions, removed at the end.
    common: Vec<CommonLock>,
    /// The file has no other text than this program's: something else would be lost.
    is_own: bool,
    /// The session before has not parked.
    was_left: bool,
}

/// The file's text during a session, and after one that has not parked.
const NOT_PARKED_MARK: &str = "left";

impl Occupied {
    /// Takes the controller that `--to` names.
    ///
    /// # Errors
    /// Another session has it.
    pub fn take(target: &str) -> Result<Self> {
        let common: Vec<&Path> = COMMON_FOLDERS.iter().map(Path::new).collect();
        Self::take_in(&std::env::temp_dir(), &common, target)
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
            let text = if is_left { NOT_PARKED_MARK } else { "" };
            let _ = file.rewind().and_then(|()| file.set_len(0)).and_then(|()| file.write_all(text.as_bytes()));
        }
    }

    fn take_in(own: &Path, common: &[&Path], target: &str) -> Result<Self> {
        let name = name(target);
        let path = own.join(&name);
        let mut taken = Occupied { file: None, common: Vec::new(), is_own: false, was_left: false };
        let mut failure = None;
        match lock(&path) {
            Ok(file) => {
                let mut text = String::new();
                let is_read = (&file).take(1 + NOT_PARKED_MARK.len() as u64).read_to_string(&mut text).is_ok();
                taken.is_own = is_read && ["", NOT_PARKED_MARK].contains(&text.as_str());
                taken.was_left = text == NOT_PARKED_MARK;
                taken.file = Some(file);
            }
            Err(TryLockError::WouldBlock) => return Err(occupied(target, &path)),
            Err(TryLockError::Error(error)) => failure = Some((path, error)),
        }
        for folder in common.iter().filter(|folder| !is_same(folder, own)) {
            match CommonLock::take(folder.join(&name)) {
                Ok(lock) => taken.common.push(lock),
                Err(TryLockError::WouldBlock) => return Err(occupied(target, &folder.join(&name))),
                Err(TryLockError::Error(_)) => (),
            }
        }
        if let Some((path, error)) = failure.filter(|_| taken.common.is_empty()) {
            let file = path.display();
            console::line(&format!("no lock of the controller: {file}: {error}; a second session is not noticed"));
        }
        Ok(taken)
    }
}

fn occupied(target: &str, path: &Path) -> anyhow::Error {
    anyhow!("another session of moris-live sends to {target}; end it first (its lock is {})", path.display())
}

/// True for one folder under two names.
fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| fs::canonicalize(path).ok();
    real(one).is_some_and(|one| Some(one) == real(other))
}

/// A lock in a folder of all sessions. Its file is removed with it.
#[derive(Debug)]
struct CommonLock {
    path: PathBuf,
    _file: File,
}

impl CommonLock {
    /// Takes the lock of the file that is there under this name, not of one that has been removed.
    fn take(path: PathBuf) -> Result<Self, TryLockError> {
        // Times that a lock is tried whose file another session removes meanwhile.
        const LOCK_ATTEMPTS: u32 = 20;
        for _ in 0..LOCK_ATTEMPTS {
            let file = lock(&path)?;
            if is_there(&file, &path) {
                return Ok(CommonLock { path, _file: file });
            }
        }
        Err(TryLockError::WouldBlock)
    }
}

impl Drop for CommonLock {
    fn drop(&mut self) {
        // While it is locked: who opens it now finds it removed, and makes another one.
        let _ = fs::remove_file(&self.path);
    }
}

/// True if the open file is the one of this name.
#[cfg(unix)]
fn is_there(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let is_same = |one: fs::Metadata, other: fs::Metadata| (one.dev(), one.ino()) == (other.dev(), other.ino());
    file.metadata().and_then(|one| fs::metadata(path).map(|other| is_same(one, other))).unwrap_or(false)
}

/// An open file has its name there.
#[cfg(not(unix))]
fn is_there(_: &File, _: &Path) -> bool {
    true
}

fn lock(path: &Path) -> Result<File, TryLockError> {
    let file = open(path).map_err(TryLockError::Error)?;
    file.try_lock().map(|()| file)
}

/// Opens a regular file of any user, or makes it. A link in its place is not followed to make one.
/// Neither a pipe nor a device stops this program, or is touched.
fn open(path: &Path) -> io::Result<File> {
    let opened = || {
        if !fs::metadata(path)?.is_file() {
            return Err(io::Error::other("it is no regular file"));
        }
        options().write(true).open(path).or_else(|_| options().open(path))
    };
    let file = match opened() {
        Err(error) if error.kind() == ErrorKind::NotFound => match options().write(true).create_new(true).open(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => opened(),
            made => made,
        },
        opened => opened,
    }?;
    // It may have changed its place with another one since.
    if file.metadata()?.is_file() { Ok(file) } else { Err(io::Error::other("it is no regular file")) }
}

/// Options that wait for nobody at the other end.
fn options() -> OpenOptions {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags((rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY).bits() as i32);
    }
    options
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
        let take = |target: &str| Occupied::take_in(directory.path(), &[], target);
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
        assert!(Occupied::take_in(Path::new("/nowhere"), &[], "udp:127.0.0.1:5000").is_ok());
    }

    #[test]
    fn the_next_session_knows_whether_the_last_one_has_parked() {
        let directory = tempfile::tempdir().unwrap();
        let take = || Occupied::take_in(directory.path(), &[], "udp:127.0.0.1:5000").unwrap();
        assert!(!take().was_left());
        take().leave(true);
        assert!(take().was_left() && take().was_left());
        let mut parks = take();
        parks.leave(true);
        parks.leave(false);
        drop(parks);
        assert!(!take().was_left());
    }

    /// Two sessions whose folders of temporary files differ, as those of two users.
    #[test]
    fn sessions_with_folders_of_their_own_see_each_other() {
        let [one, other, common] = [(); 3].map(|()| tempfile::tempdir().unwrap());
        let take = |own: &tempfile::TempDir, target: &str| {
            Occupied::take_in(own.path(), &[Path::new("/nowhere"), common.path()], target)
        };
        let first = take(&one, "udp:127.0.0.1:5000").unwrap();
        let refused = take(&other, "udp:localhost:5000").unwrap_err().to_string();
        assert!(
            refused.contains("another session") && refused.contains(&common.path().display().to_string()),
            "{refused}"
        );
        take(&other, "udp:127.0.0.1:5001").unwrap();
        drop(first);
        // Nothing is left in the folder of all, and what a session has left is its own.
        assert_eq!(fs::read_dir(common.path()).unwrap().count(), 0);
        take(&one, "udp:127.0.0.1:5000").unwrap().leave(true);
        assert!(take(&one, "udp:127.0.0.1:5000").unwrap().was_left());
        assert!(!take(&other, "udp:127.0.0.1:5000").unwrap().was_left());
    }

    /// Sessions that begin and end all the time: one at a time has the controller.
    #[test]
    fn a_lock_that_is_removed_meanwhile_is_nobody_s() {
        use std::sync::atomic::{AtomicU32, Ordering};
        let common = tempfile::tempdir().unwrap();
        let [held, taken] = [0, 0].map(AtomicU32::new);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..500 {
                        let Ok(lock) = CommonLock::take(common.path().join("lock")) else { continue };
                        assert_eq!(held.fetch_add(1, Ordering::SeqCst), 0);
                        taken.fetch_add(1, Ordering::SeqCst);
                        held.fetch_sub(1, Ordering::SeqCst);
                        drop(lock);
                    }
                });
            }
        });
        assert!(taken.into_inner() > 100);
    }

    /// A pipe of the lock's name, which nobody writes, and a device.
    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_stops_nobody() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join(name("udp:127.0.0.1:5000"));
        assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
        assert!(open(&path).unwrap_err().to_string().contains("no regular file"));
        assert!(open(Path::new("/dev/null")).is_err());
        let common = tempfile::tempdir().unwrap();
        let take = || Occupied::take_in(directory.path(), &[common.path()], "udp:127.0.0.1:5000");
        let first = take().unwrap();
        assert!(take().is_err());
        drop(first);
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
        let mut taken = Occupied::take_in(directory.path(), &[], "udp:127.0.0.1:5000").unwrap();
        taken.leave(true);
        assert!(Occupied::take_in(directory.path(), &[], "udp:127.0.0.1:5000").is_err());
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
