//! Tables of formats and templates, shipped ones and a user's own.

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use moris_fmu_host::files::MAX_TEXT_SIZE;
use moris_live::{format, frame, moog};

/// Lists of tables.
#[derive(Clone, Debug, clap::Subcommand)]
pub enum List {
    /// List the formats of telemetry, or print the table of one
    Formats {
        /// Name of a format
        name: Option<String>,
    },
    /// List the templates of frames, or print one
    Frames {
        /// Name of a template
        name: Option<String>,
    },
}

/// Prints a list or a table.
///
/// # Errors
/// There is no table of this name.
pub fn main(list: &List, out: &mut dyn Write) -> Result<ExitCode> {
    match list {
        List::Formats { name: Some(name) } => write!(out, "{}", shipped("format", name, format::SHIPPED_FORMATS)?)?,
        List::Frames { name: Some(name) } if name == moog::FRAME_NAME => writeln!(out, "{}", moog::FRAME_DESCRIPTION)?,
        List::Frames { name: Some(name) } => write!(out, "{}", shipped("frames", name, frame::SHIPPED_FRAMES)?)?,
        List::Formats { name: None } => {
            for (name, text) in format::SHIPPED_FORMATS {
                writeln!(out, "{name:<14} {}", text.parse::<format::Format>()?.about)?;
            }
        }
        List::Frames { name: None } => {
            for (name, text) in frame::SHIPPED_FRAMES {
                writeln!(out, "{name:<14} {}", text.parse::<frame::Frames>()?.about)?;
            }
            writeln!(out, "{:<14} {}", moog::FRAME_NAME, moog::FRAME_DESCRIPTION)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The format of this name or in this file.
///
/// # Errors
/// There is none, or it cannot be used.
pub fn format(name: &str) -> Result<format::Format> {
    text("format", name, format::SHIPPED_FORMATS)?.parse().with_context(|| name.to_owned())
}

/// The template of this name or in this file.
///
/// # Errors
/// As [`format()`].
pub fn frames(name: &str) -> Result<frame::Frames> {
    text("frames", name, frame::SHIPPED_FRAMES)?.parse().with_context(|| name.to_owned())
}

fn text(option: &str, name: &str, tables: &[(&str, &'static str)]) -> Result<String> {
    match shipped(option, name, tables) {
        Ok(text) => Ok(text.to_owned()),
        Err(_) if name.ends_with(".toml") => {
            moris_fmu_host::files::text(Path::new(name), MAX_TEXT_SIZE).with_context(|| name.to_owned())
        }
        Err(error) => Err(error),
    }
}

fn shipped(option: &str, name: &str, tables: &[(&str, &'static str)]) -> Result<&'static str> {
    if let Some(text) = moris_live::shipped(tables, name) {
        return Ok(text);
    }
    let device = if option == "frames" { Some(moog::FRAME_NAME) } else { None };
    let names: Vec<&str> = tables.iter().map(|(name, _)| *name).chain(device).collect();
    bail!("--{option} is {name}, but must be a file whose name ends with .toml, or one of {}", names.join(", "))
}
