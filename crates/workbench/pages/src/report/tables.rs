//! A page of tables of figures.

use crate::report::page::{Head, escaped};

/// A table of the page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PageTable {
    /// Heading above the table.
    pub title: String,
    /// A sentence on its figures.
    pub text: String,
    /// Heads of the figures.
    pub heads: Vec<String>,
    /// Rows: a name, and a figure for each head.
    pub rows: Vec<(String, Vec<String>)>,
}

/// The page as HTML: a heading, a sentence, and the tables in their order.
pub fn tables_html(title: &str, subtitle: &str, tables: &[PageTable]) -> String {
    let head = Head { title, style: "h2 { margin-top: 28px; }\n", ..Head::default() }.html(&[]);
    let body: String = tables.iter().map(table_html).collect();
    let (title, subtitle) = (escaped(title), escaped(subtitle));
    format!(
        "{head}<header>\n<h1>{title}</h1>\n<p id=\"subtitle\">{subtitle}</p>\n</header>\n<section id=\"measures\">\n{body}</section>\n\
         </body>\n</html>\n"
    )
}

fn table_html(table: &PageTable) -> String {
    let heads = heads_html(&table.heads);
    let row = |(name, cells): &(String, Vec<String>)| {
        format!("<tr><th scope=\"row\">{}</th>{}</tr>\n", escaped(name), cells_html(cells, &table.heads))
    };
    let rows: String = table.rows.iter().map(row).collect();
    format!(
        "<h2>{}</h2>\n<p>{}</p>\n<div class=\"wide\"><table><thead><tr><th></th>{heads}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n",
        escaped(&table.title),
        escaped(&table.text)
    )
}

/// The heads of a table's figures.
pub(super) fn heads_html(heads: &[impl AsRef<str>]) -> String {
    let head = |head: &_| format!("<th class=\"number\" scope=\"col\">{}</th>", escaped(AsRef::as_ref(head)));
    heads.iter().map(head).collect()
}

/// The figures of a row, each below its head.
pub(super) fn cells_html(cells: &[String], heads: &[impl AsRef<str>]) -> String {
    let cell = |(cell, head): (&String, &_)| {
        format!("<td class=\"number\" data-head=\"{}\">{}</td>", escaped(AsRef::as_ref(head)), escaped(cell))
    };
    cells.iter().zip(heads).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_stays_text() {
        let table = PageTable {
            title: "a<b".into(),
            text: "c&d".into(),
            heads: vec!["e>f".into()],
            rows: vec![("<g>".into(), vec!["1<2".into()])],
        };
        let page = tables_html("<t>", "<s>", &[table]);
        for text in ["a&lt;b", "c&amp;d", "e&gt;f", "&lt;g&gt;", "1&lt;2", "<h1>&lt;t&gt;", "&lt;s&gt;"] {
            assert!(page.contains(text), "{text}: {page}");
        }
        assert!(!page.contains("http:") && !page.contains("<script"));
    }
}
