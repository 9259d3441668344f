//! Bounds of modulus and phase, and the verdict on a response.

use std::path::Path;

use moris_simulation::frequency_response::Response;
use moris_simulation::frequency_response::channel::{CROSS_CHANNELS, Channel, direct, name, unit_in_si};

use super::Measured;

/// Columns of a file of bounds.
const BOUND_COLUMNS: [&str; 6] = ["channel", "frequency", "modulus_low", "modulus_high", "phase_low", "phase_high"];

/// The bounds of a channel at a frequency, in the units of the tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    pub input: Channel,
    pub output: Channel,
    /// Angular frequency \[rad/s\].
    pub frequency: f64,
    /// Least and greatest modulus.
    pub modulus: [Option<f64>; 2],
    /// Least and greatest phase \[deg\].
    pub phase: [Option<f64>; 2],
}

/// The modulus of a response, in the units of the tables.
pub fn modulus(response: &Response, output: Channel) -> f64 {
    response.ratios[output as usize].norm() * unit_in_si(response.input) / unit_in_si(output)
}

/// The phase by which the felt motion leads, -180 to 180 \[deg\].
pub fn phase(response: &Response, output: Channel) -> f64 {
    // A phase of -0.0 would be written as such.
    response.ratios[output as usize].arg().to_degrees() + 0.0
}

/// The name of a pair of channels: `surge`, or `pitch rate to surge`.
pub fn pair_name(input: Channel, output: Channel) -> String {
    if input == output { name(input).to_owned() } else { format!("{} to {}", name(input), name(output)) }
}

impl Limit {
    /// The bounds in a CSV file: a row for each channel and frequency, its columns `channel`,
    /// `frequency` \[rad/s\], and at least one of `modulus_low`, `modulus_high`, `phase_low` and
    /// `phase_high` \[deg\]. An empty field is no bound.
    ///
    /// # Errors
    /// The file cannot be read, lacks a column or a row, has another column, names no channel, or a
    /// field is no number.
    pub fn read(file: &Path) -> Result<Vec<Self>, String> {
        let at = |reason: String| format!("{}: {reason}", file.display());
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(file).map_err(|reason| at(reason.to_string()))?;
        let header = reader.headers().map_err(|reason| at(reason.to_string()))?.clone();
        let columns = BOUND_COLUMNS.join(", ");
        if let Some(other) = header.iter().find(|title| !BOUND_COLUMNS.contains(title)) {
            return Err(at(format!("column {other} is no bound; the columns are {columns}")));
        }
        let places = BOUND_COLUMNS.map(|column| header.iter().position(|title| title == column));
        if let Some(missing) = (0..2).find(|&k| places[k].is_none()) {
            return Err(at(format!("there is no column {}; the columns are {columns}", BOUND_COLUMNS[missing])));
        }
        if places[2..].iter().all(Option::is_none) {
            return Err(at(format!(
                "there is no column of bounds; the columns are {columns}, the last four as needed"
            )));
        }
        let row = |(line, record): (usize, csv::Result<csv::StringRecord>)| {
            let record = record.map_err(|reason| at(reason.to_string()))?;
            let fields = places.map(|place| place.and_then(|place| record.get(place)).unwrap_or(""));
            Self::of_fields(&fields).map_err(|reason| at(format!("line {}: {reason}", line + 2)))
        };
        let limits = reader.records().enumerate().map(row).collect::<Result<Vec<_>, _>>()?;
        if limits.is_empty() { Err(at("there are no bounds below the header".to_owned())) } else { Ok(limits) }
    }

    fn of_fields(fields: &[&str]) -> Result<Self, String> {
        let pairs = || direct().into_iter().chain(CROSS_CHANNELS);
        let (input, output) =
            pairs().find(|&(input, output)| pair_name(input, output) == fields[0]).ok_or_else(|| {
                let names: Vec<String> = pairs().map(|(input, output)| pair_name(input, output)).collect();
                format!("there is no channel {:?}; there are {}", fields[0], names.join(", "))
            })?;
        let number = |k: usize| -> Result<Option<f64>, String> {
            if fields[k].is_empty() {
                return Ok(None);
            }
            let value = fields[k].parse::<f64>().ok().filter(|value| value.is_finite());
            value.map(Some).ok_or_else(|| format!("{} is {:?}, which is no number", BOUND_COLUMNS[k], fields[k]))
        };
        let frequency = number(1)?.filter(|frequency| *frequency > 0.0);
        let frequency = frequency.ok_or_else(|| format!("frequency is {:?}, but must be above 0 rad/s", fields[1]))?;
        Ok(Limit { input, output, frequency, modulus: [number(2)?, number(3)?], phase: [number(4)?, number(5)?] })
    }

    /// What breaks the bounds, in sentences' parts; empty where they are held.
    pub fn broken_by(&self, measured: &Measured) -> Vec<String> {
        let Some(response) = measured.at(self.input, self.frequency) else {
            return vec!["was not measured".to_owned()];
        };
        let of = |what: &str, value: f64, [low, high]: [Option<f64>; 2], digits: usize| {
            let (word, bound) = match (low, high) {
                (Some(low), _) if value < low => ("below", low),
                (_, Some(high)) if value > high => ("above", high),
                _ => return None,
            };
            // The digit that decides is shown.
            let digits = (digits..12).find(|digits| format!("{value:.digits$}").parse() != Ok(bound)).unwrap_or(12);
            Some(format!("{what} {value:.digits$} is {word} {bound}"))
        };
        let phase = nearest_turn(phase(response, self.output), self.phase);
        let found = [of("modulus", modulus(response, self.output), self.modulus, 3), of("phase", phase, self.phase, 0)];
        found.into_iter().flatten().collect()
    }
}

/// The same phase, by whole turns as near to its bounds as can be: bounds may go beyond 180
/// degrees.
fn nearest_turn(phase: f64, [low, high]: [Option<f64>; 2]) -> f64 {
    let bounds: Vec<f64> = [low, high].into_iter().flatten().collect();
    let Some(first) = bounds.first() else { return phase };
    let middle = (first + bounds[bounds.len() - 1]) / 2.0;
    phase + 360.0 * ((middle - phase) / 360.0).round()
}
