//! The tables that `moris measure` prints.

use moris_analysis::host::{Host, Inputs};
use moris_analysis::measure::MeasuredRecording;
use moris_analysis::measure::targets::{geometric_mean, wrong_cues};
use moris_analysis::message::Message;
use moris_setup::Setup;
use moris_simulation::capitalised;
use moris_simulation::channels::ChannelFigures;
use moris_simulation::frequency_response::channel::name;
use moris_simulation::measures::comfort::{Comfort, Excess};
use moris_washout::platform::reach::Axis;

use crate::text;
use crate::text_table::{Column, TextTable, or_undefined};
use crate::words::option;

/// Everything: the channels, the limits, the summary and the targets missed.
pub fn text(setup: &Setup, host: &Host, recordings: &[MeasuredRecording], missed: &[Message]) -> String {
    let mut text = format!("{}, parameters {}, {}\n\n", setup.rig_name, setup.parameters_name, host_text(host));
    text += &format!("{}\n{}\n{}", channel_table(recordings), limit_table(recordings), summary_text(recordings));
    text += if missed.is_empty() { "All targets are met.\n" } else { "Targets missed:\n" };
    text.extend(missed.iter().map(|missed| format!("  {}\n", missed.worded(option))));
    text
}

fn host_text(host: &Host) -> String {
    let inputs = match host.inputs {
        Inputs::Slopes => "with slopes",
        Inputs::Values => "without slopes",
    };
    let preview = match host.preview {
        _ if host.learns => ", learned preview".to_owned(),
        seconds if seconds > 0.0 => format!(", preview of {seconds} s"),
        _ => String::new(),
    };
    match host.step {
        Some(step) => format!("host steps of {} ms {inputs}{preview}", (1e9 * step).round() / 1e6),
        None => format!("host steps as recorded, {inputs}{preview}"),
    }
}

fn channel_table(recordings: &[MeasuredRecording]) -> TextTable {
    let columns: [Column<(&str, &ChannelFigures)>; 15] = [
        ("recording", |(recording, _)| (*recording).to_owned()),
        ("channel", |(_, channel)| name(channel.axis).to_owned()),
        ("unit", |(_, channel)| channel.unit().to_owned()),
        ("at rest", |(_, channel)| channel_number(channel, channel.at_rest)),
        ("bound", |(_, channel)| or_undefined(channel.bound.map(|bound| channel_number(channel, bound)))),
        ("RMS", |(_, channel)| channel_number(channel, channel.felt.rms_error)),
        ("ratio", |(_, channel)| rest_ratio(channel)),
        ("sensed", |(_, channel)| channel_number(channel, channel.sensed.map_or(0.0, |sensed| sensed.rms_error))),
        ("cues %", |(_, channel)| percent_text(channel.cues.desired)),
        ("false %", |(_, channel)| percent_text(channel.cues.false_cues)),
        ("missing %", |(_, channel)| percent_text(channel.cues.missing_cues)),
        ("shake/jolt/peak", |(_, channel)| or_undefined(channel.comfort.as_ref().map(comfort_cell))),
        ("shape", |(_, channel)| or_undefined(channel.shape.map(|shape| format!("{:.2}", shape.shape)))),
        ("size", |(_, channel)| or_undefined(channel.shape.map(|shape| format!("{:.2}", shape.size)))),
        ("inverted %", |(_, channel)| or_undefined(channel.shape.map(|shape| percent_text(shape.inverted)))),
    ];
    let rows = recordings.iter().flat_map(|recording| {
        let names = [recording.name.as_str()].into_iter().chain(std::iter::repeat(""));
        names.zip(&recording.channels)
    });
    TextTable::of(&columns, rows)
}

fn channel_number(channel: &ChannelFigures, value: f64) -> String {
    format!("{:.3}", channel.in_unit(value))
}

/// The ratio to a platform at rest; where hardly anything is desired it means nothing.
fn rest_ratio(channel: &ChannelFigures) -> String {
    let is_desired = channel.in_unit(channel.at_rest) >= 0.03;
    or_undefined(is_desired.then(|| format!("{:.2}", channel.ratio())))
}

fn percent_text(fraction: f64) -> String {
    format!("{:.1}", 100.0 * fraction)
}

/// Shake, jolt and peak \[m/s2\] in a cell.
fn comfort_cell(comfort: &Comfort) -> String {
    let number = |excess: Option<Excess>, decimals: usize| {
        or_undefined(excess.map(|excess| format!("{:.decimals$}", excess.value)))
    };
    [number(comfort.shake, 2), number(comfort.jolt, 1), number(Some(comfort.peak), 1)].join("/")
}

fn limit_table(recordings: &[MeasuredRecording]) -> TextTable {
    let columns: [Column<MeasuredRecording>; 7] = [
        ("limited, % of the steps", |recording| recording.name.clone()),
        ("tilt", |recording| percent_text(recording.limits.tilt)),
        ("soft limits", |recording| percent_text(recording.limits.soft)),
        ("safety units", |recording| percent_text(recording.limits.safety)),
        ("actuator guard", |recording| percent_text(recording.limits.actuator)),
        ("units or guard", |recording| percent_text(recording.limited)),
        ("stroke used %", |recording| percent_text(recording.stroke_used)),
    ];
    TextTable::of(&columns, recordings)
}

fn summary_text(recordings: &[MeasuredRecording]) -> String {
    let (mean, count) = geometric_mean(recordings);
    let mut text = format!("Geometric mean of the RMS errors of surge and sway, {count} channels: {mean:.3} m/s²\n");
    for axis in [Axis::Roll, Axis::Pitch, Axis::Yaw] {
        let [wrong, at_rest] = wrong_cues(recordings, axis).map(|fraction| 100.0 * fraction);
        text += &text!["measured-cues", channel = capitalised(name(axis)), wrong, at_rest].to_string();
    }
    text
}
