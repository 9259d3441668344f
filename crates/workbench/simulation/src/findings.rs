//! Findings of a simulation, in sentences.

use moris_measures::Measures;
use moris_measures::comfort::{Comfort, Excess};
use moris_measures::fidelity::Fidelity;
use moris_report::{Finding, Weight};

use moris_washout::Output;

use crate::spans::Spans;
use crate::{Evaluated, Simulation};

/// Less than this of a signal is not worth a sentence: RMS of the desired specific force
/// without its mean \[m/s2\].
const LEAST_FORCE: f64 = 0.1;
/// Relative error up to which a force counts as reproduced well.
const FAITHFUL: f64 = 0.25;
/// More than this fraction, and not cueing at all would be as good: a platform at rest has 1.
const USELESS: f64 = 1.0;

/// Least excesses of the felt force that are worth a sentence: well above what is felt at all, and
/// well below what hurts \[m/s2\].
const LEAST_SHAKE: f64 = 0.1;
const LEAST_JOLT: f64 = 1.0;
const LEAST_PEAK: f64 = 1.0;

/// Largest fraction of the time with soft limits at which a recording fits the rig.
const SELDOM: f64 = 0.01;
/// The cost of soft limits.
const GIVEN_UP: &str =
    "Meanwhile the platform gave up part of the cue to stay within its stroke, speed and acceleration.";

const AXES: [&str; 3] = ["Surge", "Sway", "Heave"];

/// The findings, the most important first: did it fit, what does a rider complain of, what limited
/// it, how well was it felt.
pub fn of(outcome: &Evaluated) -> Vec<Finding> {
    let mut findings = vec![fits(outcome)];
    let doubts = moris_washout::warnings(&outcome.simulation.parameters);
    findings.extend(doubts.into_iter().map(|doubt| finding(Weight::Warning, format!("{doubt}."))));
    findings.extend((0..3).flat_map(|axis| comfort(outcome, axis)));
    findings.extend(tilt(outcome));
    findings.extend((0..3).filter_map(|axis| force(outcome, axis)));
    findings
}

fn finding(weight: Weight, text: String) -> Finding {
    Finding { weight, text }
}

/// Fit of the recording to the rig: active limits, their durations and times.
fn fits(outcome: &Evaluated) -> Finding {
    let effort = &outcome.measures.effort;
    let simulation = &outcome.simulation;
    let hard: Vec<String> = [
        limited_time("The actuators' limits", simulation, |output| output.actuator_limited),
        limited_time("The safety units", simulation, |output| output.safety_active),
    ]
    .into_iter()
    .flatten()
    .collect();
    let soft = soft_limited_time(simulation);
    let used = format!(
        "{:.0} % of the stroke is used, and {:.0} mm are left at the least",
        100.0 * effort.stroke_used,
        1000.0 * effort.smallest_margin
    );
    match (hard.as_slice(), soft) {
        ([], None) => finding(Weight::Good, format!("The recording fits the rig: {used}.")),
        ([], Some(soft)) if fits_freely(outcome.measures) => {
            finding(Weight::Good, format!("The recording fits the rig: {used}. {soft}"))
        }
        ([], Some(soft)) => finding(
            Weight::Warning,
            format!("The recording stays within the rig by its soft limits alone. {soft} {GIVEN_UP} ({used}.)"),
        ),
        (hard, soft) => {
            let soft = soft.map_or_else(String::new, |soft| format!(" {soft} {GIVEN_UP}"));
            finding(Weight::Warning, format!("The recording does not fit the rig. {}{soft} ({used}.)", hard.join(" ")))
        }
    }
}

/// True if neither a safety unit nor an actuator's limit was active.
pub fn fits_the_rig(measures: &Measures) -> bool {
    measures.effort.safety_active == 0.0 && measures.effort.actuator_limited == 0.0
}

/// True if soft limits were hardly ever active, either.
pub fn fits_freely(measures: &Measures) -> bool {
    fits_the_rig(measures) && measures.effort.soft_limited <= SELDOM
}

/// Active limits with total duration and first time; none without any.
fn limited_time(what: &str, simulation: &Simulation, is_active: impl Fn(&Output) -> bool) -> Option<String> {
    let spans = Spans::of(simulation, is_active);
    let first = spans.first()?;
    Some(format!("{what} limited the platform for {:.2} s in all, first at {:.2} s.", spans.total, first[0]))
}

