//! The tables that `moris measure` prints.

use moris_measures::comfort::{Comfort, Excess};
use moris_setup::Setup;
use moris_simulation::capitalised;
use moris_simulation::frequency_response::channel::name;
use moris_washout::platform::reach::Axis;

use super::MeasuredRecording;
use super::channel::Channel;
use super::host::{Host, Inputs};
use super::targets::{geometric_mean, wrong_cues};
use crate::text_table::TextTable;

/// Stands where a number was not computed.
const NONE: &str = "–";

/// Everything: the channels, the limits, the summary and the targets missed.
pub fn text(setup: &Setup, host: &Host, recordings: &[MeasuredRecording], missed: &[String]) -> String {
    let mut text = format!("{}, parameters {}, {}\n\n", setup.rig_name, setup.parameters_name, host_text(host));
    text += &format!("{}\n{}\n{}", channel_table(recordings), limit_table(recordings), summary(recordings));
    text += if missed.is_empty() { "All targets are met.\n" } else { "Targets missed:\n" };
    text.extend(missed.iter().map(|sentence| format!("  {sentence}\n")));
    text
}

fn host_text(host: &Host) -> String {
    let inputs = match host.inputs {
        Inputs::Slopes => "with slopes",
        Inputs::Values => "without slopes",
    };
    let preview = if host.preview > 0.0 { format!(", preview of {} s", host.preview) } else { String::new() };
    match host.step {
        Some(step) => format!("host steps of {} ms {inputs}{preview}", (1e9 * step).round() / 1e6),
        None => format!("host steps as recorded, {inputs}{preview}"),
    }
}

fn channel_table(recordings: &[MeasuredRecording]) -> TextTable {
    let mut table = TextTable::new([
        "recording",
        "channel",
        "unit",
        "at rest",
        "bound",
        "RMS",
        "ratio",
        "sensed",
        "cues %",
        "false %",
        "missing %",
        "shake/jolt/peak",
    ]);
    for recording in recordings {
        for (index, channel) in recording.channels.iter().enumerate() {
            let name = if index == 0 { recording.name.clone() } else { String::new() };
            table.push([name].into_iter().chain(row(channel)).collect());
        }
    }
    table
}

fn row(channel: &Channel) -> [String; 11] {
    let (unit, factor) = if channel.axis.is_rotation() { ("°/s", 1f64.to_degrees()) } else { ("m/s²", 1.0) };
    let number = |value: f64| format!("{:.3}", factor * value);
    let percent = |fraction: f64| format!("{:.1}", 100.0 * fraction);
    // Where hardly anything is desired a ratio means nothing.
    let ratio = if factor * channel.at_rest >= 0.03 { format!("{:.2}", channel.ratio()) } else { NONE.to_owned() };
    [
        name(channel.axis).to_owned(),
        unit.to_owned(),
        number(channel.at_rest),
        channel.bound.map_or_else(|| NONE.to_owned(), number),
        number(channel.error),
        ratio,
        number(channel.sensed_error),
        percent(channel.cues.desired),
        percent(channel.cues.false_cues),
        percent(channel.cues.missing_cues),
        channel.comfort.as_ref().map_or_else(|| NONE.to_owned(), comfort_cell),
    ]
}

/// Shake, jolt and peak \[m/s2\] in a cell.
fn comfort_cell(comfort: &Comfort) -> String {
    let number = |excess: Option<Excess>, decimals: usize| {
        excess.map_or_else(|| NONE.to_owned(), |excess| format!("{:.decimals$}", excess.value))
    };
    [number(comfort.shake, 2), number(comfort.jolt, 1), number(Some(comfort.peak), 1)].join("/")
}

fn limit_table(recordings: &[MeasuredRecording]) -> TextTable {
    let mut table = TextTable::new([
        "limited, % of the steps",
        "tilt",
        "soft limits",
        "safety units",
        "actuator guard",
        "units or guard",
        "stroke used %",
    ]);
    for recording in recordings {
        let percent = |fraction: f64| format!("{:.1}", 100.0 * fraction);
        let [tilt, soft, safety, guard] = recording.limits.map(percent);
        table.push(vec![
            recording.name.clone(),
            tilt,
            soft,
            safety,
            guard,
            percent(recording.limited),
            percent(recording.stroke_used),
        ]);
    }
    table
}

fn summary(recordings: &[MeasuredRecording]) -> String {
    let (mean, count) = geometric_mean(recordings);
    let mut text = format!("Geometric mean of the RMS errors of surge and sway, {count} channels: {mean:.3} m/s²\n");
    for axis in [Axis::Roll, Axis::Pitch, Axis::Yaw] {
        let [wrong, at_rest] = wrong_cues(recordings, axis).map(|fraction| 100.0 * fraction);
        text += &format!(
            "{}: false or missing cues for {wrong:.1} % of the time, {at_rest:.1} % on a platform at rest\n",
            capitalised(name(axis))
        );
    }
    text
}
