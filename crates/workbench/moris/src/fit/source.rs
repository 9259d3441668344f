//! Recordings with conventions of their own.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::ValueEnum;

use crate::recording::conventions::Format;
use crate::recording::{ConventionOptions, FADE_IN, Recording};

/// A recording as written on the command line: `FILE`, or `FILE@CONVENTIONS` with a file of
/// conventions or the name of a logger's format.
///
/// # Errors
/// The conventions or the recording cannot be read.
pub fn recording(text: &Path, options: &ConventionOptions) -> Result<Recording> {
    let written = text.to_string_lossy();
    let (file, given) = match written.rsplit_once('@') {
        Some((file, given)) if !text.exists() => (PathBuf::from(file), Some(given)),
        _ => (text.to_owned(), None),
    };
    let own = match given {
        None => options.clone(),
        Some(given) if Path::new(given).is_file() => {
            ConventionOptions { conventions: Some(given.into()), ..options.clone() }
        }
        Some(given) => {
            let Ok(format) = Format::from_str(given, false) else {
                bail!("{given} after @ in {written} is neither a file of conventions nor a format; see --format");
            };
            ConventionOptions { format: Some(format), ..options.clone() }
        }
    };
    let conventions = own.load_or_fade_in(FADE_IN).with_context(|| written.to_string())?;
    Recording::read(&file, &conventions).with_context(|| file.display().to_string())
}
