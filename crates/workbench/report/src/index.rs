//! A page that lists the pages of several recordings.

use crate::page::{STYLE, escaped};

/// A recording in the list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IndexRow {
    /// The recording's name.
    pub name: String,
    /// Its page, a file in the same directory.
    pub file: String,
    /// False for one that needs attention.
    pub is_good: bool,
    /// Its figures, one for each heading.
    pub cells: Vec<String>,
}

/// The page as HTML: a heading, a sentence, and a table of the rows in their order.
pub fn index_html(title: &str, subtitle: &str, heads: &[&str], rows: &[IndexRow]) -> String {
    let heads: String =
        heads.iter().map(|head| format!("<th class=\"number\" scope=\"col\">{}</th>", escaped(head))).collect();
    let mut body = String::new();
    for row in rows {
        let cells: String =
            row.cells.iter().map(|cell| format!("<td class=\"number\">{}</td>", escaped(cell))).collect();
        let (class, mark) = if row.is_good { ("good", "\u{2713}") } else { ("warning", "!") };
        body += &format!(
            "<tr class=\"group {class}\"><th scope=\"row\"><span class=\"finding-mark\" style=\"display: inline-block\">{mark}</span> \
             <a href=\"{}\">{}</a></th>{cells}</tr>\n",
            encoded(&row.file),
            escaped(&row.name)
        );
    }
    let (title, subtitle) = (escaped(title), escaped(subtitle));
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, \
         initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n<meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'\">\n<title>{title}</title>\n<style>\n{STYLE}\na {{ color: \
         var(--accent); }}\n</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n<p id=\"subtitle\">{subtitle}</p>\n</header>\n\
         <section id=\"measures\"><div class=\"wide\"><table><thead><tr><th></th>{heads}</tr></thead>\n<tbody>\n{body}</tbody>\
         </table></div></section>\n</body>\n</html>\n"
    )
}

/// A file's name as a relative address.
fn encoded(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte);
    let letter = |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    format!("./{}", file.bytes().map(letter).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_text_and_files_are_addresses() {
        let row =
            IndexRow { name: "<b>&".into(), file: "a b#1%.html".into(), is_good: false, cells: vec!["<1".into()] };
        let page = index_html("<t>", "s", &["x>y"], &[row]);
        assert!(page.contains("href=\"./a%20b%231%25.html\">&lt;b&gt;&amp;</a>"), "{page}");
        assert!(page.contains("&lt;1") && page.contains("x&gt;y") && page.contains("<title>&lt;t&gt;</title>"));
        assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("<script"));
    }
}