/// The same of the soft limits, with the longest span; they act for longer, and more often.
fn soft_limited_time(simulation: &Simulation) -> Option<String> {
    let spans = Spans::of(simulation, |output| output.soft_limited);
    let ([first, _], [from, to]) = (spans.first()?, spans.longest()?);
    let duration = simulation.step * (simulation.outputs.len().max(2) - 1) as f64;
    let fraction = 100.0 * spans.total / duration;
    let all = format!("Soft limits acted for {:.2} s in all ({fraction:.1} %)", spans.total);
    Some(match spans.count() {
        1 => format!("{all}, from {from:.2} to {to:.2} s."),
        _ => format!("{all}, first at {first:.2} s, for longest from {from:.2} to {to:.2} s."),
    })
}

/// Shaking, jolts and peaks of the felt force on an axis beyond the desired force.
fn comfort(outcome: &Evaluated, axis: usize) -> Vec<Finding> {
    let Some(Comfort { shake, jolt, peak }) = outcome.measures.comfort[axis] else { return Vec::new() };
    let name = AXES[axis].to_lowercase();
    let sentences = [
        worth_saying(shake, LEAST_SHAKE).map(|Excess { value, time }| {
            format!(
                "Felt {name} shakes by {value:.2} m/s² (RMS above 8 Hz) at {time:.1} s, beyond the shaking of the desired force."
            )
        }),
        worth_saying(jolt, LEAST_JOLT).map(|Excess { value, time }| {
            format!(
                "Felt {name} jolts by {value:.1} m/s² within 20 ms at {time:.1} s, beyond any change of the desired force there."
            )
        }),
        worth_saying(Some(peak), LEAST_PEAK).map(|Excess { value, time }| {
            format!("Felt {name} peaks {value:.1} m/s² above the largest desired force, at {time:.1} s.")
        }),
    ];
    sentences.into_iter().flatten().map(|text| finding(Weight::Warning, text)).collect()
}

fn worth_saying(excess: Option<Excess>, least: f64) -> Option<Excess> {
    excess.filter(|excess| excess.value >= least)
}

fn tilt(outcome: &Evaluated) -> Option<Finding> {
    let fraction = outcome.measures.effort.tilt_limited;
    let limits = &outcome.simulation.parameters.tilt;
    (fraction > 0.0).then(|| {
        finding(
            Weight::Note,
            format!(
                "Tilt coordination was limited for {:.0} % of the recording, by {:.1}°/s, {:.1}°/s² or {:.0}°.",
                100.0 * fraction,
                limits.rate_limit.to_degrees(),
                limits.acceleration_limit.to_degrees(),
                limits.angle_limit.to_degrees()
            ),
        )
    })
}

/// Agreement of the specific force on an axis on which there is some.
fn force(outcome: &Evaluated, axis: usize) -> Option<Finding> {
    let name = AXES[axis];
    let Fidelity { rms_error, correlation, .. } = outcome.measures.force[axis]?;
    let desired = deviation(outcome.simulation.inputs.iter().map(|input| input.specific_force[axis]));
    if desired < LEAST_FORCE {
        return None;
    }
    let fraction = rms_error / desired;
    let (weight, verdict) = if fraction <= FAITHFUL {
        (Weight::Good, "is reproduced well")
    } else if fraction < USELESS {
        (Weight::Note, "is reproduced in part")
    } else {
        (Weight::Warning, "has a larger error than a platform at rest")
    };
    let correlation = correlation.map_or(String::new(), |correlation| format!("correlation {correlation:.2}, "));
    let bound = outcome.bounds[axis].map_or_else(String::new, |least| {
        if least < FAITHFUL * rms_error {
            format!(" With preview of the whole recording, a controller might reach {least:.2} m/s² on this rig.")
        } else {
            format!(" No controller could get below {least:.2} m/s² on this rig.")
        }
    });
    Some(finding(
        weight,
        format!(
            "{name} {verdict}: {correlation}an RMS error of {rms_error:.2} m/s², {:.0} % of what is desired.{bound}",
            100.0 * fraction
        ),
    ))
}

/// Standard deviation.
fn deviation(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}
