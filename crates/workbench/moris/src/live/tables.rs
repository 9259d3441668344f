//! Tables of formats and templates, shipped ones and a user's own.

use std::fs;
use std::io::Write;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
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
        List::Formats { name: Some(name) } => write!(out, "{}", shipped(name, &format::SHIPPED)?)?,
        List::Frames { name: Some(name) } if name == moog::NAME => writeln!(out, "{}", moog::ABOUT)?,
        List::Frames { name: Some(name) } => write!(out, "{}", shipped(name, &frame::SHIPPED)?)?,
        List::Formats { name: None } => {
            for (name, text) in format::SHIPPED {
                writeln!(out, "{name:<12} {}", text.parse::<format::Format>()?.about)?;
            }
        }
        List::Frames { name: None } => {
            for (name, text) in frame::SHIPPED {
                writeln!(out, "{name:<14} {}", text.parse::<frame::Frames>()?.about)?;
            }
            writeln!(out, "{:<14} {}", moog::NAME, moog::ABOUT)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The format of this name or in this file.
///
/// # Errors
/// There is none, or it cannot be used.
pub fn format(name: &str) -> Result<format::Format> {
    text(name, &format::SHIPPED)?.parse().with_context(|| name.to_owned())
}

/// The template of this name or in this file.
///
/// # Errors
/// As [`format()`].
pub fn frames(name: &str) -> Result<frame::Frames> {
    text(name, &frame::SHIPPED)?.parse().with_context(|| name.to_owned())
}

fn text(name: &str, tables: &[(&str, &'static str)]) -> Result<String> {
    match shipped(name, tables) {
        Ok(text) => Ok(text.to_owned()),
        Err(_) if name.ends_with(".toml") => fs::read_to_string(name).with_context(|| name.to_owned()),
        Err(error) => Err(error.context("a file's name ends with .toml")),
    }
}

fn shipped(name: &str, tables: &[(&str, &'static str)]) -> Result<&'static str> {
    match tables.iter().find(|(of, _)| *of == name) {
        Some((_, text)) => Ok(text),
        None => {
            let names: Vec<&str> = tables.iter().map(|(name, _)| *name).collect();
            bail!("there is no {name}, only {}", names.join(", "))
        }
    }
}
