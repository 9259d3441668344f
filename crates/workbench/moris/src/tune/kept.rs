//! The parameter file, which is written whichever way a tuning ends.
//!
//! The first Ctrl-C ends the search after its generation, and the result is checked. The second one
//! ends the program at once: the best so far is written, without a check.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use anyhow::{Context, Result};
use moris_setup::Setup;
use moris_washout::Parameters;

use super::tuner::{BestSoFar, SoFar};
use moris_command_line::console;

/// The tuning in progress.
#[derive(Debug, Default)]
pub struct Kept(Mutex<Option<Current>>);

#[derive(Debug)]
struct Current {
    before: Setup,
    file: PathBuf,
    heading: String,
    so_far: Arc<SoFar>,
}

impl Kept {
    /// A tuning begins, whose result belongs into this file. The result is the place for its best
    /// so far.
    pub fn begin(&self, before: &Setup, file: &Path, heading: &str) -> Arc<SoFar> {
        let so_far = Arc::default();
        *self.lock() = Some(Current {
            before: before.clone(),
            file: file.to_owned(),
            heading: heading.to_owned(),
            so_far: Arc::clone(&so_far),
        });
        so_far
    }

    /// Writes the result of the tuning in progress, below this line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(&self, tuned: &Setup, first_line: &str) -> Result<()> {
        let mut current = self.lock();
        if let Some(current) = &*current {
            current.write(&tuned.parameters, first_line)?;
        }
        *current = None;
        Ok(())
    }

    /// Writes the best so far of the tuning in progress, with what is known of it. None where there
    /// is no tuning or nothing that keeps the constraints.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_so_far(&self) -> Result<Option<String>> {
        let current = self.lock();
        let Some(current) = &*current else { return Ok(None) };
        let Some(BestSoFar { parameters, is_checked }) = current.so_far.get() else { return Ok(None) };
        let check = if is_checked {
            "not tested on recordings left out"
        } else {
            "not checked in the internal steps that it will be used with"
        };
        let text = format!("the best so far, {check}");
        current.write(&parameters, &format!("Ended at once: {text}."))?;
        Ok(Some(format!("wrote {}: {text}", current.file.display())))
    }

    fn lock(&self) -> MutexGuard<'_, Option<Current>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Current {
    fn write(&self, parameters: &Parameters, first_line: &str) -> Result<()> {
        let found = Setup { parameters: *parameters, ..self.before.clone() };
        let text = found.parameter_file(&format!("{first_line}\n{}", self.heading));
        fs::write(&self.file, text).with_context(|| format!("cannot write {}", self.file.display()))
    }
}

/// True after Ctrl-C; a second one writes the best so far and ends the program. A reader of
/// standard error that is gone hinders neither.
///
/// # Errors
/// The signal cannot be had.
pub fn listen(kept: Arc<Kept>) -> Result<Arc<AtomicBool>> {
    // Exit status after a second Ctrl-C.
    const INTERRUPTED_STATUS: i32 = 130;
    let interrupted = Arc::new(AtomicBool::new(false));
    let pressed = Arc::clone(&interrupted);
    let handler = move || {
        if pressed.swap(true, Ordering::Relaxed) {
            console::line(&match kept.write_so_far() {
                Ok(Some(text)) => text,
                Ok(None) => "nothing is left to write".to_owned(),
                Err(error) => format!("{error:#}"),
            });
            console::flush();
            exit(INTERRUPTED_STATUS);
        }
        console::line(
            "ending after this generation; press Ctrl-C again to end at once with the best so far, unchecked",
        );
    };
    ctrlc::set_handler(handler).context("cannot listen for Ctrl-C")?;
    console::line("searching; Ctrl-C ends it and keeps the best so far");
    Ok(interrupted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_so_far_is_written_once_there_is_one_and_a_result_in_its_place() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("tuned.toml");
        let kept = Kept::default();
        assert_eq!(kept.write_so_far().unwrap(), None);
        let before = Setup::load(None, &[]).unwrap();
        let so_far = kept.begin(&before, &file, "Tuned on a ride");
        assert_eq!(kept.write_so_far().unwrap(), None);
        assert!(!file.exists());
        let with_scale = |scale: f64| {
            let mut parameters = before.parameters;
            parameters.conditioning.force_scale.x = scale;
            parameters
        };
        let written = || fs::read_to_string(&file).unwrap();
        for (scale, is_checked, known) in [(0.75, false, "not checked"), (0.5, true, "not tested on recordings")] {
            so_far.note(&with_scale(scale), is_checked);
            // A later search on other recordings changes nothing.
            if is_checked {
                so_far.note(&with_scale(0.1), false);
            }
            let text = kept.write_so_far().unwrap().unwrap();
            assert!(text.contains("the best so far") && text.contains(known), "{text}");
            assert!(written().contains(&format!("\"scale.specificForce.x\" = {scale}")), "{}", written());
            assert!(written().contains("# Tuned on a ride") && written().contains(known), "{}", written());
        }
        let tuned = Setup { parameters: with_scale(0.25), ..before.clone() };
        kept.finish(&tuned, "Better").unwrap();
        assert!(written().starts_with("# Better\n# Tuned on a ride"), "{}", written());
        // Nothing may overwrite the result.
        assert_eq!(kept.write_so_far().unwrap(), None);
    }
}
