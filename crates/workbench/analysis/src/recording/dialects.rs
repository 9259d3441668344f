//! The names and first bytes by which the files of programs are known: data in `dialects.toml`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// All dialects.
pub static DIALECTS: LazyLock<Dialects> =
    LazyLock::new(|| toml::from_str(include_str!("dialects.toml")).expect("a test reads the dialects"));

/// Files known by their names and first bytes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dialects {
    /// Parts of the names of likely columns, between blanks, by the key of their quantity.
    pub likely: BTreeMap<String, String>,
    /// Channels of .vbo files by their names.
    pub vbox: BTreeMap<String, Channel>,
    /// Files that are no text, by their first bytes.
    pub binary: Vec<Foreign>,
    /// Files of text that are no tables, by the first letters behind blanks.
    pub text: Vec<Foreign>,
    /// Archives, by a name in them.
    pub archive: Vec<Foreign>,
}

/// A channel of a .vbo file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Unit of a file that gives none.
    pub unit: String,
    /// The loggers' names between blanks, the first that counts first.
    pub spellings: String,
}

/// Files that are no CSV.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Foreign {
    /// Bytes that show it, each a character of Latin-1: one of them is enough.
    marks: Vec<String>,
    /// The program and the way to CSV.
    pub remedy: String,
}

impl Foreign {
    /// True where bytes have one of the marks, by a test of one.
    pub fn is_marked(&self, has: impl Fn(&[u8]) -> bool) -> bool {
        self.marks.iter().any(|mark| has(&mark.chars().map(|c| c as u8).collect::<Vec<u8>>()))
    }
}
