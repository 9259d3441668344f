//! Contents of an FMU.

use crate::archive::Contents;
use crate::reference::{self, Stimuli};
use crate::{FmiVersion, FmuModel, Platform, Sources, Start, documentation, terminals};

/// Under which licences the FMU and its sources are: the choice is the user's.
pub const LICENCE_TEXT: &str = concat!(
    "MORIS washout may be used under either of the two licences below, at your option.\n\n",
    "=== MIT ===\n\n",
    include_str!("../../LICENSE-MIT"),
    "\n=== Apache 2.0 ===\n\n",
    include_str!("../../LICENSE-APACHE"),
);

/// Parts that an FMU may have beside its libraries.
#[derive(Default)]
pub struct Extras {
    /// Sources in C.
    pub sources: Option<Sources>,
    /// Terminals in an FMU of FMI 2.0. FMI Library 3.0, and so fmuCheck, takes their file's version
    /// for that of the FMU and reports a fatal error. FMUs of FMI 3.0 always have terminals.
    pub terminals: bool,
}

/// The files of a model's FMU of a version of FMI with these libraries and extras, which
/// start with these values.
pub fn contents(
    model: &FmuModel,
    start: &Start,
    fmi: FmiVersion,
    libraries: Vec<(Platform, Vec<u8>)>,
    Extras { sources, terminals }: &Extras,
) -> Contents {
    let mut contents = Contents::new();
    contents.insert("documentation/index.html".to_owned(), documentation::page(model, start, fmi).into_bytes());
    contents.insert("documentation/licenses/license.txt".to_owned(), LICENCE_TEXT.as_bytes().to_vec());
    contents.insert(fmi.icon_file().to_owned(), model.icon.to_vec());
    let description = match sources {
        None => model.model_description(fmi, start),
        Some(_) => model.model_description_with_sources(fmi, start),
    };
    contents.insert("modelDescription.xml".to_owned(), description.into_bytes());
    contents.extend(sources.iter().flat_map(|sources| sources.files(model, fmi)));
    if fmi.choose(*terminals, true) {
        contents.insert(terminals::TERMINALS_PATH.to_owned(), terminals::xml(model, fmi).into_bytes());
    }
    let input = Stimuli::new(model.reference_input);
    let output = (model.functions.reference_output)(&input, start.slots());
    let of_variables = |table: &str| {
        let as_arrays = || reference::as_arrays(&model.functions.identity, start.slots(), table);
        fmi.choose_names(table.to_owned(), as_arrays())
    };
    let (input_table, output_table) = (of_variables(model.reference_input), of_variables(&output));
    contents.extend(reference::files(model.name, input.end(), input_table, output_table));
    if !start.is_own() {
        contents.insert("documentation/start-values.toml".to_owned(), start.file(model).into_bytes());
    }
    for (platform, bytes) in libraries {
        let path = format!("binaries/{}/{}", platform.directory(fmi), platform.packed_library(model.name));
        contents.insert(path, bytes);
    }
    contents
}
