//! The responses as tables: all of them in a file, the most telling on the terminal.

use std::path::Path;

use anyhow::{Context, Result};

use moris_simulation::frequency_response::Response;
use moris_simulation::frequency_response::channel::{
    CROSS_CHANNELS, Channel, direct, name, ratio_unit, unit, unit_in_si,
};
use moris_simulation::frequency_response::excitation::frequencies;

use moris_analysis::frequency_response::limits::{Limit, pair_name};
pub use moris_analysis::frequency_response::limits::{modulus, phase};

use super::Measured;
use crate::text_table::TextTable;

/// Writes every response from every channel to every channel.
///
/// # Errors
/// The file cannot be written.
pub fn write(file: &Path, measured: &Measured) -> Result<()> {
    let save = || -> csv::Result<()> {
        let mut table = csv::Writer::from_path(file)?;
        table.write_record(response_fields("", &measured.test[0], Channel::Surge).map(|(name, _)| name))?;
        for (signal, responses) in [("test", &measured.test), ("small", &measured.small)] {
            for response in responses {
                for output in Channel::ALL {
                    table.write_record(response_fields(signal, response, output).map(|(_, field)| field))?;
                }
            }
        }
        Ok(table.flush()?)
    };
    save().with_context(|| format!("cannot write {}", file.display()))
}

/// The fields with their names.
fn response_fields(signal: &str, response: &Response, output: Channel) -> [(&'static str, String); 16] {
    // A smaller modulus is rounding.
    const NEGLIGIBLE_MODULUS: f64 = 1e-9;
    let input = response.input;
    // What is not felt has neither phase nor distortion.
    let felt = modulus(response, output) > NEGLIGIBLE_MODULUS;
    let if_felt = |text: String| if felt { text } else { String::new() };
    let [tilt, safety, actuator] = response.limited.map(|fraction| format!("{fraction:.4}"));
    [
        ("signal", signal.into()),
        ("input", name(input).into()),
        ("output", name(output).into()),
        ("kind", pair_kind(input, output).into()),
        ("frequency_rad_per_s", format!("{:.4}", response.frequency)),
        ("frequency_hz", format!("{:.5}", response.frequency / std::f64::consts::TAU)),
        ("amplitude", format!("{:.6}", response.amplitude / unit_in_si(input))),
        ("amplitude_unit", unit(input).into()),
        ("modulus", format!("{:.6}", modulus(response, output))),
        ("modulus_unit", ratio_unit(input, output).into()),
        ("phase_deg", if_felt(format!("{:.3}", phase(response, output)))),
        ("distortion", if_felt(format!("{:.5}", response.distortion[output as usize]))),
        ("tilt_limited_share", tilt),
        ("safety_active_share", safety),
        ("actuator_limited_share", actuator),
        ("settled", response.settled.to_string()),
    ]
}

/// True for a pair of channels that is tested.
fn pair_kind(input: Channel, output: Channel) -> &'static str {
    if input == output {
        "direct"
    } else if CROSS_CHANNELS.contains(&(input, output)) {
        "cross"
    } else {
        "other"
    }
}

/// Modulus and phase of the direct and the cross channels with the test's amplitudes,
/// and what limited them.
pub fn text(measured: &Measured) -> String {
    let warnings: String = test_warnings(&measured.test).into_iter().map(|warning| warning + "\n").collect();
    format!(
        "\ndirect channels: modulus, phase [deg]\n{}\n\
         cross channels: modulus [m/s² per °/s, °/s per m/s²], phase [deg]\n{}\n{warnings}",
        pair_table(measured, &direct()),
        pair_table(measured, &CROSS_CHANNELS)
    )
}

/// The verdict on each bound of a file that is not held, below a line with their number.
pub fn verdicts(limits: &[Limit], measured: &Measured) -> (bool, String) {
    let broken: Vec<(&Limit, Vec<String>)> = limits
        .iter()
        .map(|limit| (limit, limit.broken_by(measured)))
        .filter(|(_, broken)| !broken.is_empty())
        .collect();
    let mut text = format!("bounds: {} of {} held\n", limits.len() - broken.len(), limits.len());
    for (limit, reasons) in &broken {
        let pair = pair_name(limit.input, limit.output);
        text += &format!("  not held: {pair} at {:.3} rad/s: {}\n", limit.frequency, reasons.join(", "));
    }
    (broken.is_empty(), text)
}

/// A row for each frequency, a column for each pair of input and output.
fn pair_table(measured: &Measured, pairs: &[(Channel, Channel)]) -> TextTable {
    let title = |&(input, output): &(Channel, Channel)| pair_name(input, output);
    let titles: Vec<String> = std::iter::once("rad/s".to_owned()).chain(pairs.iter().map(title)).collect();
    let mut table = TextTable::new(titles.iter().map(String::as_str));
    for frequency in frequencies() {
        let cell = |&(input, output): &(Channel, Channel)| {
            // Of recordings there may be a few.
            let Some(response) = measured.at(input, frequency) else { return String::new() };
            let mark = if response.settled { "" } else { "?" };
            format!("{:.3} {:>4.0}{mark}", modulus(response, output), phase(response, output).round() + 0.0)
        };
        table.push(std::iter::once(format!("{frequency:.3}")).chain(pairs.iter().map(cell)).collect());
    }
    table
}

/// Remarks on the tests.
fn test_warnings(responses: &[Response]) -> Vec<String> {
    let limits = ["tilt coordination", "a safety unit", "the actuator guard"];
    let mut warnings: Vec<String> = limits
        .iter()
        .enumerate()
        .filter_map(|(i, name)| {
            let where_limited: Vec<&Response> = responses.iter().filter(|one| one.limited[i] > 0.0).collect();
            (!where_limited.is_empty()).then(|| format!("limited by {name}: {}", response_places(&where_limited)))
        })
        .collect();
    let unsettled: Vec<&Response> = responses.iter().filter(|one| !one.settled).collect();
    if !unsettled.is_empty() {
        warnings.push(format!("never settled, marked with ?: {}", response_places(&unsettled)));
    }
    warnings
}

/// Where responses are: channels, each with its frequencies.
fn response_places(responses: &[&Response]) -> String {
    let by_channel = responses.chunk_by(|a, b| a.input == b.input);
    let places = by_channel.map(|chunk| {
        let (first, last) = (chunk[0].frequency, chunk[chunk.len() - 1].frequency);
        let span = if chunk.len() == 1 { format!("{first:.2}") } else { format!("{first:.2} to {last:.2}") };
        format!("{} at {span} rad/s", name(chunk[0].input))
    });
    places.collect::<Vec<_>>().join("; ")
}
