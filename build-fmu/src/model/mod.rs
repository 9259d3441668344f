//! The models of which there are FMUs. A new one is a file here and an entry in [`FMU_MODELS`].

mod motorcycle;
mod stewart_platform;
mod washout;

use std::path::PathBuf;

use moris_interface::{Identity, Model, ParameterError, SlotModel, guid_of, start_values};
use moris_model_description::fmi2::Types;
use moris_model_description::{Element, fmi2, fmi3, to_xml};

use moris_setup::NamedValues;

use crate::reference::{self, Stimuli};
use crate::terminals::Terminal;
use crate::{FmiVersion, Sources, Start};

pub use motorcycle::{MOTORCYCLE, path_values};
pub use stewart_platform::STEWART_PLATFORM;
pub use washout::WASHOUT;

/// Every model, in the order in which they are built.
pub const FMU_MODELS: &[FmuModel] = &[WASHOUT, MOTORCYCLE, STEWART_PLATFORM];

/// A part of the documentation.
pub struct Section {
    /// Fragment of a link to the section.
    pub anchor: &'static str,
    pub heading: &'static str,
    /// Text under the heading, with placeholders in double braces: see [`FmuModel::wording`].
    pub html: &'static str,
}

/// Data of a model for the build.
pub struct FmuModel {
    /// The model's name, which in the FMU is also the shared library's.
    pub name: &'static str,
    /// The cargo packages that are the shared libraries for FMI 2.0 and for FMI 3.0.
    pub packages: [&'static str; 2],
    /// Cargo's names of the shared libraries for FMI 2.0 and for FMI 3.0.
    pub libraries: [&'static str; 2],
    /// A line that says what the model is: the documentation's title.
    pub title: &'static str,
    /// Functions derived from the model's table of variables and its step.
    pub functions: ModelFns,
    /// Start values of inputs that follow from those of parameters, by name, given all start
    /// values.
    pub derived_start_values: fn(start: &[f64]) -> NamedValues,
    /// The documentation's hand-written sections, in order; the variables follow them.
    pub sections: &'static [Section],
    /// Texts of the sections that depend on the version. Further places are `fmi`, the version's
    /// name, and `discard`, its status for a value that is not taken.
    pub wording: &'static [Wording],
    /// Groups of variables that a tool connects at once.
    pub terminals: &'static [Terminal],
    /// `model.png`, by which a tool shows the model.
    pub icon: &'static [u8],
    /// The input of the reference ride: a table for [`Stimuli::new`].
    pub reference_input: &'static str,
}

/// A place in the documentation's sections, and the text that stands there.
pub struct Wording {
    pub place: &'static str,
    pub fmi2: &'static str,
    pub fmi3: &'static str,
    pub fmi3_arrays: &'static str,
}

impl Wording {
    /// Names of variables: those of scalars, or of array variables.
    const fn names(place: &'static str, scalars: &'static str, arrays: &'static str) -> Self {
        Wording { place, fmi2: scalars, fmi3: scalars, fmi3_arrays: arrays }
    }

    /// A text for FMI 2.0 only.
    const fn fmi2_only(place: &'static str, text: &'static str) -> Self {
        Wording { place, fmi2: text, fmi3: "", fmi3_arrays: "" }
    }

    /// The text for a version.
    pub fn text(&self, fmi: FmiVersion) -> &'static str {
        fmi.choose(self.fmi2, fmi.choose_names(self.fmi3, self.fmi3_arrays))
    }
}

/// A section of a model's documentation; its text is in the file named as the anchor.
macro_rules! section {
    ($model:literal, $anchor:literal, $heading:literal) => {
        $crate::model::Section {
            anchor: $anchor,
            heading: $heading,
            html: include_str!(concat!("../../documentation/", $model, "/", $anchor, ".html")),
        }
    };
}
use section;

/// The example of a model's documentation, from its three files.
macro_rules! example {
    ($model:literal) => {
        $crate::model::Wording {
            place: "example",
            fmi2: include_str!(concat!("../../documentation/", $model, "/example.fmi2.html")),
            fmi3: include_str!(concat!("../../documentation/", $model, "/example.fmi3.html")),
            fmi3_arrays: include_str!(concat!("../../documentation/", $model, "/example.fmi3.arrays.html")),
        }
    };
}
use example;

/// Functions derived from a model. `start` has the start value of each slot.
pub struct ModelFns {
    /// Name, version and variables of the model.
    pub identity: Identity,
    /// The start values with overrides by slot.
    pub start: fn(overrides: &[(usize, f64)]) -> Vec<f64>,
    /// Checks that the model can start with these values.
    pub check: fn(start: &[f64]) -> Result<(), ParameterError>,
    /// Doubts about start values that the model accepts, in sentences.
    pub warnings: fn(start: &[f64]) -> Vec<String>,
    /// The GUID of the model with these start values.
    pub guid: fn(start: &[f64]) -> String,
    /// The model description of FMI 2.0.
    pub description: fn(start: &[f64], Types) -> Element,
    /// The model description of FMI 3.0.
    pub fmi3_description: fn(start: &[f64], fmi3::Layout) -> Element,
    /// The documentation's tables of variables for FMI 2.0.
    pub variables: fn(start: &[f64], Types) -> String,
    /// The documentation's tables for FMI 3.0.
    pub fmi3_variables: fn(start: &[f64], fmi3::Layout) -> String,
    /// The output that belongs to a reference ride's input.
    pub reference_output: fn(input: &Stimuli, start: &[f64]) -> String,
}

impl ModelFns {
    /// From the model of this type.
    const fn from<M: Model>() -> Self {
        ModelFns {
            identity: M::IDENTITY,
            start: start_values::<M>,
            check: |start| M::from_slots(start).map(drop),
            warnings: M::warnings_in,
            guid: guid_of::<M>,
            description: fmi2::describe_with::<M>,
            fmi3_description: fmi3::describe_with::<M>,
            variables: fmi2::variables_html::<M>,
            fmi3_variables: fmi3::variables_html::<M>,
            reference_output: reference::output::<M>,
        }
    }
}

/// Terminals of both ends of a connection: a motorcycle's outputs are a washout's inputs, say.
/// Kinds that are no standard's begin with an underscore.
const VEHICLE_TERMINAL: (&str, &str) =
    ("_moris.vehicle", "Motion of the vehicle at the rider's head, and the rider's lean");
const PREVIEW_TERMINAL: (&str, &str) = ("_moris.preview", "Specific force to come at the rider's head");
const RIDER_TERMINAL: (&str, &str) = ("_moris.rider", "Lean of the rider");
const ACTUATOR_TERMINAL: (&str, &str) = ("_moris.actuators", "Lengths and velocities of the six actuators");
const POSE_TERMINAL: (&str, &str) = ("_moris.platform", "Position, velocity and acceleration of the platform");

/// Members of a terminal of the vehicle.
const VEHICLE_MEMBERS: &[(&str, &str)] = &[
    ("vehicle.specificForce", "specificForce"),
    ("vehicle.angularVelocity", "angularVelocity"),
    ("vehicle.orientation", "orientation"),
    ("vehicle.speed", "speed"),
    ("rider.lean", "lean"),
];
/// Members of a terminal of the preview. The preview has a terminal of its own, because
/// few vehicles have one.
const PREVIEW_MEMBERS: &[(&str, &str)] = &[
    ("vehicle.preview.count", "count"),
    ("vehicle.preview.step", "step"),
    ("vehicle.preview.specificForce.x", "specificForce.x"),
    ("vehicle.preview.specificForce.y", "specificForce.y"),
];
/// Members of a terminal of the platform.
const POSE_MEMBERS: &[(&str, &str)] = &[
    ("platform.position", "position"),
    ("platform.velocity", "velocity"),
    ("platform.acceleration", "acceleration"),
    ("platform.orientation", "orientation"),
    ("platform.angularVelocity", "angularVelocity"),
];

const fn row_terminal(
    name: &'static str,
    (kind, text): (&'static str, &'static str),
    members: &'static [(&'static str, &'static str)],
) -> Terminal {
    Terminal { name, kind, text, members }
}

impl FmuModel {
    /// The cargo package that is the shared library.
    pub fn package(&self, fmi: FmiVersion) -> &'static str {
        fmi.choose(self.packages[0], self.packages[1])
    }

