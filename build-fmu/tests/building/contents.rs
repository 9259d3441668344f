//! Contents and packing of an FMU, with stand-ins for the libraries.

use std::io::{Cursor, Read};

use moris_build_fmu::archive::{Contents, pack};
use moris_build_fmu::contents::{Extras, contents};
use moris_build_fmu::model::WASHOUT;
use moris_build_fmu::{FMU_MODELS, FmiVersion, FmuModel, Platform, Start, workspace};
use moris_model_description::Element;
use moris_model_description::fmi2::Types;
use moris_model_description::fmi3::Layout;
use zip::ZipArchive;

fn with_every_platform(model: &FmuModel, fmi: FmiVersion) -> Contents {
    let library = |&platform: &Platform| (platform, format!("library for {platform}").into_bytes());
    contents(model, &Start::own(model), fmi, Platform::ALL.iter().map(library).collect(), &Extras::default())
}

#[cfg(feature = "clap")]
#[test]
fn every_platform_is_listed() {
    assert_eq!(Platform::ALL, <Platform as clap::ValueEnum>::value_variants());
}

fn washout_with_every_platform() -> Contents {
    with_every_platform(&WASHOUT, FmiVersion::Fmi2)
}

/// The page of documentation in a model's FMU.
fn documentation(model: &FmuModel, fmi: FmiVersion) -> String {
    let page = with_every_platform(model, fmi).remove("documentation/index.html");
    String::from_utf8(page.expect("there is a page")).unwrap()
}

/// The names of a model's variables.
fn variable_names(model: &FmuModel, fmi: FmiVersion) -> Vec<String> {
    let identity = model.functions.identity;
    match fmi {
        FmiVersion::Fmi2 | FmiVersion::Fmi2Reals | FmiVersion::Fmi3(Layout::Scalars) => {
            (0..identity.slots.len()).map(|slot| identity.variable_name(slot)).collect()
        }
        FmiVersion::Fmi3(Layout::Arrays) => identity.rows.iter().map(|row| row.array_name()).collect(),
    }
}

#[test]
fn an_fmu_holds_what_fmi_asks_for() {
    let files = washout_with_every_platform();
    let paths: Vec<&str> = files.keys().map(String::as_str).collect();
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
    // Terminals on request; otherwise the same.
    let with_terminals = Extras { terminals: true, ..Extras::default() };
    let mut more = contents(&WASHOUT, &Start::own(&WASHOUT), FmiVersion::Fmi2, Vec::new(), &with_terminals);
    let terminals = String::from_utf8(more.remove("terminalsAndIcons/terminalsAndIcons.xml").unwrap()).unwrap();
    assert!(terminals.contains("terminalKind=\"_moris.vehicle\""), "a kind of nobody's begins with an underscore");
    assert!(more == contents(&WASHOUT, &Start::own(&WASHOUT), FmiVersion::Fmi2, Vec::new(), &Extras::default()));
}

#[test]
fn an_fmu_holds_what_fmi_3_asks_for() {
    let expected = [
        "binaries/aarch64-darwin/MorisWashout.dylib",
        "binaries/aarch64-linux/MorisWashout.so",
        "binaries/x86_64-darwin/MorisWashout.dylib",
        "binaries/x86_64-linux/MorisWashout.so",
        "binaries/x86_64-windows/MorisWashout.dll",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "extra/org.fmi-standard.fmi-ls-ref/MorisWashout.exp",
        "extra/org.fmi-standard.fmi-ls-ref/MorisWashout_in.csv",
        "extra/org.fmi-standard.fmi-ls-ref/MorisWashout_ref.csv",
        "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml",
        "modelDescription.xml",
        "terminalsAndIcons/icon.png",
        "terminalsAndIcons/terminalsAndIcons.xml",
    ];
    for layout in [Layout::Scalars, Layout::Arrays] {
        let contents = with_every_platform(&WASHOUT, FmiVersion::Fmi3(layout));
        let paths: Vec<&str> = contents.keys().map(String::as_str).collect();
        assert_eq!(paths, expected);
    }
}

#[test]
fn every_model_description_is_the_checked_in_one() {
    for model in FMU_MODELS {
        for &fmi in FmiVersion::SCALARS {
            let file = model.checked_in_description(fmi);
            let checked_in = std::fs::read_to_string(workspace::root().join(&file)).unwrap_or_default();
            let packed = with_every_platform(model, fmi).remove("modelDescription.xml").unwrap();
            assert!(
                packed == checked_in.into_bytes(),
                "{} is stale: run `cargo describe-models`, look at the diff, check it in",
                file.display()
            );
        }
    }
}

