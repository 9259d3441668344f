//! Summary of a simulation on the terminal.

use moris_simulation::measures::comfort::{Comfort, Excess};

use moris_simulation::channels::{ChannelFigures, channels};

use super::Outcome;
use crate::recording::Recording;
use crate::text_table::{Column, TextTable, or_undefined};
use crate::words::warnings;

/// The recording, what was found, and for each set of parameters a table of measures.
pub fn text(recording: &Recording, outcomes: &[Outcome]) -> String {
    let mut text =
        format!("{}: {:.1} s at {:.0} Hz\n", recording.name, recording.manoeuvre.duration(), 1.0 / recording.step());
    for warning in warnings(recording) {
        text += &format!("  {warning}\n");
    }
    for outcome in outcomes {
        let setup = &outcome.setup;
        let kind = if outcome.simulation.foreign.is_some() { "motion" } else { "parameters" };
        text += &format!("\n{}, {kind} {}:\n", setup.rig_name, setup.parameters_name);
        text += &format!("  {}\n", outcome.evaluated().verdict().text);
        for finding in outcome.evaluated().findings() {
            text += &format!("  {}\n", finding.text);
        }
        text += &format!("\n{}", cue_table(outcome));
    }
    text
}

/// The measures of the cues, axis by axis; axes on which nothing happens are left out.
fn cue_table(outcome: &Outcome) -> TextTable {
    let columns: [Column<ChannelFigures>; 15] = [
        ("felt against desired", |channel| {
            let kind = if channel.axis.is_rotation() { "rate" } else { "force" };
            format!("{kind} {}", ["x", "y", "z"][channel.axis as usize % 3])
        }),
        ("RMS error", |channel| channel_number(channel, channel.felt.rms_error)),
        ("bound", |channel| or_undefined(channel.bound.map(|bound| channel_number(channel, bound)))),
        ("peak error", |channel| channel_number(channel, channel.felt.peak_error)),
        ("shake", |channel| comfort_excess(channel, |comfort| comfort.shake)),
        ("jolt", |channel| comfort_excess(channel, |comfort| comfort.jolt)),
        ("peak", |channel| comfort_excess(channel, |comfort| Some(comfort.peak))),
        ("correlation", |channel| or_undefined(channel.felt.correlation.map(|value| format!("{value:.3}")))),
        ("delay", |channel| or_undefined(channel.felt.delay.map(delay_milliseconds))),
        ("sensed: RMS error", |channel| {
            or_undefined(channel.sensed.map(|sensed| channel_number(channel, sensed.rms_error)))
        }),
        ("false cues", |channel| format!("{:.1} %", 100.0 * channel.cues.false_cues)),
        ("missing cues", |channel| format!("{:.1} %", 100.0 * channel.cues.missing_cues)),
        ("shape", |channel| or_undefined(channel.shape.map(|shape| format!("{:.2}", shape.shape)))),
        ("size", |channel| or_undefined(channel.shape.map(|shape| format!("{:.2}", shape.size)))),
        ("inverted", |channel| or_undefined(channel.shape.map(|shape| format!("{:.1} %", 100.0 * shape.inverted)))),
    ];
    TextTable::of(&columns, channels(&outcome.evaluated()))
}

fn channel_number(channel: &ChannelFigures, value: f64) -> String {
    format!("{:.2} {}", channel.in_unit(value), channel.unit())
}

fn comfort_excess(channel: &ChannelFigures, of: fn(Comfort) -> Option<Excess>) -> String {
    or_undefined(channel.comfort.and_then(of).map(|excess| channel_number(channel, excess.value)))
}

fn delay_milliseconds(delay: f64) -> String {
    // A delay of -0.0 would be written as such.
    format!("{:.0} ms", (1000.0 * delay).round() + 0.0)
}
