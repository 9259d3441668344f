//! Start values embedded in an FMU: what is described, and what is refused before
//! anything is compiled.

use std::path::{Path, PathBuf};

use moris_build_fmu::contents::{Extras, contents};
use moris_build_fmu::model::{STEWART_PLATFORM, WASHOUT};
use moris_build_fmu::{FMU_MODELS, FmiVersion, FmuModel, Start};
use moris_model_description::fmi3::Layout;
use moris_setup::rig_file::RigFile;
use moris_setup::{NamedValues, load_rig, load_set};

fn rig(name: &str) -> RigFile {
    let file: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/rigs").join(name);
    load_rig(&file).unwrap()
}

/// A rig that is not the default and parameters that are not, in this order.
fn values() -> NamedValues {
    let mut values = rig("narrow.toml").values();
    values.extend(load_set("paper", WASHOUT.functions.identity.rows).unwrap());
    values
}

fn named(values: &[(&str, f64)]) -> NamedValues {
    values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect()
}

/// The reason why the washout cannot start with these values.
fn refusal(values: &NamedValues) -> String {
    Start::with(&WASHOUT, values).expect_err("these values must be refused").to_string()
}

fn start_of(model: &FmuModel, start: &Start, name: &str) -> f64 {
    start.slots()[model.functions.identity.slot(name).unwrap()]
}

#[test]
fn values_are_in_the_descriptions_under_another_guid() {
    let (own, embedded) = (Start::own(&WASHOUT), Start::with(&WASHOUT, &values()).unwrap());
    for &fmi in FmiVersion::ALL {
        let text = WASHOUT.model_description(fmi, &embedded);
        let token = |text: &str| {
            let document = roxmltree::Document::parse(text).unwrap();
            let root = document.root_element();
            root.attribute("guid").or(root.attribute("instantiationToken")).unwrap().to_owned()
        };
        assert_ne!(token(&text), token(&WASHOUT.model_description(fmi, &own)));
        let document = roxmltree::Document::parse(&text).unwrap();
        let start = |name: &str| {
            let variable = document.descendants().find(|node| node.attribute("name") == Some(name)).unwrap();
            let value =
                variable.attribute("start").or(variable.first_element_child().and_then(|real| real.attribute("start")));
            value.unwrap().to_owned()
        };
        assert_eq!(start("rig.neutralHeight"), "1.02");
        match fmi {
            FmiVersion::Fmi2 | FmiVersion::Fmi2Reals | FmiVersion::Fmi3(Layout::Scalars) => {
                assert_eq!((start("splitter.y.omega1"), start("rig.base[1].x")), ("2.5".into(), "0.95".into()))
            }
            FmiVersion::Fmi3(Layout::Arrays) => assert_eq!(start("splitter.omega1"), "2.5 2.5 2.5"),
        }
        let files = contents(&WASHOUT, &embedded, fmi, Vec::new(), &Extras::default());
        let listed = String::from_utf8(files["documentation/start-values.toml"].clone()).unwrap();
        assert!(
            listed.contains("\"splitter.y.omega1\" = 2.5") && listed.contains("\"rig.neutralHeight\" = 1.02"),
            "{listed}"
        );
        let page = String::from_utf8(files["documentation/index.html"].clone()).unwrap();
        assert!(page.contains("2.5") && page.contains(&token(&text)));
    }
}

/// Then the FMU is the one without options, to the byte.
#[test]
fn the_model_s_own_values_are_no_others() {
    let own = Start::own(&WASHOUT);
    let defaults = named(&[("splitter.x.omega1", 0.8), ("tilt.angleLimit", 0.257)]);
    assert_eq!(Start::with(&WASHOUT, &defaults).unwrap(), own);
    assert!(
        !contents(&WASHOUT, &own, FmiVersion::Fmi2, Vec::new(), &Extras::default())
            .contains_key("documentation/start-values.toml")
    );
}

#[test]
fn a_later_value_stands_over_an_earlier_one() {
    let start = Start::with(&WASHOUT, &named(&[("gravity", 9.8), ("gravity", 9.81)])).unwrap();
    assert_eq!((start.count(), start_of(&WASHOUT, &start, "gravity")), (1, 9.81));
}

#[test]
fn a_platform_s_commands_follow_its_rig() {
    let values = rig("narrow.toml").values();
    let start = Start::with(&STEWART_PLATFORM, &values).unwrap();
    let washout = Start::with(&WASHOUT, &values).unwrap();
    for leg in 1..=6 {
        let command = start_of(&STEWART_PLATFORM, &start, &format!("command[{leg}].length"));
        // What the washout commands at rest, and where the platform is.
        assert!((command - start_of(&WASHOUT, &washout, &format!("actuator[{leg}].length"))).abs() < 1e-12);
        assert!((command - start_of(&STEWART_PLATFORM, &start, &format!("actuator[{leg}].length"))).abs() < 1e-9);
    }
    let with_a_rig: Vec<&str> = FMU_MODELS.iter().filter(|model| model.has_rig()).map(|model| model.name).collect();
    assert_eq!(with_a_rig, ["MorisWashout", "StewartPlatform"]);
}

#[test]
fn what_a_washout_cannot_start_with_is_refused_with_the_reason() {
    let mut singular = rig("default.toml").values();
    for leg in 1..=6 {
        for axis in ["x", "y"] {
            let base = start_of(&WASHOUT, &Start::own(&WASHOUT), &format!("rig.base[{leg}].{axis}"));
            singular.push((format!("rig.platform[{leg}].{axis}"), 0.85 * base));
        }
    }
    singular.push(("rig.neutralHeight".to_owned(), 1.29));
    let message = refusal(&singular);
    assert!(message.contains("MorisWashout") && message.contains("singular inside the stroke"), "{message}");

    let message = refusal(&named(&[("actuator.minLength", 1.7)]));
    assert!(message.contains("actuator.minLength: is 1.7 m; it must be below actuator.maxLength, 1.6 m"), "{message}");
    let message = refusal(&named(&[("actuator.maxLength", 1.2)]));
    assert!(message.contains("outside its stroke"), "{message}");
    // The legs stop the platform before such a limit: a doubt, and no refusal.
    let start = Start::with(&WASHOUT, &named(&[("safety.z.positionLimit", 0.4)])).unwrap();
    let [doubt] = (WASHOUT.functions.warnings)(start.slots()).try_into().unwrap();
    assert!(doubt.contains("safety.z.positionLimit is 0.4 m, but in heave the rig reaches only 0.344 m"), "{doubt}");
    assert!((WASHOUT.functions.warnings)(Start::own(&WASHOUT).slots()).is_empty());
    let message = refusal(&named(&[("tilt.rateLimit", -0.1)]));
    assert!(message.contains("tilt.rateLimit"), "{message}");
}
