//! The motorcycle with its rider.

use std::fs;
use std::path::Path;

use moris_motorcycle::Motorcycle;
use moris_motorcycle::path::table::from_csv;

use moris_setup::{NamedValues, changed};

use super::{FmuModel, ModelFns, RIDER, VEHICLE, VEHICLE_MEMBERS, Wording, terminal};
use crate::documentation::Section;
use crate::{Error, icon};

/// The motorcycle's FMU.
pub const MOTORCYCLE: FmuModel = FmuModel {
    name: "Motorcycle",
    packages: ["moris-motorcycle-fmi2", "moris-motorcycle-fmi3"],
    libraries: ["Motorcycle", "Motorcycle_fmi3"],
    title: "Motorcycle: a vehicle and its rider",
    functions: ModelFns::from::<Motorcycle>(),
    derived_start_values: |_| NamedValues::new(),
    consistency: |_| Ok(()),
    sections: &[
        Section { anchor: "what", heading: "Overview", html: include_str!("../../documentation/Motorcycle/what.html") },
        Section {
            anchor: "connect",
            heading: "Connections",
            html: include_str!("../../documentation/Motorcycle/connect.html"),
        },
    ],
    wording: &[Wording {
        place: "example",
        fmi2: include_str!("../../documentation/Motorcycle/example.fmi2.html"),
        fmi3: include_str!("../../documentation/Motorcycle/example.fmi3.html"),
        fmi3_arrays: include_str!("../../documentation/Motorcycle/example.fmi3.arrays.html"),
    }],
    terminals: &[terminal("vehicle", VEHICLE, VEHICLE_MEMBERS), terminal("rider", RIDER, &[("rider.lean", "lean")])],
    icon: icon::motorcycle,
    reference_input: include_str!("../../reference/Motorcycle_in.csv"),
};

/// Start values of a motorcycle that rides the path of a CSV file.
///
/// # Errors
/// The file cannot be read, or is no path. Its values are checked with all start values.
pub fn path_values(file: &Path) -> Result<NamedValues, Error> {
    let text = fs::read_to_string(file).map_err(|reason| Error::Read { file: file.to_owned(), reason })?;
    let path = from_csv(&text).map_err(|reason| Error::Path { file: file.to_owned(), reason })?;
    Ok(changed(&path))
}
