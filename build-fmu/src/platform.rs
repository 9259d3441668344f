//! The platforms that an FMU can be for.

use std::fmt;

use crate::FmiVersion;

/// A platform, by the name of its directory in an FMU of FMI 2.0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Platform {
    /// Linux on x86-64, glibc 2.17 or newer
    Linux64,
    /// Windows on x86-64
    Win64,
    /// macOS on Intel; never run by us
    Darwin64,
    /// Linux on 64-bit ARM, glibc 2.17 or newer
    Aarch64Linux,
    /// macOS on Apple silicon; never run by us
    Aarch64Darwin,
}

impl Platform {
    /// Every platform.
    pub const ALL: &[Self] =
        &[Platform::Linux64, Platform::Win64, Platform::Darwin64, Platform::Aarch64Linux, Platform::Aarch64Darwin];

    /// The platform on which this program runs; none where FMI has no name for it.
    pub fn host() -> Option<Self> {
        match (std::env::consts::OS, std::env::consts::ARCH) {
            ("linux", "x86_64") => Some(Platform::Linux64),
            ("linux", "aarch64") => Some(Platform::Aarch64Linux),
            ("windows", "x86_64") => Some(Platform::Win64),
            ("macos", "x86_64") => Some(Platform::Darwin64),
            ("macos", "aarch64") => Some(Platform::Aarch64Darwin),
            _ => None,
        }
    }

    /// True for macOS.
    pub fn is_apple(self) -> bool {
        matches!(self, Platform::Darwin64 | Platform::Aarch64Darwin)
    }

    /// The directory under `binaries/`.
    pub fn directory(self, fmi: FmiVersion) -> &'static str {
        match self {
            Platform::Linux64 => fmi.choose("linux64", "x86_64-linux"),
            Platform::Win64 => fmi.choose("win64", "x86_64-windows"),
            Platform::Darwin64 => fmi.choose("darwin64", "x86_64-darwin"),
            Platform::Aarch64Linux => "aarch64-linux",
            Platform::Aarch64Darwin => "aarch64-darwin",
        }
    }

    /// The target for which rustc compiles.
    pub fn target(self) -> &'static str {
        match self {
            Platform::Linux64 => "x86_64-unknown-linux-gnu",
            Platform::Win64 => "x86_64-pc-windows-gnu",
            Platform::Darwin64 => "x86_64-apple-darwin",
            Platform::Aarch64Linux => "aarch64-unknown-linux-gnu",
            Platform::Aarch64Darwin => "aarch64-apple-darwin",
        }
    }

    /// The file that cargo makes of a library of this name.
    pub fn built_library(self, name: &str) -> String {
        match self {
            Platform::Win64 => self.packed_library(name),
            _ => format!("lib{}", self.packed_library(name)),
        }
    }

    /// The file name that FMI requires.
    pub fn packed_library(self, name: &str) -> String {
        match self {
            Platform::Linux64 | Platform::Aarch64Linux => format!("{name}.so"),
            Platform::Win64 => format!("{name}.dll"),
            Platform::Darwin64 | Platform::Aarch64Darwin => format!("{name}.dylib"),
        }
    }
}

impl fmt::Display for Platform {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(self.directory(FmiVersion::Fmi2))
    }
}
