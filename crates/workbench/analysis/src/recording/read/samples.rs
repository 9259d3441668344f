//! The numbers of some columns of a file, or of several.

use std::ops::Range;

use crate::message::Message;

/// Numbers, a line a sample.
pub struct Samples {
    /// Times that are written out are in seconds.
    pub time: Vec<f64>,
    /// The columns with their places, in the order in which they were asked for, in the file's
    /// units; an empty field is not a number.
    pub columns: Vec<(usize, Vec<f64>)>,
    /// The line of the file from which each sample is.
    pub lines: Vec<u64>,
    /// Warnings, in whole sentences.
    pub warnings: Vec<Message>,
}

impl Samples {
    /// No samples of columns yet.
    pub fn new(places: &[usize]) -> Self {
        let columns = places.iter().map(|&place| (place, Vec::new())).collect();
        Samples { time: Vec::new(), columns, lines: Vec::new(), warnings: Vec::new() }
    }

    /// Adds a sample, with a value for each column.
    pub fn push(&mut self, line: u64, time: f64, values: Vec<f64>) {
        self.time.push(time);
        self.lines.push(line);
        self.columns.iter_mut().zip(values).for_each(|((_, column), value)| column.push(value));
    }

    /// Leaves out all samples but those of a range.
    pub fn keep(&mut self, range: Range<usize>) {
        self.time = self.time[range.clone()].to_vec();
        self.lines = self.lines[range.clone()].to_vec();
        for (_, values) in &mut self.columns {
            *values = values[range.clone()].to_vec();
        }
    }
}
