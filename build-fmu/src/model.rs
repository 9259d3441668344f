//! The models of which there are FMUs. A new one is a new entry in [`MODELS`].

use model_description::{ModelDescription, describe, variables_html};
use moris_washout::Washout;

use crate::documentation::Section;
use crate::icon;

/// What the build needs to know of a model.
pub struct Model {
    /// The model's name, which is also the shared library's and the FMU's.
    pub name: &'static str,
    /// The cargo package that is the shared library.
    pub package: &'static str,
    /// A line that says what the model is: the documentation's title.
    pub title: &'static str,
    /// Makes the model description.
    pub description: fn() -> ModelDescription,
    /// Makes the documentation's tables of variables.
    pub variables: fn() -> String,
    /// The documentation's hand-written sections, in order; the variables follow them.
    pub sections: &'static [Section],
    /// Draws `model.png`.
    pub icon: fn() -> Vec<u8>,
}

/// Every model.
pub const MODELS: &[Model] = &[WASHOUT];

/// The washout filter with the platform's kinematics.
pub const WASHOUT: Model = Model {
    name: "MorisWashout",
    package: "moris-washout-fmu",
    title: "MORIS washout: motion cueing for a motorcycle simulator",
    description: describe::<Washout>,
    variables: variables_html::<Washout>,
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
    icon: icon::stewart_platform,
};
