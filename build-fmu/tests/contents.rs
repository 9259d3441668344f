//! What is in an FMU and how it is packed, with stand-ins for the libraries.

use std::io::{Cursor, Read};

use build_fmu::archive::{Contents, pack};
use build_fmu::contents::contents;
use build_fmu::model::WASHOUT;
use build_fmu::{FmiVersion, MODELS, Platform};
use clap::ValueEnum;
use zip::ZipArchive;

fn with_every_platform(fmi: FmiVersion) -> Contents {
    let library = |&platform: &Platform| (platform, format!("library for {platform}").into_bytes());
    contents(&WASHOUT, fmi, Platform::value_variants().iter().map(library).collect())
}

fn washout_with_every_platform() -> Contents {
    with_every_platform(FmiVersion::Fmi2)
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
        "extra/org.fmi-standard.fmi-ls-ref/MorisWashout.exp",
        "extra/org.fmi-standard.fmi-ls-ref/MorisWashout_in.csv",
        "extra/org.fmi-standard.fmi-ls-ref/MorisWashout_ref.csv",
        "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml",
        "model.png",
        "modelDescription.xml",
    ];
    assert_eq!(paths, expected);
}

#[test]
fn an_fmu_holds_what_fmi_3_asks_for() {
    let contents = with_every_platform(FmiVersion::Fmi3);
    let paths: Vec<&str> = contents.keys().map(String::as_str).collect();
    let expected = [
        "binaries/aarch64-darwin/MorisWashout.dylib",
        "binaries/aarch64-linux/MorisWashout.so",
        "binaries/x86_64-darwin/MorisWashout.dylib",
        "binaries/x86_64-linux/MorisWashout.so",
        "binaries/x86_64-windows/MorisWashout.dll",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "modelDescription.xml",
        "terminalsAndIcons/icon.png",
    ];
    assert_eq!(paths, expected);
    let packed = std::str::from_utf8(&contents["modelDescription.xml"]).unwrap();
    assert_eq!(packed, include_str!("../../modelDescription/modelDescription.fmi3.xml"));
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
        let description = (model.fmi3_description)();
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
    for (fmi, icon) in [(FmiVersion::Fmi2, "model.png"), (FmiVersion::Fmi3, "terminalsAndIcons/icon.png")] {
        let contents = with_every_platform(fmi);
        let page = std::str::from_utf8(&contents["documentation/index.html"]).unwrap();
        check_page(page);
        assert!(page.contains(&format!("src=\"../{icon}\"")) && contents.contains_key(icon));
        let (this, other) = fmi.choose(("2", "3"), ("3", "2"));
        assert!(page.contains(&format!("FMI {this}.0")) && page.contains(&format!("fmi{this}Discard")));
        assert!(!page.contains(&format!("FMI {other}.0")) && !page.contains(&format!("fmi{other}")));
    }
}

fn check_page(page: &str) {
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

#[test]
fn the_documentation_of_fmi_3_has_its_names() {
    let page = String::from_utf8(with_every_platform(FmiVersion::Fmi3).remove("documentation/index.html").unwrap());
    let page = page.unwrap().replace("<wbr>", "").replace('\u{a0}', " ");
    for row in <moris_washout::Washout as model_interface::Model>::IDENTITY.rows {
        if row.causality != model_interface::Causality::Independent {
            assert!(page.contains(&format!("<td><code>{}</code>", row.array_name())), "{}", row.name);
        }
    }
    assert!(page.contains("<td>Float64 [6, 3]</td>"));
    assert!(!page.contains("actuator[1]"));
}

/// Variables that the hand-written sections name, as far as they are named in full.
#[test]
fn the_documentation_names_variables_that_exist() {
    let identity = <moris_washout::Washout as model_interface::Model>::IDENTITY;
    let scalars: Vec<String> = (0..identity.slots.len()).map(|slot| identity.variable_name(slot)).collect();
    let arrays: Vec<String> = identity.rows.iter().map(|row| row.array_name()).collect();
    for (fmi, names) in [(FmiVersion::Fmi2, scalars), (FmiVersion::Fmi3, arrays)] {
        let page = String::from_utf8(with_every_platform(fmi).remove("documentation/index.html").unwrap()).unwrap();
        let (_, body) = page.split_once("<main>").unwrap();
        let (written, _) = body.split_once("<section id=\"variables\">").unwrap();
        let mut checked = 0;
        for code in written.split("<code>").skip(1).map(|rest| rest.split("</code>").next().unwrap()) {
            let is_name = code.contains('.') && code.starts_with(|c: char| c.is_ascii_lowercase());
            if is_name {
                let known = names.iter().any(|name| {
                    name == code || name.starts_with(&format!("{code}.")) || name.starts_with(&format!("{code}["))
                });
                assert!(known, "{fmi}: {code}");
                checked += 1;
            }
        }
        assert!(checked > 20, "{fmi}: {checked}");
    }
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

#[test]
fn the_reference_ride_is_there_and_begins_at_rest() {
    let contents = washout_with_every_platform();
    let file = |name: &str| {
        let path = format!("extra/org.fmi-standard.fmi-ls-ref/{name}");
        std::str::from_utf8(contents.get(&path).unwrap_or_else(|| panic!("{path} is missing"))).unwrap()
    };
    let sources = |text: &str| -> Vec<String> {
        let document = roxmltree::Document::parse(text).unwrap();
        document.descendants().filter_map(|node| node.attribute("source")).map(str::to_owned).collect()
    };
    let experiments = sources(file("fmi-ls-manifest.xml"));
    assert_eq!(experiments.len(), 1);
    let tables = sources(file(&experiments[0]));
    let [input, output] = tables.as_slice() else { panic!("{tables:?}") };
    assert_eq!(file(input), WASHOUT.reference_input);

    let mut lines = file(output).lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let column = |name: &str| names.iter().position(|&other| other == name).unwrap_or_else(|| panic!("no {name}"));
    assert_eq!(rows.first().unwrap()[0], 0.0);
    assert_eq!(rows.last().unwrap()[0], 10.0);
    assert_eq!(rows[0][column("platform.position.z")], 1.091);
    assert_eq!(rows[0][column("rider.specificForce.z")], 9.80665);
    // The vehicle accelerates for two seconds and more: by then the platform is tilted nose up, which is negative.
    let two_seconds = rows.iter().find(|row| row[0] == 2.0).unwrap();
    assert!(two_seconds[column("tilt.pitch")] < -0.03);
    assert!(rows.iter().all(|row| row.len() == names.len()));
}
