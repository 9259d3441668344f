//! The documentation's tables of variables.

use crate::small_model::Small;
use moris_interface::start_values;
use moris_model_description::fmi2::{Types, variables_html};
use roxmltree::Document;

/// The texts of a table's cells, row by row, from the tables under the heading with this anchor.
fn cells(html: &str, anchor: &str) -> Vec<Vec<String>> {
    let document = Document::parse(html).expect("well-formed HTML is what an XML reader reads");
    let heading = document.descendants().find(|node| node.attribute("id") == Some(anchor)).unwrap();
    let table = heading.next_sibling_element().unwrap();
    let rows = table.descendants().filter(|node| node.has_tag_name("tr")).skip(1);
    let text = |node: roxmltree::Node| -> String {
        node.descendants().filter_map(|part| part.text().filter(|_| part.is_text())).collect()
    };
    rows.map(|row| row.children().map(text).collect()).collect()
}

fn small_tables() -> String {
    // As XML wants it: one root, void elements closed.
    let html =
        variables_html::<Small>(&start_values::<Small>(&[]), Types::Own).replace("<wbr>", "").replace("<br>", "; ");
    format!("<html>{html}</html>")
}

#[test]
fn a_row_shows_name_type_unit_start_range_and_meaning() {
    let html = small_tables();
    let inputs = cells(&html, "inputs");
    assert_eq!(
        inputs[0],
        ["entry.{x,\u{a0}y,\u{a0}z}", "Real", "m", "0.3,\u{a0}0,\u{a0}1e−9", "", "A direction & a \"size\" < 1."]
    );
    assert_eq!(inputs[1], ["counts", "Boolean", "", "true", "", "True if it counts."]);
    let tunable = cells(&html, "tunable-parameters");
    assert_eq!(tunable[0], ["ratio", "Real", "1", "0.333333", "0…1", "A ratio."]);
    let fixed = cells(&html, "fixed-parameters");
    assert_eq!(fixed[0], ["many", "Integer", "", "3", "1…9", "Number."]);
}

#[test]
fn an_output_has_no_start_value() {
    assert_eq!(cells(&small_tables(), "outputs")[0], ["exit[1…6].rate", "Real", "rad/s", "", "", "Angular velocity."]);
}

#[test]
fn an_enumeration_lists_its_items() {
    let turning = &cells(&small_tables(), "tunable-parameters")[1];
    assert_eq!(turning[3], "right");
    assert_eq!(turning[5], "The sense of turning.1: leftTo the left.2: rightTo the right.");
}