    /// Cargo's name of the shared library.
    pub fn library(&self, fmi: FmiVersion) -> &'static str {
        fmi.choose(self.libraries[0], self.libraries[1])
    }

    /// True for a model with a platform's joints.
    pub fn has_rig(&self) -> bool {
        self.functions.identity.slot("rig.neutralHeight").is_some()
    }

    /// The text of `modelDescription.xml`.
    pub fn model_description(&self, fmi: FmiVersion, start: &Start) -> String {
        match fmi {
            FmiVersion::Fmi2 => to_xml(&(self.functions.description)(start.slots(), Types::Own)),
            FmiVersion::Fmi2Reals => to_xml(&(self.functions.description)(start.slots(), Types::Reals)),
            FmiVersion::Fmi3(layout) => to_xml(&(self.functions.fmi3_description)(start.slots(), layout)),
        }
    }

    /// The text of `modelDescription.xml` in an FMU with sources. FMI 3.0 lists them
    /// in a file of its own.
    pub fn model_description_with_sources(&self, fmi: FmiVersion, start: &Start) -> String {
        let with_sources = |types| {
            let description = (self.functions.description)(start.slots(), types);
            to_xml(&fmi2::with_source_file(description, &Sources::file(self)))
        };
        match fmi {
            FmiVersion::Fmi2 => with_sources(Types::Own),
            FmiVersion::Fmi2Reals => with_sources(Types::Reals),
            FmiVersion::Fmi3(_) => self.model_description(fmi, start),
        }
    }

    /// The GUID or instantiation token by which a library knows the description.
    pub fn token(&self, fmi: FmiVersion, start: &Start) -> String {
        let guid = (self.functions.guid)(start.slots());
        match fmi {
            FmiVersion::Fmi2 => guid,
            FmiVersion::Fmi2Reals => Types::Reals.token(&guid),
            FmiVersion::Fmi3(layout) => layout.token(&guid),
        }
    }

    /// Where that text is checked in, in the workspace; that of FMI 3.0 with scalars.
    pub fn checked_in_description(&self, fmi: FmiVersion) -> PathBuf {
        let file = fmi.choose("modelDescription.xml", "modelDescription.fmi3.xml");
        ["modelDescription", self.name, file].iter().collect()
    }

    /// The documentation's tables of variables.
    pub fn variables(&self, fmi: FmiVersion, start: &Start) -> String {
        match fmi {
            FmiVersion::Fmi2 => (self.functions.variables)(start.slots(), Types::Own),
            FmiVersion::Fmi2Reals => (self.functions.variables)(start.slots(), Types::Reals),
            FmiVersion::Fmi3(layout) => (self.functions.fmi3_variables)(start.slots(), layout),
        }
    }
}
