//! `cargo describe-models` writes every model's descriptions into the files under
//! `modelDescription`. The tables that follow from the models go into the pages in `docs/`. Git has
//! both, so every change of an interface shows in a diff.

use std::fs;
use std::io;
use std::path::Path;
use std::process::ExitCode;

use moris_build_fmu::tables::{GENERATED_TABLES, Table};
use moris_build_fmu::{FMU_MODELS, FmiVersion, Start, workspace};

fn main() -> ExitCode {
    for model in FMU_MODELS {
        for &fmi in FmiVersion::SCALARS {
            let file = workspace::root().join(model.checked_in_description(fmi));
            if let Err(error) = write_in_folder(&file, &model.model_description(fmi, &Start::own(model))) {
                eprintln!("cannot write {}: {error}", file.display());
                return ExitCode::FAILURE;
            }
            println!("wrote {}", file.display());
        }
    }
    for table in GENERATED_TABLES {
        if let Err(error) = renew_table(table) {
            eprintln!("cannot write the table {} into {}: {error}", table.name, table.page);
            return ExitCode::FAILURE;
        }
        println!("wrote the table {} into {}", table.name, table.page);
    }
    ExitCode::SUCCESS
}

fn renew_table(table: &Table) -> io::Result<()> {
    let page = workspace::root().join(table.page);
    let text = table.within(&fs::read_to_string(&page)?);
    fs::write(page, text.ok_or_else(|| io::Error::other("the page has no place for it"))?)
}

fn write_in_folder(file: &Path, text: &str) -> io::Result<()> {
    fs::create_dir_all(file.parent().unwrap_or(Path::new(".")))?;
    fs::write(file, text)
}
