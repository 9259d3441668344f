//! The sources of what runs beside a platform: no way of printing that can panic.

use std::fs;
use std::path::Path;

/// Lines of a source, or of all in a directory, outside of tests.
fn sources(path: &Path, found: &mut Vec<(String, String)>) {
    if path.is_dir() {
        fs::read_dir(path).unwrap().for_each(|entry| sources(&entry.unwrap().path(), found));
    } else if path.file_name().is_none_or(|name| name != "tests.rs") {
        let text = fs::read_to_string(path).unwrap();
        let product = text.split("\nmod tests {").next().unwrap();
        found.extend(product.lines().map(|line| (path.display().to_string(), line.to_owned())));
    }
}

#[test]
fn no_thread_of_a_session_or_of_a_signal_prints_in_a_way_that_can_panic() {
    let mut lines = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    sources(&root.join("src"), &mut lines);
    sources(&root.join("../../workbench/command-line/src/console.rs"), &mut lines);
    sources(&root.join("../session/src"), &mut lines);
    sources(&root.join("../../workbench/moris/src/tune/kept.rs"), &mut lines);
    assert!(lines.len() > 3000);
    for (file, line) in lines {
        let code = line.split("//").next().unwrap_or_default();
        for wrong in ["print!(", "println!(", "dbg!(", ".unwrap()", ".expect(", "panic!(", "unreachable!("] {
            assert!(!code.contains(wrong), "{file}: {line}");
        }
        let writes = code.contains("stderr()") && !code.contains("begin(stderr())");
        assert!(!writes || file.ends_with("console.rs"), "{file} writes to standard error: {line}");
    }
}
