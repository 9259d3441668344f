//! Checks of libraries before they are shipped: sound and unsound ones, compiled here by rustc.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use moris_build_fmu::library::{LibraryError, LibraryInfo, examine};
use moris_fmi::fmi2::calling_sequence::NAMES as FMI2_FUNCTIONS;
use moris_fmi::fmi3::calling_sequence::NAMES as FMI3_FUNCTIONS;

/// A library that exports these names.
fn library(test: &str, names: &[&str], more: &str, arguments: &[&str]) -> Vec<u8> {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::create_dir_all(&directory).unwrap();
    let function = |name: &&str| format!("#[unsafe(no_mangle)] pub extern \"C\" fn {name}() {{}}\n");
    let source: String = names.iter().map(function).chain([more.to_owned()]).collect();
    let (file, built) = (directory.join("library.rs"), directory.join("built"));
    fs::write(&file, source).unwrap();
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let status = Command::new(rustc)
        .args(["--edition=2024", "--crate-type=cdylib", "--crate-name=library", "-Cstrip=symbols", "-Cpanic=abort"])
        .args(["-Anon_snake_case"])
        .args(arguments)
        .arg("-o")
        .args([&built, &file])
        .current_dir(&directory)
        .status()
        .unwrap();
    assert!(status.success());
    fs::read(built).unwrap()
}

#[test]
fn the_functions_of_the_header_and_nothing_else_are_fit() {
    let LibraryInfo { glibc, needs, size } =
        examine(&library("fit", FMI2_FUNCTIONS, "", &[]), FMI2_FUNCTIONS, &[]).unwrap();
    assert_eq!(glibc.is_some(), cfg!(target_env = "gnu") && cfg!(target_os = "linux"));
    assert!(!needs.is_empty());
    assert!(size > 0);
}

#[test]
fn a_function_that_lacks_is_found() {
    let library = library("lacks", &FMI2_FUNCTIONS[1..], "", &[]);
    assert_eq!(examine(&library, FMI2_FUNCTIONS, &[]), Err(LibraryError::Lacks(vec![FMI2_FUNCTIONS[0].to_owned()])));
}

#[test]
fn an_export_that_is_not_fmis_is_found() {
    let names = [FMI2_FUNCTIONS, &["fmi2Surprise"]].concat();
    let library = library("surprise", &names, "", &[]);
    assert_eq!(examine(&library, FMI2_FUNCTIONS, &[]), Err(LibraryError::Exports(vec!["fmi2Surprise".to_owned()])));
}

#[test]
fn a_library_of_one_version_of_fmi_is_none_of_the_other() {
    let fmi3 = library("fmi3", FMI3_FUNCTIONS, "", &[]);
    assert!(examine(&fmi3, FMI3_FUNCTIONS, &[]).is_ok());
    let mut lacking = FMI2_FUNCTIONS.to_vec();
    lacking.sort_unstable();
    assert!(matches!(examine(&fmi3, FMI2_FUNCTIONS, &[]), Err(LibraryError::Lacks(names)) if names == lacking));
}

#[test]
fn a_path_of_this_machine_is_found() {
    let private = PathBuf::from("/somebody/at/home");
    let more = "#[used] static PLACE: [u8; 25] = *b\"/somebody/at/home/file.rs\";";
    let library = library("private_path", FMI2_FUNCTIONS, more, &[]);
    assert_eq!(
        examine(&library, FMI2_FUNCTIONS, &[(private.clone(), "home")]),
        Err(LibraryError::PrivatePath(private))
    );
    assert!(examine(&library, FMI2_FUNCTIONS, &[(PathBuf::from("/somebody/else"), "home")]).is_ok());
}

#[cfg(target_os = "linux")]
#[test]
fn a_search_path_is_found() {
    let library = library("search_path", FMI2_FUNCTIONS, "", &["-Clink-arg=-Wl,-rpath,/somewhere"]);
    assert_eq!(examine(&library, FMI2_FUNCTIONS, &[]), Err(LibraryError::SearchPath));
}
