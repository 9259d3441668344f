//! The description of a system.

use moris_build_fmu::archive::pack;
use moris_systems::{Form, MOTORCYCLE_LAP, MOTORCYCLE_SIMULATOR, description};

#[test]
fn a_systems_description_is_the_same_every_time() {
    for (form, parameters) in [(Form::Whole, "MotorcycleSimulator"), (Form::Flat, "washout")] {
        let contents = description(&MOTORCYCLE_SIMULATOR, form).unwrap();
        let paths: Vec<&str> = contents.keys().map(String::as_str).collect();
        let parameters = format!("resources/{parameters}.ssv");
        assert_eq!(paths, ["SystemStructure.ssd", "documentation/licenses/license.txt", &*parameters]);
        assert!(pack(&contents).unwrap() == pack(&description(&MOTORCYCLE_SIMULATOR, form).unwrap()).unwrap());
    }
    // Its parameters are start values of its FMUs.
    for form in [Form::Whole, Form::Flat] {
        let contents = description(&MOTORCYCLE_LAP, form).unwrap();
        assert!(contents.keys().eq(["SystemStructure.ssd", "documentation/licenses/license.txt"]));
    }
}