#[test]
fn names_agree() {
    for model in FMU_MODELS {
        let own = Start::own(model);
        let of_fmi3 = [Layout::Scalars, Layout::Arrays].map(|it| (model.functions.fmi3_description)(own.slots(), it));
        for description in [description(model)].iter().chain(&of_fmi3) {
            assert_eq!(attribute(description, "modelName"), Some(model.name));
            assert_eq!(attribute(part(description, "CoSimulation"), "modelIdentifier"), Some(model.name));
        }
    }
}

/// The model description of FMI 2.0 with the model's own start values.
fn description(model: &FmuModel) -> Element {
    (model.functions.description)(Start::own(model).slots(), Types::Own)
}

fn part<'a>(element: &'a Element, name: &str) -> &'a Element {
    element.children.iter().find(|child| child.name == name).unwrap_or_else(|| panic!("no {name}"))
}

fn attribute<'a>(element: &'a Element, name: &str) -> Option<&'a str> {
    element.attributes.iter().find(|attribute| attribute.0 == name).map(|attribute| attribute.1.as_str())
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
    for model in FMU_MODELS {
        for &fmi in FmiVersion::ALL {
            let icon = fmi.choose("model.png", "terminalsAndIcons/icon.png");
            let page = documentation(model, fmi);
            check_page(model, &page);
            assert!(page.contains(&format!("src=\"../{icon}\"")) && with_every_platform(model, fmi).contains_key(icon));
            let (this, other) = fmi.choose(("2", "3"), ("3", "2"));
            assert!(page.contains(&format!("FMI {this}.0")) && page.contains(&format!("fmi{this}Discard")));
            assert!(!page.contains(&format!("FMI {other}.0")) && !page.contains(&format!("fmi{other}")));
        }
    }
}

fn check_page(model: &FmuModel, page: &str) {
    assert!(!page.contains("{{"), "a place was left empty");
    assert!(!page.contains("http"), "something comes from outside");
    for anchor in page.split("href=\"#").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        assert!(page.contains(&format!("id=\"{anchor}\"")), "there is no #{anchor}");
    }
    let described = description(model);
    for variable in &part(&described, "ModelVariables").children {
        let [name, text] = ["name", "description"].map(|name| attribute(variable, name).unwrap());
        let text = text.replace('<', "&lt;").replace('>', "&gt;");
        assert!(name == "time" || page.contains(&text), "{name}");
    }
}

#[test]
fn the_documentation_of_arrays_has_their_names() {
    for model in FMU_MODELS {
        let page = documentation(model, FmiVersion::Fmi3(Layout::Arrays)).replace("<wbr>", "").replace('\u{a0}', " ");
        for row in model.functions.identity.rows {
            if row.causality != moris_interface::Causality::Independent {
                assert!(page.contains(&format!("<td><code>{}</code>", row.array_name())), "{}", row.name);
            }
        }
        assert!(!page.contains("actuator[1]"));
    }
    let page = |layout| documentation(&WASHOUT, FmiVersion::Fmi3(layout)).replace('\u{a0}', " ");
    assert!(page(Layout::Arrays).contains("<td>Float64 [6, 3]</td>"));
    assert!(page(Layout::Scalars).contains("<td>Float64</td>") && page(Layout::Scalars).contains("actuator[1]"));
}

/// Variables that the hand-written sections name, as far as they are named in full.
#[test]
fn the_documentation_names_variables_that_exist() {
    for model in FMU_MODELS {
        for &fmi in FmiVersion::ALL {
            let names = variable_names(model, fmi);
            let page = documentation(model, fmi);
            let (_, body) = page.split_once("<main>").unwrap();
            let (written, _) = body.split_once("<section id=\"variables\">").unwrap();
            let mut checked = 0;
            for code in written.split("<code>").skip(1).map(|rest| rest.split("</code>").next().unwrap()) {
                let is_name = code.contains('.') && code.starts_with(|c: char| c.is_ascii_lowercase());
                if is_name {
                    let known = names.iter().any(|name| {
                        name == code || name.starts_with(&format!("{code}.")) || name.starts_with(&format!("{code}["))
                    });
                    assert!(known, "{}, {fmi}: {code}", model.name);
                    checked += 1;
                }
            }
            assert!(checked > 9, "{}, {fmi}: {checked}", model.name);
        }
    }
}

#[test]
fn an_icon_is_a_square_png_of_256_pixels() {
    for model in FMU_MODELS {
        assert!(model.icon.starts_with(b"\x89PNG\r\n\x1a\n"));
        assert_eq!(&model.icon[12..24], b"IHDR\0\0\x01\0\0\0\x01\0");
    }
}

#[test]
fn the_licences_are_there() {
    let contents = washout_with_every_platform();
    let text = std::str::from_utf8(&contents["documentation/licenses/license.txt"]).unwrap();
    assert!(text.contains("MORIS washout contributors"));
    assert!(text.contains("Permission is hereby granted, free of charge"));
    assert!(text.contains("Apache License") && text.contains("END OF TERMS AND CONDITIONS"));
}

