//! A learned road in a file: one for each vehicle and track.

use std::ffi::OsString;
use std::fs::{File, remove_file, rename};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use moris_laps::Laps;
use moris_simulation::preview::Previewer;

use crate::error::{About, Result, ensure};
use crate::recording::Recording;

/// The road that recordings learn: each one its own, or all of them one that is kept in a file.
pub struct Kept<'a> {
    file: Option<&'a Path>,
    laps: Laps,
}

impl<'a> Kept<'a> {
    /// The road in this file, if there is one.
    ///
    /// # Errors
    /// As [`load`].
    pub fn open(file: Option<&'a Path>) -> Result<Self> {
        Ok(Kept { file, laps: file.map_or_else(|| Ok(Laps::new()), load)? })
    }

    /// The preview that a recording learns, and with a file those after it.
    ///
    /// # Errors
    /// The recording has no position.
    pub fn learn(&mut self, recording: &Recording) -> Result<Previewer> {
        if self.file.is_none() {
            self.laps = Laps::new();
        }
        Ok(recording.learned(&mut self.laps)?)
    }

    /// Writes the road to its file.
    ///
    /// # Errors
    /// As [`save`].
    pub fn save(&self) -> Result<()> {
        self.file.map_or(Ok(()), |file| save(file, &self.laps))
    }
}

/// The road in this file; an empty one if there is no file.
///
/// # Errors
/// The file cannot be read, or is none of a learned road. Its folder is missing, or takes no files:
/// the road would be lost at the end of a ride.
pub fn load(file: &Path) -> Result<Laps> {
    // Largest file [bytes]. A full memory has less than 4 MB.
    const MAX_FILE_SIZE: u64 = 16_000_000;
    check_is_writable("road", file)?;
    match moris_fmu_host::files::text(file, MAX_FILE_SIZE) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Laps::new()),
        text => {
            let text = text.about(|| file.display().to_string())?;
            Laps::of_text(&text).about(|| file.display().to_string())
        }
    }
}

/// Checks that the file's folder is there and takes files: what is learned would be lost at the end
/// of a ride.
///
/// # Errors
/// The folder is missing, or takes no file. `learned` names what is to be kept.
pub fn check_is_writable(learned: &str, file: &Path) -> Result<()> {
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        ensure!(folder.is_dir(), "{}: there is no folder {}", file.display(), folder.display());
    }
    let part = temporary_file(file);
    write_whole(&part, b"").and_then(|()| remove_file(&part)).about(|| cannot_keep(learned, file))
}

/// Writes the road to the file, as [`write_learned`].
///
/// # Errors
/// As [`write_learned`].
pub fn save(file: &Path, laps: &Laps) -> Result<()> {
    write_learned("road", file, &laps.text())
}

/// Writes a text with what was learned to the file, whole or not at all.
///
/// # Errors
/// The text cannot be written. The file is as before then.
pub fn write_learned(learned: &str, file: &Path, text: &str) -> Result<()> {
    // What a link points to is replaced, not the link.
    let target = file.canonicalize();
    let file = target.as_deref().unwrap_or(file);
    let part = temporary_file(file);
    let written = write_whole(&part, text.as_bytes()).and_then(|()| rename(&part, file));
    written
        .inspect_err(|_| {
            // Half of a text is of no use; if it cannot be removed, it stays beside the old one.
            let _ = remove_file(&part);
        })
        .about(|| cannot_keep(learned, file))
}

fn cannot_keep(learned: &str, file: &Path) -> String {
    format!("cannot keep the {learned} in {}", file.display())
}

/// A file in the same folder, so that it can take the other's place.
fn temporary_file(file: &Path) -> PathBuf {
    let mut name = file.file_name().map_or_else(OsString::new, OsString::from);
    name.push(format!(".{}.part", std::process::id()));
    file.with_file_name(name)
}

fn write_whole(file: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(file)?;
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use moris_laps::Sample;

    use super::*;

    #[test]
    fn a_road_is_kept_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("kart.laps");
        let mut laps = load(&file).unwrap();
        assert_eq!(laps.points().count(), 0);
        for k in 0..500 {
            let position = [f64::from(k), 0.0, 0.0];
            laps.step(&Sample { step: 0.05, position, speed: Some(20.0), force: [1.0, 2.0] });
        }
        save(&file, &laps).unwrap();
        let again = load(&file).unwrap();
        assert!(again.text() == laps.text() && again.points().count() > 450);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        #[cfg(unix)]
        {
            let [link, before] = ["link.laps", "kart.laps"].map(|name| folder.path().join(name));
            std::os::unix::fs::symlink(&before, &link).unwrap();
            save(&link, &Laps::new()).unwrap();
            assert!(link.is_symlink() && load(&before).unwrap().points().count() == 0);
            std::fs::remove_file(&link).unwrap();
        }
        let nowhere = folder.path().join("none").join("kart.laps");
        assert!(save(&nowhere, &laps).unwrap_err().to_string().starts_with("cannot keep the road in "));
        // Nobody creates a file there, not even root.
        let refused = load(Path::new("/proc/kart.laps")).map(|_| ()).unwrap_err().to_string();
        assert!(!cfg!(target_os = "linux") || refused.starts_with("cannot keep the road in "), "{refused}");
        std::fs::write(&file, "x,y\n").unwrap();
        assert!(load(&file).unwrap_err().with_sources(|_| String::new()).contains("none of a road"));
    }
}
