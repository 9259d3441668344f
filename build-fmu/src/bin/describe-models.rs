//! `cargo describe-models`: writes every model's descriptions into the files under
//! `modelDescription`. They are checked in, so that every change of an interface shows in a diff.

use std::fs;
use std::io;
use std::path::Path;
use std::process::ExitCode;

use clap::ValueEnum;
use moris_build_fmu::{FmiVersion, MODELS, Start, workspace};

fn main() -> ExitCode {
    for model in MODELS {
        for &fmi in FmiVersion::value_variants() {
            let file = workspace::root().join(model.checked_in_description(fmi));
            if let Err(error) = write(&file, &model.model_description(fmi, &Start::own(model))) {
                eprintln!("cannot write {}: {error}", file.display());
                return ExitCode::FAILURE;
            }
            println!("wrote {}", file.display());
        }
    }
    ExitCode::SUCCESS
}

fn write(file: &Path, text: &str) -> io::Result<()> {
    fs::create_dir_all(file.parent().unwrap_or(Path::new(".")))?;
    fs::write(file, text)
}
