//! The documentation inside an FMU: one page that needs nothing else and no network.

use crate::model::Wording;
use crate::{FmiVersion, FmuModel, Start};

/// `documentation/index.html`: the model's sections, then its tables of variables.
pub fn page(model: &FmuModel, start: &Start, fmi: FmiVersion) -> String {
    // The page, with places in double braces.
    const PAGE_TEMPLATE: &str = include_str!("../documentation/page.html");
    const PAGE_STYLE: &str = include_str!("../documentation/style.css");
    let variables = model.variables(fmi, start);
    let identity = &model.functions.identity;
    let sections = || {
        let written = model.sections.iter().map(|section| (section.anchor, section.heading, section.html));
        written.chain([("variables", "Variables", variables.as_str())])
    };
    let (mut contents, mut body) = (String::new(), String::new());
    for (anchor, heading, html) in sections() {
        contents += &format!("<li><a href=\"#{anchor}\">{heading}</a></li>");
        body += &format!("<section id=\"{anchor}\">\n<h2>{heading}</h2>\n{html}</section>\n");
    }
    let page = PAGE_TEMPLATE
        .replace("{{style}}", PAGE_STYLE)
        .replace("{{title}}", model.title)
        .replace("{{contents}}", &contents)
        .replace("{{sections}}", &body)
        .replace("{{name}}", identity.name)
        .replace("{{version}}", identity.version)
        .replace("{{token_name}}", fmi.choose("GUID", "instantiation token"))
        .replace("{{token}}", &model.token(fmi, start))
        .replace("{{icon}}", fmi.icon_file())
        .replace("{{discard}}", fmi.choose("fmi2Discard", "fmi3Discard"))
        .replace("{{fmi}}", &fmi.to_string());
    let word = |page: String, wording: &Wording| page.replace(&format!("{{{{{}}}}}", wording.place), wording.text(fmi));
    model.wording.iter().fold(page, word)
}
