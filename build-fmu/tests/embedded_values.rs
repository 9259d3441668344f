//! An FMU with embedded start values, compiled, packed, loaded and run as a host does it.

use std::path::Path;

use moris_build_fmu::model::WASHOUT;
use moris_build_fmu::{FmiVersion, Start, build};
use moris_fmu_host::Fmu;
use moris_interface::guid;
use moris_setup::{load_rig, load_set, overlaid};
use moris_washout::{Input, Parameters, Washout};

#[test]
fn the_fmu_starts_with_the_values_and_runs_as_the_crate_does_with_them() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/rigs/narrow.toml");
    let mut values = load_rig(&file).unwrap().values();
    values.extend(load_set("small-motions", WASHOUT.functions.identity.rows).unwrap());
    let start = Start::with(&WASHOUT, &values).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let built = build(&WASHOUT, &start, FmiVersion::Fmi2, &[], directory.path(), |line| println!("{line}")).unwrap();

    // Its description's GUID is another than the model's, and opening it shows that the library has it, too.
    let fmu = Fmu::open(&built.file).unwrap();
    let mut instance = fmu.instantiate("embedded").unwrap();
    assert!(Fmu::open(&built.file).unwrap().variable("gravity").is_some());
    let unpacked = zip_entry(&built.file, "modelDescription.xml");
    assert!(!unpacked.contains(&guid::<Washout>()), "the GUID is that of the model's own values");

    instance.initialize(&[], None).unwrap();
    for (name, value) in &values {
        assert_eq!(instance.get(name).unwrap().to_bits(), value.to_bits(), "{name}");
    }

    let mut washout = Washout::new(&overlaid(&Parameters::default(), &values)).unwrap();
    for step in 0..2000 {
        let time = f64::from(step) * 0.001;
        let mut input = Input::default();
        input.specific_force.x = (1.3 * time).sin();
        input.specific_force.y = 0.5 * (3.0 * time).sin();
        input.angular_velocity.z = 0.1 * time.sin();
        instance.set("vehicle.specificForce.x", input.specific_force.x).unwrap();
        instance.set("vehicle.specificForce.y", input.specific_force.y).unwrap();
        instance.set("vehicle.angularVelocity.z", input.angular_velocity.z).unwrap();
        assert_eq!(instance.do_step(time, 0.001), moris_fmu_host::Status::Ok);
        washout.step(&input, 0.001);
        let output = washout.output();
        for leg in 0..6 {
            let length = instance.get(&format!("actuator[{}].length", leg + 1)).unwrap();
            assert_eq!(length.to_bits(), output.length[leg].to_bits(), "leg {leg} after {time} s");
        }
        let felt = instance.get("rider.specificForce.x").unwrap();
        assert_eq!(felt.to_bits(), output.felt_specific_force.x.to_bits(), "after {time} s");
    }
}

/// A text file in an archive.
fn zip_entry(archive: &Path, name: &str) -> String {
    let mut archive = zip::ZipArchive::new(std::fs::File::open(archive).unwrap()).unwrap();
    std::io::read_to_string(archive.by_name(name).unwrap()).unwrap()
}
