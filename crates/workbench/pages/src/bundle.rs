//! The script of a page: a module and all that it imports, as one text.
//!
//! The modules lie in `page/`. An import is a line of its own, `import { a, b } from "./c.js";`. An
//! export is a word before a declaration, `export const a`. A bundle has each module once, after
//! those that it imports, without these words: a name at the top of a module is unique in a page.

/// The path of every module below `page/`, and its text.
const PAGE_MODULES: &[(&str, &str)] = &include!(concat!(env!("OUT_DIR"), "/scripts.rs"));

/// The script of a page that begins with the module at `entry`, such as `ride/main.js`.
///
/// # Panics
/// There is no such module, or none of a path that is imported.
pub fn bundle(entry: &str) -> String {
    let mut paths = Vec::new();
    add_module(entry, &mut paths);
    let lines = paths.iter().flat_map(|path| module_text(path).lines()).filter(|line| imported_path(line).is_none());
    lines.map(|line| format!("{}\n", line.strip_prefix("export ").unwrap_or(line))).collect()
}

/// Adds a module after those that it imports.
fn add_module(path: &str, paths: &mut Vec<String>) {
    for from in module_text(path).lines().filter_map(imported_path) {
        let imported = resolved_path(path, from);
        if !paths.contains(&imported) {
            add_module(&imported, paths);
        }
    }
    paths.push(path.to_owned());
}

fn module_text(path: &str) -> &'static str {
    let found = PAGE_MODULES.iter().find(|(known, _)| *known == path);
    found.unwrap_or_else(|| panic!("no page has a module {path}")).1
}

/// The path that a line imports from.
fn imported_path(line: &str) -> Option<&str> {
    line.strip_prefix("import ")?.strip_suffix("\";")?.split_once("from \"").map(|(_, path)| path)
}

/// A path relative to that of a module, from `page/` on.
fn resolved_path(module: &str, path: &str) -> String {
    let folder = module.split_once('/').map_or("", |(folder, _)| folder);
    match (path.strip_prefix("../"), path.strip_prefix("./")) {
        (Some(elsewhere), _) => elsewhere.to_owned(),
        (None, beside) => format!("{folder}/{}", beside.unwrap_or(path)),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    const ENTRIES: [&str; 4] = ["live/live.js", "report/main.js", "report/worker.js", "ride/main.js"];
    /// Runs by itself before the others.
    const ALONE: &str = "shared/alarm.js";

    /// The names between the braces of an import.
    fn names(line: &str) -> Vec<&str> {
        let (_, rest) = line.split_once('{').expect("braces");
        rest.split_once('}').expect("braces").0.split(',').map(str::trim).collect()
    }

    /// The name that a line at the top of a module declares, and true if it is exported.
    fn declared(line: &str) -> Option<(&str, bool)> {
        let (line, is_exported) = match line.strip_prefix("export ") {
            Some(rest) => (rest, true),
            None => (line, false),
        };
        let line = line.strip_prefix("async ").unwrap_or(line);
        let rest = ["const ", "let ", "function ", "class "].iter().find_map(|word| line.strip_prefix(word))?;
        let end = rest.find(|letter: char| !letter.is_alphanumeric() && letter != '_')?;
        Some((&rest[..end], is_exported))
    }

    /// True if a text has a name outside of its imports.
    fn uses(text: &str, name: &str) -> bool {
        text.lines()
            .filter(|line| imported_path(line).is_none())
            .any(|line| line.split(|letter: char| !letter.is_alphanumeric() && letter != '_').any(|word| word == name))
    }

    #[test]
    fn every_import_names_an_export_that_it_uses() {
        let mut imports = HashSet::new();
        for (path, text) in PAGE_MODULES {
            for line in text.lines().filter(|line| line.starts_with("import ")) {
                let from = resolved_path(path, imported_path(line).unwrap_or_else(|| panic!("{path}: {line}")));
                for name in names(line) {
                    let exported =
                        super::module_text(&from).lines().filter_map(declared).any(|one| one == (name, true));
                    assert!(exported, "{path}: {from} does not export {name}");
                    assert!(uses(text, name), "{path} does not use {name}");
                    imports.insert((from.clone(), name));
                }
            }
        }
        for (path, text) in PAGE_MODULES {
            for (name, is_exported) in text.lines().filter_map(declared) {
                let is_imported = imports.contains(&((*path).to_owned(), name));
                assert_eq!(is_exported, is_imported, "{path}: export of {name}");
            }
        }
    }

    #[test]
    fn every_module_is_in_a_page_and_no_name_is_declared_twice_in_one() {
        let mut reached = HashSet::from([ALONE.to_owned()]);
        for entry in ENTRIES {
            let mut paths = Vec::new();
            add_module(entry, &mut paths);
            assert_eq!(paths.iter().collect::<HashSet<_>>().len(), paths.len(), "{entry}: {paths:?}");
            reached.extend(paths);
            let script = bundle(entry);
            let mut found = HashSet::new();
            for (name, is_exported) in script.lines().filter_map(declared) {
                assert!(!is_exported && (name.is_empty() || found.insert(name)), "{entry}: {name}");
            }
            assert!(!script.lines().any(|line| line.starts_with("import ")), "{entry}");
        }
        assert_eq!(reached, PAGE_MODULES.iter().map(|(path, _)| (*path).to_owned()).collect());
    }

    #[test]
    fn shared_modules_import_from_each_other_alone() {
        for (path, text) in PAGE_MODULES.iter().filter(|(path, _)| path.starts_with("shared/")) {
            for from in text.lines().filter_map(imported_path) {
                assert!(resolved_path(path, from).starts_with("shared/"), "{path}: {from}");
            }
        }
    }
}
