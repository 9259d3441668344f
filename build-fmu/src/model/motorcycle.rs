//! The motorcycle with its rider.

use std::path::Path;

use moris_motorcycle::Motorcycle;
use moris_motorcycle::path::table::from_csv;

use moris_setup::{NamedValues, changed};

use super::{
    FmuModel, ModelFns, PREVIEW_MEMBERS, PREVIEW_TERMINAL, RIDER_TERMINAL, VEHICLE_MEMBERS, VEHICLE_TERMINAL, example,
    row_terminal, section,
};
use crate::Error;

/// The motorcycle's FMU.
pub const MOTORCYCLE: FmuModel = FmuModel {
    name: "Motorcycle",
    packages: ["moris-motorcycle-fmi2", "moris-motorcycle-fmi3"],
    libraries: ["Motorcycle", "Motorcycle_fmi3"],
    title: "Motorcycle: a vehicle and its rider",
    functions: ModelFns::from::<Motorcycle>(),
    derived_start_values: |_| NamedValues::new(),
    sections: &[section!("Motorcycle", "what", "Overview"), section!("Motorcycle", "connect", "Connections")],
    wording: &[example!("Motorcycle")],
    terminals: &[
        row_terminal("vehicle", VEHICLE_TERMINAL, VEHICLE_MEMBERS),
        row_terminal("preview", PREVIEW_TERMINAL, PREVIEW_MEMBERS),
        row_terminal("rider", RIDER_TERMINAL, &[("rider.lean", "lean")]),
    ],
    icon: include_bytes!("../../icons/Motorcycle.png"),
    reference_input: include_str!("../../reference/Motorcycle_in.csv"),
};

/// Start values of a motorcycle that rides the path of a CSV file.
///
/// # Errors
/// The file cannot be read, or is no path. Its values are checked with all start values.
pub fn path_values(file: &Path) -> Result<NamedValues, Error> {
    let text = moris_fmu_host::files::text(file, moris_fmu_host::files::MAX_TEXT_SIZE)
        .map_err(|reason| Error::Read { file: file.to_owned(), reason })?;
    let path = from_csv(&text).map_err(|reason| Error::Path { file: file.to_owned(), reason })?;
    Ok(changed(&path))
}
