//! Lists the scripts of the pages. Compiles the simulation for the report's page, and the ride, to
//! WebAssembly, and finds the commit.
//!
//! Where the target is not installed, rustup is asked to add it. Without rustup, without a network,
//! or with `RUSTUP_AUTO_INSTALL=0`, the files are empty: the report's page then does not simulate,
//! and there is no ride. Without git the version is that of the package alone.

use std::env;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const WEBASSEMBLY_TARGET: &str = "wasm32-unknown-unknown";

/// Directories of the workspace whose files the modules are compiled of.
const SOURCE_DIRECTORIES: [&str; 9] = [
    "src",
    "crates/interface",
    "crates/live/laps",
    "crates/simulator/motorcycle",
    "crates/workbench/pages/modules",
    "crates/workbench/pages/src",
    "crates/workbench/simulation",
    "Cargo.lock",
    "Cargo.toml",
];

/// Variables of the outer cargo that are for the host's code only.
const OF_THE_HOST: [&str; 6] = [
    "CARGO_BUILD_TARGET",
    "CARGO_ENCODED_RUSTFLAGS",
    "CARGO_TARGET_DIR",
    "RUSTC_WORKSPACE_WRAPPER",
    "RUSTFLAGS",
    "RUSTDOCFLAGS",
];

fn main() -> Result<(), Box<dyn Error>> {
    // Examples of the package that are modules, the feature that each takes, and what is missing
    // without one.
    const WEBASSEMBLY_MODULES: [(&str, &str, &str); 2] = [
        ("page_simulation", "", "the report's page will not simulate"),
        ("page_ride", "ride", "there will be no ride"),
    ];
    let root = PathBuf::from(build_variable("CARGO_MANIFEST_DIR")?).join("../../..");
    let out = PathBuf::from(build_variable("OUT_DIR")?);
    for source in SOURCE_DIRECTORIES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
    }
    println!("cargo::rerun-if-changed={}", root.join("crates/workbench/pages/page").display());
    fs::write(out.join("scripts.rs"), script_array(&root.join("crates/workbench/pages/page"))?)?;
    let version = build_variable("CARGO_PKG_VERSION")?;
    let version = source_commit(&root).map_or(version.clone(), |commit| format!("{version} ({commit})"));
    println!("cargo::rustc-env=MORIS_VERSION={version}");
    // The modules themselves are compiled with this package, too.
    let is_wanted = build_variable("TARGET")? != WEBASSEMBLY_TARGET && (is_installed()? || is_added()?);
    for (name, feature, missing) in WEBASSEMBLY_MODULES {
        let is_wanted = is_wanted && (feature.is_empty() || env::var_os("CARGO_FEATURE_RIDE").is_some());
        let module = if is_wanted { compile_module(&root, &out, [name, feature], missing)? } else { Vec::new() };
        fs::write(out.join(name).with_extension("wasm"), module)?;
    }
    Ok(())
}

/// An array of the path of each script below `pages`, and of its text.
fn script_array(pages: &Path) -> Result<String, Box<dyn Error>> {
    let mut paths = Vec::new();
    for folder in fs::read_dir(pages)? {
        for file in fs::read_dir(folder?.path())? {
            let path = file?.path();
            if path.extension().is_some_and(|extension| extension == "js") {
                let names = path.strip_prefix(pages)?.iter().map(|name| name.to_string_lossy());
                paths.push(names.collect::<Vec<_>>().join("/"));
            }
        }
    }
    paths.sort();
    let listed =
        |path: &String| format!("({path:?}, include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/page/{path}\"))),\n");
    Ok(format!("[\n{}]", paths.iter().map(listed).collect::<String>()))
}

fn build_variable(name: &str) -> Result<String, String> {
    env::var(name).map_err(|error| format!("{name}: {error}"))
}

/// The commit of the sources; none outside their own git repository. A new commit is noticed.
fn source_commit(root: &Path) -> Option<String> {
    let git = |arguments: &[&str]| -> Option<String> {
        let output = Command::new("git").current_dir(root).args(arguments).output().ok()?;
        let printed = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| printed.trim().to_owned())
    };
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if fs::canonicalize(top).ok()? != fs::canonicalize(root).ok()? {
        return None;
    }
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    for name in ["HEAD"].into_iter().chain(branch.as_deref()) {
        let file = root.join(git(&["rev-parse", "--git-path", name])?);
        if file.exists() {
            println!("cargo::rerun-if-changed={}", file.display());
        }
    }
    git(&["rev-parse", "--short=9", "HEAD"])
}

