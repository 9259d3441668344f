//! Tables of the pages that follow from the models.

use std::collections::BTreeMap;
use std::fs;

use moris_build_fmu::tables::GENERATED_TABLES;
use moris_build_fmu::workspace;
use moris_setup::PARAMETER_SETS;
use moris_washout::presets::values;
use roxmltree::Document;

fn read(file: &str) -> String {
    fs::read_to_string(workspace::root().join(file)).unwrap()
}

/// The cells of each row of a page's table, the heading first.
fn table(page: &str, name: &str) -> Vec<Vec<String>> {
    let text = read(page);
    let (_, from) = text.split_once(&format!("<!-- table: {name} -->\n")).unwrap();
    let (table, _) = from.split_once("<!-- end of table -->").unwrap();
    let cells = |line: &str| {
        let inner = line.strip_prefix("| ").unwrap().strip_suffix(" |").unwrap().to_owned();
        inner.split(" | ").map(|cell| cell.trim().to_owned()).collect()
    };
    let mut rows: Vec<Vec<String>> = table.lines().map(cells).collect();
    assert!(rows.len() > 2 && rows.remove(1).iter().all(|cell| cell == "---"));
    rows
}

fn code(cell: &str) -> &str {
    cell.strip_prefix('`').unwrap().strip_suffix('`').unwrap()
}

#[test]
fn every_table_is_that_of_the_models() {
    for expected in GENERATED_TABLES {
        let page = read(expected.page);
        let renewed = expected.within(&page).expect(expected.name);
        assert!(renewed == page, "{} in {} is stale: run `cargo describe-models`", expected.name, expected.page);
    }
}

#[test]
fn the_table_of_sets_has_the_values_of_every_set_and_no_others() {
    let rows = table("docs/parameter-sets.md", "parameter sets");
    let description = read("modelDescription/MorisWashout/modelDescription.xml");
    let document = Document::parse(&description).unwrap();
    let start = |name: &str| {
        let variable = document
            .descendants()
            .find(|node| node.tag_name().name() == "ScalarVariable" && node.attribute("name") == Some(name));
        let typed = variable.unwrap().first_element_child().unwrap();
        (typed.attribute("start").unwrap().parse::<f64>().unwrap(), typed.attribute("unit").unwrap_or("").to_owned())
    };
    for row in &rows[1..] {
        let (value, unit) = start(code(&row[0]));
        assert_eq!((row[1].as_str(), row[2].parse()), (unit.as_str(), Ok(value)), "{}", row[0]);
    }
    assert_eq!(rows[0].len(), 3 + PARAMETER_SETS.len() - 1);
    for (column, (name, set)) in (3..).zip(&PARAMETER_SETS[1..]) {
        assert_eq!(code(&rows[0][column]), *name);
        let printed: BTreeMap<String, f64> = rows[1..]
            .iter()
            .filter(|row| !row[column].is_empty())
            .map(|row| (code(&row[0]).to_owned(), row[column].parse().unwrap()))
            .collect();
        // A later value of a set overrides an earlier one. Some sets name start values, too.
        let values: BTreeMap<String, f64> =
            values(set).into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        let differing = values.into_iter().filter(|(name, value)| start(name).0 != *value).collect();
        assert_eq!(printed, differing, "{name}");
    }
}

#[test]
fn the_items_of_enumerations_have_the_numbers_of_the_descriptions() {
    let rows = table("docs/fmu.md", "enumerations");
    let mut described = Vec::new();
    for model in ["MorisWashout", "Motorcycle", "StewartPlatform"] {
        let text = read(&format!("modelDescription/{model}/modelDescription.xml"));
        let document = Document::parse(&text).unwrap();
        let parameters = document.descendants().filter(|node| node.attribute("causality") == Some("parameter"));
        for variable in parameters {
            let typed = variable.first_element_child().unwrap();
            if typed.tag_name().name() != "Enumeration" {
                continue;
            }
            let kind = document.descendants().find(|node| {
                node.tag_name().name() == "SimpleType" && node.attribute("name") == typed.attribute("declaredType")
            });
            let items = kind.unwrap().descendants().filter(|node| node.tag_name().name() == "Item").map(|item| {
                let (name, number) = (item.attribute("name").unwrap(), item.attribute("value").unwrap());
                let start = if typed.attribute("start") == Some(number) { " (start)" } else { "" };
                format!("{number} `{name}`{start}")
            });
            let items = items.collect::<Vec<_>>().join(", ");
            described.push(vec![format!("`{model}`"), format!("`{}`", variable.attribute("name").unwrap()), items]);
        }
    }
    let mut printed = rows[1..].to_vec();
    printed.sort();
    described.sort();
    assert!(described.len() > 8);
    assert_eq!(printed, described);
    let courses: Vec<String> =
        table("docs/motorcycle.md", "path.course")[1..].iter().map(|row| format!("{} {}", row[0], row[1])).collect();
    let course = described.iter().find(|row| row[1] == "`path.course`").unwrap();
    assert_eq!(courses.join(", "), course[2].replace(" (start)", ""));
}
