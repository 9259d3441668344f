//! An FMU with embedded start values, packed, loaded and run as a host does it; and the same
//! from another FMU as base.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use moris_build_fmu::archive::pack;
use moris_build_fmu::model::WASHOUT;
use moris_build_fmu::{Base, FmiVersion, Start, build};
use moris_fmu_host::Fmu;
use moris_interface::guid;
use moris_setup::{NamedValues, load_rig, load_set, overlaid};
use moris_washout::{Input, Parameters, Washout};

/// Start values of a rig and a set that are not the default ones.
fn values() -> NamedValues {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/rigs/narrow.toml");
    let mut values = load_rig(&file).unwrap().values();
    values.extend(load_set("paper", WASHOUT.functions.identity.rows).unwrap());
    values
}

#[test]
fn the_fmu_starts_with_the_values_and_runs_as_the_crate_does_with_them() {
    let values = values();
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

/// An FMU with its model's own values in a directory with blanks and letters of other languages.
fn own(directory: &tempfile::TempDir, fmi: FmiVersion) -> PathBuf {
    let output = directory.path().join("Büro — モーション 1");
    build(&WASHOUT, &Start::own(&WASHOUT), fmi, &[], &output, |_| ()).unwrap().file
}

#[test]
fn from_a_base_comes_the_same_fmu_to_the_byte() {
    let directory = tempfile::tempdir().unwrap();
    let start = Start::with(&WASHOUT, &values()).unwrap();
    for &fmi in FmiVersion::ALL {
        let own = own(&directory, fmi);
        let built = build(&WASHOUT, &start, fmi, &[], directory.path(), |_| ()).unwrap().file;
        let base = Base::open(&own).unwrap();
        assert_eq!((base.model.name, base.fmi, base.platforms().count()), ("MorisWashout", fmi, 1));
        assert!(base.pack(&start).unwrap() == fs::read(&built).unwrap());
        // And back: the values of a base are replaced.
        assert!(Base::open(&built).unwrap().pack(&Start::own(&WASHOUT)).unwrap() == fs::read(&own).unwrap());
    }
}

/// The reason why an FMU with these files cannot be a base.
fn refusal(files: &BTreeMap<String, Vec<u8>>) -> String {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("base.fmu");
    fs::write(&file, pack(files).unwrap()).unwrap();
    Base::open(&file).err().expect("it must be refused").to_string()
}

#[test]
fn what_cannot_be_a_base_is_refused_with_the_reason() {
    let directory = tempfile::tempdir().unwrap();
    let start = Start::with(&WASHOUT, &values()).unwrap();
    let sound = unpack(&own(&directory, FmiVersion::Fmi2));
    let embedded = unpack(&build(&WASHOUT, &start, FmiVersion::Fmi2, &[], directory.path(), |_| ()).unwrap().file);
    let binary = sound.keys().find(|path| path.starts_with("binaries/")).unwrap().clone();
    let changed = |path: &str, change: &dyn Fn(&mut Vec<u8>)| {
        let mut files = sound.clone();
        change(files.get_mut(path).unwrap());
        refusal(&files)
    };
    let describe = |from: &str, to: &str| {
        let replace = |text: &mut Vec<u8>| *text = String::from_utf8_lossy(text).replace(from, to).into_bytes();
        changed("modelDescription.xml", &replace)
    };
    let place = sound[&binary].windows(16).position(|bytes| bytes == b"moris-start-here").unwrap();

    let refused = changed(&binary, &|library| library[place + 45] ^= 1);
    assert!(refused.contains("whose start values are damaged"), "{refused}");
    let refused = changed(&binary, &|library| library[place] ^= 1);
    assert!(refused.contains("without a place for start values"), "{refused}");
    let refused = changed(&binary, &|library| library[place + 16] = 9);
    assert!(refused.contains("another build of this version"), "{refused}");
    let version = format!(" version=\"{}\"", WASHOUT.functions.identity.version);
    let refused = describe(&version, " version=\"7.8.9\"");
    assert!(refused.contains("is of version 7.8.9") && refused.contains("from one release"), "{refused}");
    let refused = describe("modelName=\"MorisWashout\"", "modelName=\"Carousel\"");
    assert!(refused.contains("the model Carousel"), "{refused}");
    let refused = describe("modelName=\"MorisWashout\"", "modelName=\"Motorcycle\"");
    assert!(refused.contains("no library for a platform"), "{refused}");
    let refused = changed("modelDescription.xml", &|text| *text = b"<no".to_vec());
    assert!(refused.contains("cannot be read"), "{refused}");
    // The library of another FMU beside this one's description.
    let refused = changed(&binary, &|library| *library = embedded[&binary].clone());
    assert!(refused.contains("another build"), "{refused}");
    let mut mixed = sound.clone();
    let other =
        if binary.contains("win64") { "binaries/linux64/MorisWashout.so" } else { "binaries/win64/MorisWashout.dll" };
    mixed.insert(other.to_owned(), embedded[&binary].clone());
    let refused = refusal(&mixed);
    assert!(refused.contains("different start values") || refused.contains("another build"), "{refused}");

    let file = directory.path().join("no.fmu");
    fs::write(&file, b"no archive").unwrap();
    assert!(Base::open(&file).err().unwrap().to_string().contains("cannot be unpacked"));
    assert!(Base::open(&directory.path().join("missing.fmu")).err().unwrap().to_string().contains("cannot read"));
}

/// Such an archive can be packed by hand: the library itself refuses it then.
#[test]
fn a_library_refuses_damaged_values_and_the_description_of_another() {
    let directory = tempfile::tempdir().unwrap();
    let start = Start::with(&WASHOUT, &values()).unwrap();
    let sound = unpack(&own(&directory, FmiVersion::Fmi2));
    let embedded = unpack(&build(&WASHOUT, &start, FmiVersion::Fmi2, &[], directory.path(), |_| ()).unwrap().file);
    let binary = sound.keys().find(|path| path.starts_with("binaries/")).unwrap().clone();
    let refusal = |library: Vec<u8>| {
        let mut files = sound.clone();
        files.insert(binary.clone(), library);
        let file = directory.path().join("made-by-hand.fmu");
        fs::write(&file, pack(&files).unwrap()).unwrap();
        Fmu::open(&file).unwrap().instantiate("test").err().expect("it must be refused").to_string()
    };
    let mut damaged = embedded[&binary].clone();
    let place = damaged.windows(16).position(|bytes| bytes == b"moris-start-here").unwrap();
    damaged[place + 80] ^= 4;
    assert!(refusal(damaged).contains("start values in the shared library are damaged"));
    assert!(refusal(embedded[&binary].clone()).contains("do not belong together"));
}

fn unpack(archive: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut archive = zip::ZipArchive::new(fs::File::open(archive).unwrap()).unwrap();
    let names: Vec<String> = archive.file_names().map(str::to_owned).collect();
    let read = |name: String| {
        let mut bytes = Vec::new();
        archive.by_name(&name).unwrap().read_to_end(&mut bytes).unwrap();
        (name, bytes)
    };
    names.into_iter().map(read).collect()
}

/// A text file in an archive.
fn zip_entry(archive: &Path, name: &str) -> String {
    let mut archive = zip::ZipArchive::new(std::fs::File::open(archive).unwrap()).unwrap();
    std::io::read_to_string(archive.by_name(name).unwrap()).unwrap()
}
