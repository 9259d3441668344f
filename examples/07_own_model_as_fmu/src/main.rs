//! Packs the FMU of the low-pass: its model description and its library.
//!
//!     cargo run --bin moris-07_own_model_as_fmu
//!
//! Writes `target/fmu/LowPass.fmu`. `cargo build-fmu` adds documentation, a reference simulation
//! and libraries for other platforms; a model gets them by an entry in `build-fmu/src/model/`.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::error::Error;
use std::fs::{self, File};
use std::io::Write;

use LowPass::LowPass as Model;
use moris_model_description::{fmi2, to_xml};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const PLATFORM: &str = if cfg!(windows) {
    "win64"
} else if cfg!(target_os = "macos") {
    "darwin64"
} else {
    "linux64"
};

fn main() -> Result<(), Box<dyn Error>> {
    // cargo puts the library into this folder beside the program.
    let library = std::env::current_exe()?.with_file_name("deps").join(format!("{DLL_PREFIX}LowPass{DLL_SUFFIX}"));
    fs::create_dir_all("target/fmu")?;
    let mut fmu = ZipWriter::new(File::create("target/fmu/LowPass.fmu")?);
    fmu.start_file("modelDescription.xml", SimpleFileOptions::default())?;
    fmu.write_all(to_xml(&fmi2::describe::<Model>()).as_bytes())?;
    fmu.start_file(format!("binaries/{PLATFORM}/LowPass{DLL_SUFFIX}"), SimpleFileOptions::default())?;
    fmu.write_all(&fs::read(library)?)?;
    fmu.finish()?;
    println!("wrote target/fmu/LowPass.fmu");
    Ok(())
}
