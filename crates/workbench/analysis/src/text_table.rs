//! Tables for the terminal.

use std::borrow::Borrow;
use std::fmt;

/// A column: its head, and the text of its cell in a row.
pub type Column<T> = (&'static str, fn(&T) -> String);

/// A cell, or what stands where a number is not defined.
pub fn or_undefined(cell: Option<String>) -> String {
    cell.unwrap_or_else(|| "–".to_owned())
}

/// Rows of cells under a header, in aligned columns: the first to the left, the others to the
/// right.
#[derive(Clone, Debug)]
pub struct TextTable {
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table of nothing but its header.
    pub fn new<'a>(header: impl IntoIterator<Item = &'a str>) -> Self {
        TextTable { rows: vec![header.into_iter().map(str::to_owned).collect()] }
    }

    /// A table with these columns and a row for each of these.
    pub fn of<T>(columns: &[Column<T>], rows: impl IntoIterator<Item: Borrow<T>>) -> Self {
        let mut table = TextTable::new(columns.iter().map(|(head, _)| *head));
        rows.into_iter().for_each(|row| table.push(columns.iter().map(|(_, cell)| cell(row.borrow())).collect()));
        table
    }

    /// Adds a row, which has as many cells as the header.
    pub fn push(&mut self, row: Vec<String>) {
        assert_eq!(row.len(), self.rows[0].len());
        self.rows.push(row);
    }

    /// The table in Markdown, with columns aligned for those who read it as text.
    pub fn markdown(&self) -> String {
        let widths: Vec<usize> = (0..self.rows[0].len()).map(|column| self.width(column).max(3)).collect();
        let cell = |(cell, &width): (&String, &usize)| format!("| {cell:<width$} ");
        let line = |row: &Vec<String>| row.iter().zip(&widths).map(cell).collect::<String>() + "|\n";
        let rule = widths.iter().map(|width| format!("|{}", "-".repeat(width + 2))).collect::<String>() + "|\n";
        let lines: Vec<String> = self.rows.iter().map(line).collect();
        [&lines[..1], &[rule], &lines[1..]].concat().concat()
    }

    fn width(&self, column: usize) -> usize {
        self.rows.iter().map(|row| row[column].chars().count()).fold(0, usize::max)
    }
}

impl fmt::Display for TextTable {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let widths: Vec<usize> = (0..self.rows[0].len()).map(|column| self.width(column)).collect();
        for row in &self.rows {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            writeln!(formatter, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
        }
        Ok(())
    }
}
