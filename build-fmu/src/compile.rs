//! Compiling a model's shared library for a platform.

use std::ffi::OsString;
use std::fmt;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::{Error, FmiVersion, FmuModel, Platform, macos_stub, tools, workspace};

/// Compilation plan of the library for a platform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    pub platform: Platform,
    pub linker: Linker,
}

/// The linker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linker {
    /// The machine that compiles.
    Host,
    /// The one that comes with Rust, for macOS on other systems.
    Lld,
    /// zig, by cargo-zigbuild, for Linux on another processor.
    Zig,
    /// GCC for Windows.
    Mingw,
}

/// Plans for libraries for these platforms, with all tools found; for this machine if the list is
/// empty.
///
/// # Errors
/// A tool that is missing, before anything is compiled.
pub fn plan(platforms: &[Platform]) -> Result<Vec<Plan>, Error> {
    if platforms.is_empty() {
        return Ok(vec![plan_for(Platform::host().ok_or(Error::NoHostPlatform)?)?]);
    }
    let mut platforms = platforms.to_vec();
    platforms.sort_unstable();
    platforms.dedup();
    platforms.into_iter().map(plan_for).collect()
}

/// For any machine with this platform.
fn plan_for(platform: Platform) -> Result<Plan, Error> {
    let linker = match platform {
        Platform::Linux64 | Platform::Aarch64Linux if Platform::host() == Some(platform) => Linker::Host,
        Platform::Linux64 | Platform::Aarch64Linux => Linker::Zig,
        Platform::Win64 => Linker::Mingw,
        Platform::Darwin64 | Platform::Aarch64Darwin if cfg!(target_os = "macos") => Linker::Host,
        // zig links for macOS too, but also exports Rust's internal names.
        Platform::Darwin64 | Platform::Aarch64Darwin => Linker::Lld,
    };
    match linker {
        Linker::Zig => tools::zigbuild(platform)?,
        Linker::Mingw => tools::mingw(platform)?,
        Linker::Lld => tools::zig_library(platform).map(drop)?,
        Linker::Host => {}
    }
    tools::standard_library(platform)?;
    Ok(Plan { platform, linker })
}

/// The profile of the workspace's manifest by which the libraries are compiled.
const LIBRARY_PROFILE: &str = "fmu-library";
/// Profile in which the WebAssembly is compiled that becomes sources in C.
pub const WEBASSEMBLY_PROFILE: &str = "page-simulation";

/// Compiles the model's library for a version of FMI and returns it.
///
/// # Errors
/// The compiler cannot be run or fails, or its result cannot be read.
pub fn compile(model: &FmuModel, fmi: FmiVersion, plan: &Plan) -> Result<Vec<u8>, Error> {
    run_cargo(&[(model, fmi)], plan)?;
    let built = plan.platform.built_library(model.library(fmi));
    let file = workspace::target_directory().join(plan.platform.target()).join(LIBRARY_PROFILE).join(built);
    fs::read(&file).map_err(|reason| Error::Read { file, reason })
}

/// Compiles several libraries by one call of cargo, so that
/// [`compile`] finds each of them done. The last stage of a library, which optimises it as a whole,
/// keeps one core busy: together they take a fraction of the time.
///
/// A library with flags of its own is left to [`compile`].
///
/// # Errors
/// The compiler cannot be run or fails.
pub fn compile_together(libraries: &[(&FmuModel, FmiVersion)], plan: &Plan) -> Result<(), Error> {
    if plan.is_alone() || libraries.is_empty() { Ok(()) } else { run_cargo(libraries, plan) }
}

