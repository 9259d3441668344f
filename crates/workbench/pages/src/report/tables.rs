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
    /// Rows from this one on compete in each column, none by default: a bar behind a figure shows
    /// its size beside the largest, and the least figure is bold.
    pub compared: Option<usize>,
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
    let row = |(number, (name, cells)): (usize, &(String, Vec<String>))| {
        let cells = match table.compared {
            Some(first) => compared_cells_html(table, cells, first, number >= first),
            None => cells_html(cells, &table.heads),
        };
        format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", escaped(name))
    };
    let rows: String = table.rows.iter().enumerate().map(row).collect();
    format!(
        "<h2>{}</h2>\n<p>{}</p>\n<div class=\"wide\"><table><thead><tr><th></th>{heads}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n",
        escaped(&table.title),
        escaped(&table.text)
    )
}

/// The figures of a row with their bars; the least of the rows from `first` on is bold.
fn compared_cells_html(table: &PageTable, cells: &[String], first: usize, competes: bool) -> String {
    let figure = |text: &str| text.parse::<f64>().ok();
    let cell = |(column, (cell, head)): (usize, (&String, &String))| {
        let of_rows = |rows: &[(String, Vec<String>)]| -> Vec<f64> {
            rows.iter().filter_map(|(_, cells)| figure(cells.get(column)?)).collect()
        };
        let largest = of_rows(&table.rows).into_iter().fold(0.0, f64::max);
        let least = of_rows(table.rows.get(first..).unwrap_or_default()).into_iter().fold(f64::INFINITY, f64::min);
        let value = figure(cell);
        let bar = 100.0 * value.unwrap_or(0.0) / largest.max(f64::MIN_POSITIVE);
        let weight = if competes && value == Some(least) { "bold" } else { "normal" };
        format!(
            "<td class=\"number\" data-head=\"{}\" style=\"font-weight: {weight}; background: linear-gradient(to right, \
             var(--desired) {bar:.0}%, transparent 0)\">{}</td>",
            escaped(head),
            escaped(cell)
        )
    };
    cells.iter().zip(&table.heads).enumerate().map(cell).collect()
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
            compared: None,
        };
        let page = tables_html("<t>", "<s>", &[table]);
        for text in ["a&lt;b", "c&amp;d", "e&gt;f", "&lt;g&gt;", "1&lt;2", "<h1>&lt;t&gt;", "&lt;s&gt;"] {
            assert!(page.contains(text), "{text}: {page}");
        }
        assert!(!page.contains("http:") && !page.contains("<script"));
    }

    #[test]
    fn a_bar_shows_a_figure_and_the_least_that_competes_is_bold() {
        let row = |name: &str, cells: [&str; 2]| (name.to_owned(), cells.map(str::to_owned).to_vec());
        let table = PageTable {
            heads: ["one", "other"].map(str::to_owned).to_vec(),
            rows: vec![row("bound", ["0.10", "0.50"]), row("a", ["0.20", "-"]), row("b", ["0.40", "1.00"])],
            compared: Some(1),
            ..PageTable::default()
        };
        let page = tables_html("t", "s", &[table]);
        let cell = |head: &str, weight: &str, bar: u32, figure: &str| {
            format!(
                "data-head=\"{head}\" style=\"font-weight: {weight}; background: linear-gradient(to right, \
                 var(--desired) {bar}%, transparent 0)\">{figure}</td>"
            )
        };
        let cells = [
            cell("one", "normal", 25, "0.10"),
            cell("other", "normal", 50, "0.50"),
            cell("one", "bold", 50, "0.20"),
            cell("other", "normal", 0, "-"),
            cell("one", "normal", 100, "0.40"),
            cell("other", "bold", 100, "1.00"),
        ];
        assert!(cells.iter().all(|cell| page.contains(cell)), "{page}");
    }
}