/// True if the compiler has the target's standard library.
fn is_installed() -> Result<bool, Box<dyn Error>> {
    Ok(rustc_directory(&["--print", "target-libdir", "--target", WEBASSEMBLY_TARGET])?.exists())
}

/// A directory that the compiler prints.
fn rustc_directory(what: &[&str]) -> Result<PathBuf, Box<dyn Error>> {
    let output = Command::new(build_variable("RUSTC")?).args(what).output()?;
    Ok(PathBuf::from(String::from_utf8(output.stdout)?.trim()))
}

/// Asks rustup for the target, if rustup has started this compiler and may install. True if it has
/// been added. Otherwise it is noticed when rustup installs it later.
fn is_added() -> Result<bool, Box<dyn Error>> {
    let is_forbidden = env::var("RUSTUP_AUTO_INSTALL").is_ok_and(|value| value == "0");
    if let (false, Ok(toolchain)) = (is_forbidden, env::var("RUSTUP_TOOLCHAIN")) {
        let asked =
            Command::new("rustup").args(["target", "add", WEBASSEMBLY_TARGET, "--toolchain", &toolchain]).output();
        let reason = match asked {
            Ok(asked) if asked.status.success() => {
                println!("cargo::warning=rustup has added the target {WEBASSEMBLY_TARGET}, for pages that simulate");
                return Ok(true);
            }
            Ok(asked) => first_error(&String::from_utf8_lossy(&asked.stderr)),
            Err(reason) => reason.to_string(),
        };
        println!("cargo::warning=rustup cannot add the target {WEBASSEMBLY_TARGET}, for pages that simulate: {reason}");
    }
    let components = rustc_directory(&["--print", "sysroot"])?.join("lib/rustlib/components");
    if components.exists() {
        println!("cargo::rerun-if-changed={}", components.display());
    }
    Ok(false)
}

/// A module, compiled in a directory of its own, because this build holds the lock of its
/// own. All profiles share it.
fn compile_module(
    root: &Path,
    out: &Path,
    [name, feature]: [&str; 2],
    missing: &str,
) -> Result<Vec<u8>, Box<dyn Error>> {
    const MODULE_PACKAGE: &str = "moris-pages";
    const MODULE_PROFILE: &str = "page-simulation";
    // Above the directories of the profile, of build scripts, of this package, and OUT_DIR itself.
    let directory = out.ancestors().nth(4).unwrap_or(out).join("page-simulation");
    let mut command = Command::new(build_variable("CARGO")?);
    command.current_dir(root).args([
        "rustc",
        "--locked",
        "--offline",
        "--package",
        MODULE_PACKAGE,
        "--profile",
        MODULE_PROFILE,
    ]);
    // Alone this kind of library is optimised as a whole.
    command.args(["--no-default-features", "--features", feature]);
    command.args(["--example", name, "--target", WEBASSEMBLY_TARGET, "--target-dir"]).arg(&directory);
    for name in OF_THE_HOST {
        command.env_remove(name);
    }
    // Two numbers at once: every browser since 2023 has it.
    let mut flags = vec!["-Ctarget-feature=+simd128".to_owned()];
    // Names in place of the directories of a machine that makes a release.
    let of_host = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    flags.extend(of_host.split('\u{1f}').filter(|flag| flag.starts_with("--remap-path-prefix=")).map(str::to_owned));
    command.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    let output = command.output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        println!("cargo::warning={missing}, because {name} does not compile: {}", last_lines(&said));
        return Ok(Vec::new());
    }
    Ok(fs::read(
        directory.join(WEBASSEMBLY_TARGET).join(MODULE_PROFILE).join("examples").join(name).with_extension("wasm"),
    )?)
}

/// The line of a message that begins with the error, without the stack below it.
fn first_error(text: &str) -> String {
    text.lines().find(|line| line.starts_with("error")).unwrap_or("it says no reason").to_owned()
}

/// The last lines of a message as one.
fn last_lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    lines[lines.len().saturating_sub(3)..].join("; ")
}
