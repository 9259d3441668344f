//! Writes the washout's model descriptions into the files that are checked in beside this crate.

use std::path::Path;
use std::process::ExitCode;

use model_description::{describe, fmi3, to_xml};
use moris_washout::Washout;

fn main() -> ExitCode {
    let files = [
        ("modelDescription.xml", to_xml(&describe::<Washout>())),
        ("modelDescription.fmi3.xml", to_xml(&fmi3::describe::<Washout>())),
    ];
    for (name, text) in files {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        if let Err(error) = std::fs::write(&file, text) {
            eprintln!("cannot write {}: {error}", file.display());
            return ExitCode::FAILURE;
        }
        println!("wrote {}", file.display());
    }
    ExitCode::SUCCESS
}
