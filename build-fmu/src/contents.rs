//! What is in an FMU.

use model_description::to_xml;

use crate::archive::Contents;
use crate::{Model, Platform, documentation};

/// Under which licences the FMU and its sources are: the choice is the user's.
pub const LICENCES: &str = concat!(
    "MORIS washout may be used under either of the two licences below, at your option.\n\n",
    "=== MIT ===\n\n",
    include_str!("../../LICENSE-MIT"),
    "\n=== Apache 2.0 ===\n\n",
    include_str!("../../LICENSE-APACHE"),
);

/// The files of a model's FMU with these libraries.
pub fn contents(model: &Model, libraries: Vec<(Platform, Vec<u8>)>) -> Contents {
    let description = (model.description)();
    let mut contents = Contents::new();
    contents.insert("documentation/index.html".to_owned(), documentation::page(model, &description).into_bytes());
    contents.insert("documentation/licenses/license.txt".to_owned(), LICENCES.as_bytes().to_vec());
    contents.insert("model.png".to_owned(), (model.icon)());
    contents.insert("modelDescription.xml".to_owned(), to_xml(&description).into_bytes());
    for (platform, bytes) in libraries {
        let path = format!("binaries/{}/{}", platform.directory(), platform.packed_library(model.name));
        contents.insert(path, bytes);
    }
    contents
}
