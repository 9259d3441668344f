//! The documentation inside an FMU: one page that needs nothing else and no network.

use std::fmt::Write;

use model_description::ModelDescription;

use crate::Model;

/// A part of the documentation.
pub struct Section {
    /// What a link to it ends in.
    pub anchor: &'static str,
    pub heading: &'static str,
    /// What stands under the heading.
    pub html: &'static str,
}

/// The page, with places in double braces.
const PAGE: &str = include_str!("../documentation/page.html");
const STYLE: &str = include_str!("../documentation/style.css");

/// `documentation/index.html`: the model's sections, then its tables of variables.
pub fn page(model: &Model, description: &ModelDescription) -> String {
    let variables = (model.variables)();
    let sections = || {
        let written = model.sections.iter().map(|section| (section.anchor, section.heading, section.html));
        written.chain([("variables", "Variables", variables.as_str())])
    };
    let (mut contents, mut body) = (String::new(), String::new());
    for (anchor, heading, html) in sections() {
        write!(contents, "<li><a href=\"#{anchor}\">{heading}</a></li>").expect("a string takes whatever is written");
        write!(body, "<section id=\"{anchor}\">\n<h2>{heading}</h2>\n{html}</section>\n")
            .expect("a string takes whatever is written");
    }
    PAGE.replace("{{style}}", STYLE)
        .replace("{{title}}", model.title)
        .replace("{{name}}", &description.model_name)
        .replace("{{version}}", &description.version)
        .replace("{{guid}}", &description.guid)
        .replace("{{contents}}", &contents)
        .replace("{{sections}}", &body)
}
