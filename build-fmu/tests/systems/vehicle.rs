//! A vehicle's FMU in the place of the motorcycle.

use std::fs;
use std::path::Path;

use moris_build_fmu::archive::{Contents, pack};
use moris_build_fmu::ssp::Vehicle;

use crate::description::connections;

/// A vehicle with outputs of its own names, but for the rates.
fn description(fmi: &str) -> String {
    let outputs = ["acc_x", "acc_y", "acc_z", "vehicle.angularVelocity.x", "a<b"];
    let variable = |(reference, name): (usize, &str)| {
        let name = name.replace('<', "&lt;");
        format!(
            r#"<ScalarVariable name="{name}" valueReference="{reference}" causality="output"><Real unit="m/s2"/></ScalarVariable>"#
        )
    };
    let outputs: String = outputs.into_iter().enumerate().map(variable).collect();
    format!(
        r#"<fmiModelDescription fmiVersion="{fmi}" modelName="car" guid="1"><CoSimulation modelIdentifier="car"/><ModelVariables>
        <ScalarVariable name="pedal" valueReference="9" causality="input"><Real start="0"/></ScalarVariable>
        <ScalarVariable name="gear" valueReference="8" causality="output"><Integer/></ScalarVariable>{outputs}</ModelVariables>
        </fmiModelDescription>"#
    )
}

fn written(directory: &Path, fmi: &str) -> std::path::PathBuf {
    let file = directory.join("car.fmu");
    let contents = Contents::from([("modelDescription.xml".to_owned(), description(fmi).into_bytes())]);
    fs::write(&file, pack(&contents).unwrap()).unwrap();
    file
}

fn forces(count: usize) -> Vec<String> {
    ["x", "y", "z"][..count].iter().map(|axis| format!("acc_{axis}=vehicle.specificForce.{axis}")).collect()
}

#[test]
fn a_vehicle_is_connected_by_names_and_as_asked() {
    let directory = tempfile::tempdir().unwrap();
    let vehicle = Vehicle::open(&written(directory.path(), "2.0"), &forces(3)).unwrap();
    let all = connections(&vehicle.description);
    let own: Vec<_> = all
        .iter()
        .filter(|ends| ends[0] == "vehicle" && ends[2] == "washout")
        .map(|ends| (&*ends[1], &*ends[3]))
        .collect();
    assert_eq!(
        own,
        [
            ("acc_x", "vehicle.specificForce.x"),
            ("acc_y", "vehicle.specificForce.y"),
            ("acc_z", "vehicle.specificForce.z"),
            ("vehicle.angularVelocity.x", "vehicle.angularVelocity.x"),
        ]
    );
    // The platform follows the washout as before, and nothing is left of the motorcycle.
    assert!(all.iter().filter(|ends| ends[0] == "washout" && ends[2] == "platform").count() >= 12);
    assert!(!vehicle.description.contains("\"motorcycle\"") && !vehicle.description.contains("ParameterBinding"));
    assert!(vehicle.description.contains(r#"name="a&lt;b" kind="output""#));
    // Inputs that nothing is connected to have no connector.
    assert!(!vehicle.description.contains("rider.lean") && !vehicle.description.contains("pedal"));
}

#[test]
fn a_vehicle_that_cannot_be_connected_is_refused_with_the_remedy() {
    let directory = tempfile::tempdir().unwrap();
    let refusal = |fmi: &str, connected: &[String]| {
        let refused = Vehicle::open(&written(directory.path(), fmi), connected).err();
        refused.expect("it must be refused").to_string()
    };
    assert!(refusal("3.0", &forces(3)).contains("is not of FMI 2.0"));
    let open = "has no output vehicle.specificForce.z; name its own with --connect OUTPUT=vehicle.specificForce.z";
    assert!(refusal("2.0", &forces(2)).contains(open));
    assert!(refusal("2.0", &["gear=vehicle.speed".to_owned()]).contains("one of acc_x, acc_y"));
    assert!(refusal("2.0", &["acc_x=vehicle.force".to_owned()]).contains("cannot be connected to vehicle.force"));
    let no_file = Vehicle::open(&directory.path().join("none.fmu"), &[]).err().unwrap().to_string();
    assert!(no_file.contains("cannot read") && no_file.contains("none.fmu"), "{no_file}");
}
