//! A page that lists the pages of several recordings.

use crate::report::page::{Head, escaped};
use crate::report::tables::{cells_html, heads_html};

/// A recording in the list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IndexRow {
    /// The recording's name.
    pub name: String,
    /// The recording's page, a file in the same directory; none for a recording
    /// that could not be used.
    pub file: Option<String>,
    /// False for one that needs attention.
    pub is_good: bool,
    /// The verdict in words.
    pub verdict: String,
    /// The recording's figures, one for each heading.
    pub cells: Vec<String>,
}

/// The page as HTML: a heading, a sentence, and a table of the rows in their order.
pub fn index_html(title: &str, subtitle: &str, heads: &[&str], rows: &[IndexRow]) -> String {
    let header_cells = heads_html(heads);
    let mut body = String::new();
    for row in rows {
        let cells = cells_html(&row.cells, heads);
        let name = escaped(&row.name);
        let name =
            row.file.as_ref().map_or(name.clone(), |file| format!("<a href=\"{}\">{name}</a>", encoded_address(file)));
        let (class, mark) = if row.is_good { ("good", "\u{2713}") } else { ("warning", "!") };
        body += &format!(
            "<tr class=\"group {class}\"><th scope=\"row\"><span class=\"finding-mark\">{mark}</span> \
             {name}</th><td class=\"verdict\">{}</td>{cells}</tr>\n",
            escaped(&row.verdict)
        );
    }
    let head = Head {
        title,
        style: "a { color: var(--accent); }\n.finding-mark { display: inline-block; }\n",
        ..Head::default()
    }
    .html(&[]);
    let (title, subtitle) = (escaped(title), escaped(subtitle));
    format!(
        "{head}<header>\n<h1>{title}</h1>\n<p id=\"subtitle\">{subtitle}</p>\n</header>\n\
         <section id=\"measures\"><div class=\"wide\"><table><thead><tr><th></th><th scope=\"col\">verdict</th>{header_cells}</tr></thead>\n<tbody>\n{body}</tbody>\
         </table></div></section>\n</body>\n</html>\n"
    )
}

/// A file's name as a relative address.
fn encoded_address(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte);
    let letter = |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    format!("./{}", file.bytes().map(letter).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_text_and_files_are_addresses() {
        let row = IndexRow {
            name: "<b>&".into(),
            file: Some("a b#1%.html".into()),
            is_good: false,
            verdict: "does <not> fit".into(),
            cells: vec!["<1".into()],
        };
        let failed = IndexRow { name: "broken".into(), verdict: "no columns".into(), ..IndexRow::default() };
        let page = index_html("<t>", "s", &["x>y"], &[row, failed]);
        assert!(page.contains("does &lt;not&gt; fit") && page.matches("<a href").count() == 1, "{page}");
        assert!(page.contains("broken</th><td class=\"verdict\">no columns</td></tr>"), "{page}");
        assert!(page.contains("href=\"./a%20b%231%25.html\">&lt;b&gt;&amp;</a>"), "{page}");
        assert!(page.contains("&lt;1") && page.contains("x&gt;y") && page.contains("<title>&lt;t&gt;</title>"));
        assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("<script"));
    }
}