/// Calls cargo for these libraries.
fn run_cargo(libraries: &[(&FmuModel, FmiVersion)], plan: &Plan) -> Result<(), Error> {
    let mut command = plan.cargo();
    command.args(["--profile", LIBRARY_PROFILE, "--target-dir"]).arg(workspace::target_directory());
    for (model, fmi) in libraries {
        command.args(["--package", model.package(*fmi)]);
    }
    command.current_dir(workspace::root()).env("CARGO_ENCODED_RUSTFLAGS", plan.rust_flags()?);
    if plan.linker == Linker::Lld {
        command.env("SDKROOT", macos_stub::development_kit(plan.platform)?);
    }
    if plan.linker == Linker::Mingw && cfg!(unix) {
        // By a variable: a flag would be part of the names of symbols.
        command.env("CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER", tools::mingw_linker()?);
        command.env("MORIS_TARGET_DIRECTORY", workspace::target_directory());
    }
    if plan.is_alone() {
        let (model, fmi) = libraries[0];
        command.args(plan.library_arguments(model.library(fmi)));
    }
    let status = command.status().map_err(|reason| Error::Run { program: "cargo".to_owned(), reason })?;
    if status.success() { Ok(()) } else { Err(Error::Compile { platform: plan.platform }) }
}

impl Plan {
    /// The cargo command that builds for the platform. The target is always named, so that the
    /// flags below hold for the library only and its build does not disturb the build of anything
    /// else.
    fn cargo(&self) -> Command {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        let subcommand = if self.is_alone() {
            "rustc"
        } else if self.linker == Linker::Zig {
            "zigbuild"
        } else {
            "build"
        };
        command.args([subcommand, "--target", &self.target()]);
        command
    }

    /// The target as cargo and cargo-zigbuild name it.
    fn target(&self) -> String {
        // The glibc that zig links for: that of RHEL 7, and the oldest that Rust supports.
        const OLDEST_GLIBC: &str = "2.17";
        match self.linker {
            Linker::Zig => format!("{}.{OLDEST_GLIBC}", self.platform.target()),
            Linker::Host | Linker::Lld | Linker::Mingw => self.platform.target().to_owned(),
        }
    }

    /// True if a library has flags of its own, which `cargo rustc` gives to it alone: what it uses
    /// is compiled once for all libraries.
    fn is_alone(&self) -> bool {
        self.platform.is_apple()
    }

    /// Arguments of cargo with the flags of a library of this name.
    fn library_arguments(&self, library: &str) -> Vec<String> {
        // A library for macOS carries its own name, by default the path at which it was linked.
        let name = format!("@rpath/{}", self.platform.packed_library(library));
        let through_compiler = if self.linker == Linker::Host { "-Wl," } else { "" };
        let flags =
            [format!("-Clink-arg={through_compiler}-install_name"), format!("-Clink-arg={through_compiler}{name}")];
        ["--".to_owned()].into_iter().chain(flags).collect()
    }

    /// rustc's flags, in the form of `CARGO_ENCODED_RUSTFLAGS`: no symbols but the exported ones,
    /// no directory of this machine, no time of day.
    fn rust_flags(&self) -> Result<OsString, Error> {
        let mut flags = path_flags()?;
        flags.insert(0, "-Cstrip=symbols".into());
        match self.linker {
            Linker::Mingw => flags.push("-Clink-arg=-Wl,--no-insert-timestamp".into()),
            Linker::Lld => flags.extend(["-Clinker=rust-lld".into(), "-Clinker-flavor=ld64.lld".into()]),
            Linker::Host | Linker::Zig => {}
        }
        Ok(encoded(&flags))
    }
}

/// rustc's flags by which a library shows no directory of this machine.
///
/// # Errors
/// rustc cannot be asked.
pub fn path_flags() -> Result<Vec<OsString>, Error> {
    let flag = |(path, name): (PathBuf, &str)| {
        let mut flag = OsString::from("--remap-path-prefix=");
        flag.push(path);
        flag.push(format!("={name}"));
        flag
    };
    Ok(workspace::private_paths()?.into_iter().map(flag).collect())
}

/// Flags in the form of `CARGO_ENCODED_RUSTFLAGS`.
pub fn encoded(flags: &[OsString]) -> OsString {
    flags.join(&OsString::from("\u{1f}"))
}

impl fmt::Display for Plan {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let linker = match self.linker {
            Linker::Host => "this machine's linker",
            Linker::Lld => "lld (untested)",
            Linker::Zig => "zig",
            Linker::Mingw => "GCC for Windows",
        };
        write!(formatter, "compiling for {}, linked by {linker}", self.target())
    }
}