/// A model's reference ride: the files' texts by their names, the manifest's first.
fn reference_ride(model: &FmuModel, fmi: FmiVersion) -> [String; 4] {
    let contents = with_every_platform(model, fmi);
    let file = |name: &str| {
        let path = format!("extra/org.fmi-standard.fmi-ls-ref/{name}");
        String::from_utf8(contents.get(&path).unwrap_or_else(|| panic!("{path} is missing")).clone()).unwrap()
    };
    let sources = |text: &str| -> Vec<String> {
        let document = roxmltree::Document::parse(text).unwrap();
        document.descendants().filter_map(|node| node.attribute("source")).map(str::to_owned).collect()
    };
    let manifest = file("fmi-ls-manifest.xml");
    let [experiment] = sources(&manifest).try_into().unwrap();
    let experiment = file(&experiment);
    let [input, output]: [String; 2] = sources(&experiment).try_into().unwrap();
    [manifest, experiment, file(&input), file(&output)]
}

/// The columns' names and the rows of a comma-separated table.
fn table(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').collect();
    (names, lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect())
}

#[test]
fn a_reference_ride_is_there_and_has_every_real_output() {
    for model in FMU_MODELS {
        let ride = reference_ride(model, FmiVersion::Fmi2);
        assert_eq!(reference_ride(model, FmiVersion::Fmi3(Layout::Scalars)), ride, "names and values are the same");
        let [_, _, input, output] = ride;
        assert_eq!(input, model.reference_input);
        let (_, inputs) = table(&input);
        let (names, rows) = table(&output);
        assert!(rows.iter().all(|row| row.len() == names.len() && row.iter().all(|value| value.is_finite())));
        assert_eq!(rows.first().unwrap()[0], 0.0);
        assert_eq!(rows.last().unwrap()[0], inputs.last().unwrap()[0]);
        let described = description(model);
        let is_recorded = |variable: &&Element| {
            attribute(variable, "initial").is_some() && variable.children.iter().all(|values| values.name == "Real")
        };
        let variables = part(&described, "ModelVariables").children.iter();
        let expected: Vec<&str> = variables.filter(is_recorded).filter_map(|it| attribute(it, "name")).collect();
        assert_eq!(names[1..], expected, "{}", model.name);
    }
}

#[test]
fn the_washouts_reference_ride_is_as_expected() {
    let [_, _, _, output] = reference_ride(&WASHOUT, FmiVersion::Fmi2);
    let (names, rows) = table(&output);
    let column = |name: &str| names.iter().position(|&other| other == name).unwrap_or_else(|| panic!("no {name}"));
    assert_eq!(rows.last().unwrap()[0], 10.0);
    assert_eq!(rows[0][column("platform.position.z")], 1.091);
    assert_eq!(rows[0][column("rider.specificForce.z")], 9.80665);
    // The vehicle accelerates for two seconds and more: by then the platform is tilted nose up, which is negative.
    let two_seconds = rows.iter().find(|row| row[0] == 2.0).unwrap();
    assert!(two_seconds[column("tilt.pitch")] < -0.03);
}

/// The reference ride of array variables has the numbers of that of scalars, and start values
/// where that has no column.
#[test]
fn a_reference_ride_in_arrays_has_the_same_numbers() {
    for model in FMU_MODELS {
        let identity = &model.functions.identity;
        let start = Start::own(model);
        let [manifest, experiment, scalar_tables @ ..] = reference_ride(model, FmiVersion::Fmi2);
        let [manifest3, experiment3, array_tables @ ..] = reference_ride(model, FmiVersion::Fmi3(Layout::Arrays));
        assert_eq!((manifest, experiment), (manifest3, experiment3));
        for (scalars, arrays) in scalar_tables.iter().zip(&array_tables) {
            let (names, rows) = table(scalars);
            let mut lines = arrays.lines();
            let arrays: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!(lines.clone().count(), rows.len());
            let mut found = 0;
            for (line, row) in lines.zip(&rows) {
                for (array, cell) in arrays.iter().zip(line.split(',')) {
                    let elements = identity.rows.iter().find(|known| known.array_name() == *array);
                    let elements = elements.unwrap_or_else(|| panic!("{} has no {array}", model.name));
                    let cells: Vec<f64> = cell.split(' ').map(|value| value.parse().unwrap()).collect();
                    assert_eq!(cells.len(), elements.slots(), "{array}");
                    for (element, value) in cells.into_iter().enumerate() {
                        let name = elements.variable_name(element);
                        let column = names.iter().position(|known| *known == name);
                        found += usize::from(column.is_some());
                        let own = || start.slots()[identity.slot(&name).unwrap()];
                        assert_eq!(value, column.map_or_else(own, |column| row[column]), "{name}");
                    }
                }
            }
            assert_eq!(found, names.len() * rows.len());
        }
    }
}
