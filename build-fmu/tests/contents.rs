//! What is in an FMU and how it is packed, with stand-ins for the libraries.

use std::io::{Cursor, Read};

use build_fmu::archive::{Contents, pack};
use build_fmu::contents::contents;
use build_fmu::model::WASHOUT;
use build_fmu::{MODELS, Platform};
use clap::ValueEnum;
use zip::ZipArchive;

fn washout_with_every_platform() -> Contents {
    let library = |&platform: &Platform| (platform, format!("library for {platform}").into_bytes());
    contents(&WASHOUT, Platform::value_variants().iter().map(library).collect())
}

#[test]
fn an_fmu_holds_what_fmi_asks_for() {
    let contents = washout_with_every_platform();
    let paths: Vec<&str> = contents.keys().map(String::as_str).collect();
    let expected = [
        "binaries/aarch64-darwin/MorisWashout.dylib",
        "binaries/aarch64-linux/MorisWashout.so",
        "binaries/darwin64/MorisWashout.dylib",
        "binaries/linux64/MorisWashout.so",
        "binaries/win64/MorisWashout.dll",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "model.png",
        "modelDescription.xml",
    ];
    assert_eq!(paths, expected);
}

#[test]
fn the_model_description_is_the_checked_in_one() {
    let packed = String::from_utf8(washout_with_every_platform().remove("modelDescription.xml").unwrap()).unwrap();
    assert_eq!(packed, include_str!("../../modelDescription/modelDescription.xml"));
}

#[test]
fn names_agree() {
    for model in MODELS {
        let description = (model.description)();
        assert_eq!(description.model_name, model.name);
        assert_eq!(description.co_simulation.model_identifier, model.name);
    }
}

#[test]
fn the_same_contents_give_the_same_bytes() {
    assert!(pack(&washout_with_every_platform()).unwrap() == pack(&washout_with_every_platform()).unwrap());
}

#[test]
fn the_archive_gives_back_what_was_put_in() {
    let contents = washout_with_every_platform();
    let mut archive = ZipArchive::new(Cursor::new(pack(&contents).unwrap())).unwrap();
    assert_eq!(archive.len(), contents.len());
    for (n, (path, bytes)) in contents.iter().enumerate() {
        let mut file = archive.by_index(n).unwrap();
        assert_eq!(file.name(), path, "files are in the order of their paths");
        assert_eq!(file.last_modified(), Some(zip::DateTime::default()), "{path}");
        assert_eq!(file.compression(), zip::CompressionMethod::Deflated, "{path}");
        let mut read = Vec::new();
        file.read_to_end(&mut read).unwrap();
        assert!(&read == bytes, "{path}");
    }
}

#[test]
fn the_documentation_is_complete_and_needs_no_network() {
    let contents = washout_with_every_platform();
    let page = std::str::from_utf8(&contents["documentation/index.html"]).unwrap();
    assert!(!page.contains("{{"), "a place was left empty");
    assert!(!page.contains("http"), "something comes from outside");
    for anchor in page.split("href=\"#").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        assert!(page.contains(&format!("id=\"{anchor}\"")), "there is no #{anchor}");
    }
    let described = (WASHOUT.description)().model_variables.variables;
    for variable in described.iter().filter(|variable| variable.name != "time") {
        assert!(page.contains(&variable.description), "{}", variable.name);
    }
}

/// Variables that the hand-written sections name, as far as they are named in full.
#[test]
fn the_documentation_names_variables_that_exist() {
    let names: Vec<String> =
        (WASHOUT.description)().model_variables.variables.into_iter().map(|variable| variable.name).collect();
    let mut checked = 0;
    for section in WASHOUT.sections {
        for code in section.html.split("<code>").skip(1).map(|rest| rest.split("</code>").next().unwrap()) {
            let is_name = code.contains('.') && code.starts_with(|c: char| c.is_ascii_lowercase());
            if is_name {
                let known = names.iter().any(|name| {
                    name == code || name.starts_with(&format!("{code}.")) || name.starts_with(&format!("{code}["))
                });
                assert!(known, "{}: {code}", section.anchor);
                checked += 1;
            }
        }
    }
    assert!(checked > 20);
}

#[test]
fn the_icon_is_the_same_every_time() {
    let icon = (WASHOUT.icon)();
    assert!(icon.starts_with(b"\x89PNG\r\n\x1a\n"));
    assert!(icon == (WASHOUT.icon)());
}

#[test]
fn the_licences_are_there() {
    let contents = washout_with_every_platform();
    let text = std::str::from_utf8(&contents["documentation/licenses/license.txt"]).unwrap();
    assert!(text.contains("MORIS washout contributors"));
    assert!(text.contains("Permission is hereby granted, free of charge"));
    assert!(text.contains("Apache License") && text.contains("END OF TERMS AND CONDITIONS"));
}
