//! Writes the washout's model description into the file that is checked in beside this crate.

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription.xml");
    let description = model_description::describe::<moris_washout::Washout>();
    match std::fs::write(&file, model_description::to_xml(&description)) {
        Ok(()) => {
            println!("wrote {} ({} variables)", file.display(), description.model_variables.variables.len());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("cannot write {}: {error}", file.display());
            ExitCode::FAILURE
        }
    }
}
