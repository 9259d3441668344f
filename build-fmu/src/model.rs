//! The models of which there are FMUs. A new one is a new entry in [`MODELS`].

use model_description::{ModelDescription, describe, fmi3, to_xml, variables_html};
use moris_washout::Washout;

use crate::FmiVersion;
use crate::documentation::Section;
use crate::icon;
use crate::reference::{self, Stimuli};

/// What the build needs to know of a model.
pub struct Model {
    /// The model's name, which in the FMU is also the shared library's.
    pub name: &'static str,
    /// The cargo packages that are the shared libraries for FMI 2.0 and for FMI 3.0.
    pub packages: [&'static str; 2],
    /// What cargo calls the shared libraries for FMI 2.0 and for FMI 3.0.
    pub libraries: [&'static str; 2],
    /// A line that says what the model is: the documentation's title.
    pub title: &'static str,
    /// Makes the model description of FMI 2.0.
    pub description: fn() -> ModelDescription,
    /// Makes that of FMI 3.0.
    pub fmi3_description: fn() -> fmi3::ModelDescription,
    /// Makes the documentation's tables of variables.
    pub variables: fn(FmiVersion) -> String,
    /// The documentation's hand-written sections, in order; the variables follow them.
    pub sections: &'static [Section],
    /// What the sections say differently: a place in them, what stands there for FMI 2.0, and what for FMI 3.0. Further
    /// places are `fmi`, the version's name, and `discard`, its status for a value that is not taken.
    pub wording: &'static [(&'static str, &'static str, &'static str)],
    /// Draws `model.png`.
    pub icon: fn() -> Vec<u8>,
    /// The input of the reference ride: a table for [`Stimuli::new`].
    pub reference_input: &'static str,
    /// Computes the output that belongs to it.
    pub reference_output: fn(&Stimuli) -> String,
}

impl Model {
    /// The cargo package that is the shared library.
    pub fn package(&self, fmi: FmiVersion) -> &'static str {
        fmi.choose(self.packages[0], self.packages[1])
    }

    /// What cargo calls the shared library.
    pub fn library(&self, fmi: FmiVersion) -> &'static str {
        fmi.choose(self.libraries[0], self.libraries[1])
    }

    /// The text of `modelDescription.xml`.
    pub fn model_description(&self, fmi: FmiVersion) -> String {
        match fmi {
            FmiVersion::Fmi2 => to_xml(&(self.description)()),
            FmiVersion::Fmi3 => to_xml(&(self.fmi3_description)()),
        }
    }
}

/// Every model.
pub const MODELS: &[Model] = &[WASHOUT];

/// The washout filter with the platform's kinematics.
pub const WASHOUT: Model = Model {
    name: "MorisWashout",
    packages: ["moris-washout-fmu", "moris-washout-fmu3"],
    libraries: ["MorisWashout", "MorisWashout_fmi3"],
    title: "MORIS washout: motion cueing for a motorcycle simulator",
    description: describe::<Washout>,
    fmi3_description: fmi3::describe::<Washout>,
    variables: |fmi| match fmi {
        FmiVersion::Fmi2 => variables_html::<Washout>(),
        FmiVersion::Fmi3 => fmi3::variables_html::<Washout>(),
    },
    sections: &[
        Section {
            anchor: "what",
            heading: "What it is",
            html: include_str!("../documentation/MorisWashout/what.html"),
        },
        Section {
            anchor: "connect",
            heading: "Connecting it",
            html: include_str!("../documentation/MorisWashout/connect.html"),
        },
        Section {
            anchor: "blocks",
            heading: "What happens inside",
            html: include_str!("../documentation/MorisWashout/blocks.html"),
        },
        Section {
            anchor: "limits",
            heading: "Limits",
            html: include_str!("../documentation/MorisWashout/limits.html"),
        },
        Section {
            anchor: "errata",
            heading: "Errata and choices",
            html: include_str!("../documentation/MorisWashout/errata.html"),
        },
    ],
    wording: &[
        (
            "actuators",
            "<code>actuator[1].length</code> to <code>actuator[6].length</code>",
            "the six elements of <code>actuator.length</code>",
        ),
        (
            "slopes",
            ", or followed linearly where the host gives their derivatives (<code>fmi2SetRealInputDerivatives</code>)",
            "",
        ),
        (
            "example",
            include_str!("../documentation/MorisWashout/example.fmi2.html"),
            include_str!("../documentation/MorisWashout/example.fmi3.html"),
        ),
    ],
    icon: icon::stewart_platform,
    reference_input: include_str!("../reference/MorisWashout_in.csv"),
    reference_output: reference::output::<Washout>,
};
