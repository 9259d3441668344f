//! Findings of a simulation, in sentences.

use crate::measures::Measures;
use crate::measures::comfort::{Comfort, Excess};
use crate::measures::fidelity::Fidelity;
use crate::measures::shape::AxisShape;
use moris_washout::Output;
use moris_washout::interface::TiltParameters;
use moris_washout::platform::reach::Axis;

use crate::advice::Advice;
use crate::channels::{ChannelFigures, channels};
use crate::frequency_response::channel::name;
use crate::spans::Spans;
use crate::verdict::percent;
use crate::{Evaluated, Finding, Limits, Simulation, TiltLimit, Weight, capitalised, sentence};

/// Relative error up to which a channel counts as reproduced well.
const FAITHFUL_ERROR: f64 = 0.25;
/// Relative error above which a channel is worse than on a platform at rest, whose own is 1: a
/// scale of 0 is none.
const WORSE_THAN_REST: f64 = 1.05;
/// Fraction of the time with false cues that is worth a sentence.
const FALSE_CUES: f64 = 0.05;

/// Fraction of the time from which inverted cues are a warning, and the least correlation of a cue
/// that is right in time and proportion.
pub(crate) const MAX_INVERTED_FRACTION: f64 = 0.02;
pub(crate) const RIGHT_SHAPE: f64 = 0.85;

pub(crate) const FORCE_AXIS_NAMES: [&str; 3] = ["Surge", "Sway", "Heave"];

impl Evaluated<'_> {
    /// The findings, the most important first: fit, comfort, shape, channels worse than at rest,
    /// limits of the tilt, other channels, motion sickness.
    pub fn findings(&self) -> Vec<Finding> {
        let foreign = self.simulation.foreign.as_ref();
        let mut findings = match foreign {
            Some(foreign) => foreign.findings(self, is_better_than_rest(self)),
            None => vec![fit_finding(self)],
        };
        findings.extend((0..3).flat_map(|axis| comfort_findings(self, axis)));
        findings.extend(shape_finding(self));
        findings.extend(self.advice.and_then(Advice::alternatives).map(|text| new_finding(Weight::Note, text)));
        if foreign.is_none() {
            let warnings = moris_washout::warnings(&self.simulation.parameters);
            findings.extend(warnings.into_iter().map(|warning| new_finding(Weight::Warning, format!("{warning}."))));
        }
        let (worse, others): (Vec<Finding>, Vec<Finding>) = channels(self)
            .iter()
            .filter_map(|channel| channel.finding(&self.simulation.parameters.tilt))
            .partition(|finding| finding.weight == Weight::Warning);
        findings.extend(worse);
        findings.extend(tilt_finding(self));
        findings.extend(others);
        findings.extend(sickness_finding(self.measures));
        findings
    }
}

fn new_finding(weight: Weight, text: String) -> Finding {
    Finding { weight, text }
}

/// Fit of the recording to the rig: active limits, their durations and times.
fn fit_finding(outcome: &Evaluated) -> Finding {
    let simulation = &outcome.simulation;
    let hard: Vec<String> = [
        limited_time("The actuators' limits", simulation, |output| output.actuator_limited),
        limited_time("The safety units", simulation, |output| output.safety_active),
    ]
    .into_iter()
    .flatten()
    .collect();
    let soft = soft_limited_time(simulation);
    let used = stroke_used(outcome);
    let good = if is_better_than_rest(outcome) { Weight::Good } else { Weight::Note };
    match (hard.as_slice(), soft) {
        ([], None) => new_finding(good, sentence!["fits", used]),
        ([], Some(soft)) if fits_freely(outcome.measures) => {
            new_finding(good, format!("{} {soft}", sentence!["fits", used]))
        }
        ([], Some(soft)) => new_finding(Weight::Warning, sentence!["fits-by-soft-limits", soft, used]),
        (hard, soft) => {
            let soft = soft.map_or_else(String::new, |soft| format!(" {}", sentence!["gives-up", soft]));
            new_finding(Weight::Warning, sentence!["fits-not", hard = hard.join(" "), soft, used])
        }
    }
}

/// How much of the stroke is used, as a clause.
pub(crate) fn stroke_used(outcome: &Evaluated) -> String {
    let effort = &outcome.measures.effort;
    sentence!["stroke-used", percent = 100.0 * effort.stroke_used, margin = 1000.0 * effort.smallest_margin]
}

/// As [`fits_the_rig`]; none where the legs are not known.
pub fn fit(outcome: &Evaluated) -> Option<bool> {
    let is_judged = outcome.simulation.foreign.as_ref().is_none_or(|foreign| foreign.has_legs);
    is_judged.then(|| fits_the_rig(outcome.measures))
}

/// True if neither a safety unit nor an actuator's limit was active.
pub fn fits_the_rig(measures: &Measures) -> bool {
    measures.effort.limited.safety == 0.0 && measures.effort.limited.actuator == 0.0
}

/// True if soft limits, which keep these from acting, were hardly ever active, either.
pub(crate) fn fits_freely(measures: &Measures) -> bool {
    // Largest fraction of the time with soft limits at which a recording fits the rig.
    const MAX_SOFT_LIMITED_FRACTION: f64 = 0.01;
    fits_the_rig(measures) && measures.effort.limited.soft <= MAX_SOFT_LIMITED_FRACTION
}

/// True if no channel is worse than on a platform at rest.
pub fn is_better_than_rest(outcome: &Evaluated) -> bool {
    !channels(outcome).iter().any(ChannelFigures::is_worse_than_rest)
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

/// Motion sickness in the vehicle and on the platform.
fn sickness_finding(measures: &Measures) -> Option<Finding> {
    // Least share of sick people that is worth a sentence [%], and the share by which the platform
    // may exceed the vehicle without a warning.
    const LEAST_SICK: f64 = 1.0;
    const SICKNESS_RATIO: f64 = 2.0;
    let [vehicle, platform] = measures.rider.sick;
    let weight = if platform > vehicle + SICKNESS_RATIO { Weight::Warning } else { Weight::Note };
    (vehicle.max(platform) >= LEAST_SICK).then(|| new_finding(weight, sentence!["motion-sickness", vehicle, platform]))
}

/// Shaking, jolts and peaks of the felt force on an axis beyond the desired force.
fn comfort_findings(outcome: &Evaluated, axis: usize) -> Vec<Finding> {
    // Least excesses of the felt force that are worth a sentence: well above what is felt at all,
    // and well below what hurts [m/s2].
    const LEAST_SHAKE: f64 = 0.1;
    const LEAST_JOLT: f64 = 1.0;
    const LEAST_PEAK: f64 = 1.0;
    let Some(Comfort { shake, jolt, peak }) = outcome.measures.comfort[axis] else { return Vec::new() };
    let name = FORCE_AXIS_NAMES[axis].to_lowercase();
    let sentences = [
        worth_saying(shake, LEAST_SHAKE).map(|Excess { value, time }| sentence!["felt-shakes", name, value, time]),
        worth_saying(jolt, LEAST_JOLT).map(|Excess { value, time }| sentence!["felt-jolts", name, value, time]),
        worth_saying(Some(peak), LEAST_PEAK).map(|Excess { value, time }| sentence!["felt-peaks", name, value, time]),
    ];
    sentences.into_iter().flatten().map(|text| new_finding(Weight::Warning, text)).collect()
}

/// Sign, time, proportion and size of the felt force of surge and sway.
fn shape_finding(outcome: &Evaluated) -> Option<Finding> {
    let shape = &outcome.measures.shape;
    let (most, inverted) = shape.most_inverted_axis()?;
    let of_axes = |value: &dyn Fn(&AxisShape) -> String| {
        let named = |(axis, name): (&Option<AxisShape>, &str)| {
            Some(format!("{} in {}", value(axis.as_ref()?), name.to_lowercase()))
        };
        shape.axes.iter().zip(FORCE_AXIS_NAMES).filter_map(named).collect::<Vec<_>>().join(", ")
    };
    let shapes = of_axes(&|axis| format!("{:.2}", axis.shape));
    let sizes = of_axes(&|axis| format!("{:.0} %", 100.0 * axis.size));
    if inverted > MAX_INVERTED_FRACTION {
        let (axis, time) = (FORCE_AXIS_NAMES[most], percent(inverted));
        let text = sentence!["felt-inverted", axis, time, shapes, sizes];
        return Some(new_finding(Weight::Warning, text));
    }
    let is_right = shape.axes.iter().flatten().all(|axis| axis.shape >= RIGHT_SHAPE);
    let (weight, verdict) = match is_right {
        true => (Weight::Good, "Surge and sway are felt the right way round and in time"),
        false => (Weight::Note, "Surge and sway are felt the right way round, but not in proportion"),
    };
    Some(new_finding(weight, format!("{verdict}. Shape: {shapes}; size: {sizes}.")))
}

fn worth_saying(excess: Option<Excess>, least: f64) -> Option<Excess> {
    excess.filter(|excess| excess.value >= least)
}

/// Time in which limits of tilt coordination acted, limit by limit.
fn tilt_finding(outcome: &Evaluated) -> Option<Finding> {
    // Least fraction of the time with limited tilt that is worth a sentence.
    const LEAST_TILT_LIMITED: f64 = 0.005;
    let fraction = outcome.measures.effort.limited.tilt;
    if fraction < LEAST_TILT_LIMITED {
        return None;
    }
    let limits = Limits::from(&outcome.simulation.parameters);
    let [roll, pitch] = outcome.simulation.tilt_limits();
    let steps = (roll[0].len().max(2) - 1) as f64;
    let by = TiltLimit::ALL.iter().zip(roll.iter().zip(&pitch)).filter_map(|(limit, (roll, pitch))| {
        let count = roll.iter().zip(pitch).skip(1).filter(|(roll, pitch)| **roll || **pitch).count();
        let fraction = count as f64 / steps;
        (fraction >= LEAST_TILT_LIMITED).then(|| format!("the {} for {:.0} %", limit.text(&limits), 100.0 * fraction))
    });
    let by = by.collect::<Vec<_>>().join(", ");
    let text = format!("Tilt coordination was limited for {:.0} % of the recording: by {by}.", 100.0 * fraction);
    Some(new_finding(Weight::Note, text))
}

/// The limits that the bound of an axis was computed with.
fn bound_limits(tilt: &TiltParameters, axis: Axis) -> String {
    if axis == Axis::Heave {
        return "within these limits of travel, speed and acceleration".to_owned();
    }
    let degrees = |angle: f64| (10.0 * angle.to_degrees()).round() / 10.0;
    format!("within these limits of tilt ({}°, {} °/s) and travel", degrees(tilt.angle_limit), degrees(tilt.rate_limit))
}

impl ChannelFigures {
    /// How much worse than a platform at rest: 1 is where that begins. The severity is by the
    /// error, where that is also sensed as false cues. Where hardly any motion is desired, the
    /// false cues alone count. The rotation of tilt coordination is not counted where it is slower
    /// than the threshold of perception: it turns the rider by design.
    pub(crate) fn severity(&self) -> f64 {
        let error = self.without_tilt.unwrap_or(self.felt.rms_error);
        let false_cues = self.cues.false_cues / FALSE_CUES;
        match (self.is_desired(), self.axis.is_rotation()) {
            (true, _) => false_cues.min(error / (WORSE_THAN_REST * self.at_rest)),
            (false, true) if error < self.least_desired() => 0.0,
            (false, _) => false_cues,
        }
    }

    /// The figure that [`ChannelFigures::severity`] is of, as a clause.
    pub(crate) fn figure(&self) -> String {
        format!("false cues for {} of the time", percent(self.cues.false_cues))
    }

    fn is_worse_than_rest(&self) -> bool {
        self.severity() >= 1.0
    }

    fn is_desired(&self) -> bool {
        self.at_rest >= self.least_desired()
    }

    fn least_desired(&self) -> f64 {
        // Least RMS of the desired motion that counts as desired, of forces [m/s2] and of rates
        // [rad/s].
        const MIN_DESIRED_RMS: [f64; 2] = [0.05, 1.0_f64.to_radians()];
        MIN_DESIRED_RMS[usize::from(self.axis.is_rotation())]
    }

    /// A channel on which something is desired, felt, or falsely cued.
    fn finding(&self, tilt: &TiltParameters) -> Option<Finding> {
        // Fraction of the time with false cues that is worth a warning.
        const MANY_FALSE_CUES: f64 = 0.1;
        let Fidelity { rms_error, correlation, .. } = self.felt;
        let false_cues = self.cues.false_cues;
        let is_desired = self.is_desired();
        if !is_desired && !self.is_worse_than_rest() {
            return None;
        }
        let (weight, verdict) = if self.is_worse_than_rest() {
            let (larger, felt) =
                ("has a larger error than a platform at rest", "is felt although nearly none is desired");
            (Weight::Warning, if is_desired { larger } else { felt })
        } else if rms_error <= FAITHFUL_ERROR * self.at_rest {
            (Weight::Good, "is reproduced well")
        } else if rms_error > WORSE_THAN_REST * self.at_rest {
            (Weight::Note, "has a larger error than a platform at rest, which is rarely sensed")
        } else {
            (Weight::Note, "is reproduced in part")
        };
        let correlation = correlation.filter(|_| is_desired);
        let correlation = correlation.map_or_else(String::new, |correlation| format!("correlation {correlation:.2}, "));
        let value = |value: f64| format!("{:.2} {}", self.in_unit(value), self.unit());
        let of_desired = if is_desired {
            format!("{:.0} % of what is desired", 100.0 * rms_error / self.at_rest)
        } else {
            format!("where {} is desired", value(self.at_rest))
        };
        let (false_weight, falsely) = match false_cues {
            FALSE_CUES.. => {
                let is_tilt = self.without_tilt.is_some() && !self.is_worse_than_rest();
                let weight = if false_cues >= MANY_FALSE_CUES && !is_tilt { Weight::Warning } else { Weight::Note };
                (weight, format!(" Its cues are false for {:.0} % of the time.", 100.0 * false_cues))
            }
            _ => (weight, String::new()),
        };
        let weight = if weight == Weight::Warning { weight } else { false_weight };
        let name = capitalised(name(self.axis));
        let text =
            format!("{name} {verdict}: {correlation}an RMS error of {}, {of_desired}.{falsely}", value(rms_error));
        Some(new_finding(weight, text + &self.bound_sentence(tilt)))
    }

    fn bound_sentence(&self, tilt: &TiltParameters) -> String {
        self.bound.map_or_else(String::new, |least| {
            let limits = bound_limits(tilt, self.axis);
            if least < FAITHFUL_ERROR * self.felt.rms_error {
                format!(" With preview of the whole recording, a controller might reach {least:.2} m/s² {limits}.")
            } else {
                format!(" No controller could get below {least:.2} m/s² {limits}.")
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::measures::cues::Cues;
    use moris_interface::Group as _;

    use super::*;

    /// The finding on a roll rate of this RMS [°/s], error [°/s] and fraction of false cues.
    fn finding_on(desired: f64, error: f64, false_cues: f64) -> Option<(Weight, String)> {
        let fidelity = Fidelity { rms_error: error.to_radians(), peak_error: 0.1, correlation: Some(0.5), delay: None };
        let channel = ChannelFigures {
            axis: Axis::Roll,
            at_rest: desired.to_radians(),
            without_tilt: None,
            bound: None,
            felt: fidelity,
            sensed: None,
            comfort: None,
            shape: None,
            cues: Cues { false_cues, ..Cues::default() },
        };
        let found = channel.finding(&TiltParameters::START);
        assert!(!channel.is_worse_than_rest() || found.as_ref().is_some_and(|one| one.weight == Weight::Warning));
        found.map(|Finding { weight, text }| (weight, text))
    }

    #[test]
    fn a_channel_worse_than_at_rest_or_falsely_cued_has_a_sentence() {
        let of = |desired, error, false_cues| finding_on(desired, error, false_cues).unwrap();
        let (weight, text) = of(4.0, 5.8, 0.06);
        assert_eq!(weight, Weight::Warning);
        assert_eq!(
            text,
            "Roll rate has a larger error than a platform at rest: correlation 0.50, an RMS error of 5.80 °/s, 145 % of what is \
             desired. Its cues are false for 6 % of the time."
        );
        // It must be sensed as false, too.
        let (weight, text) = of(4.0, 5.8, 0.0);
        assert!(weight == Weight::Note && text.contains("at rest, which is rarely sensed: "), "{text}");
        let (weight, text) = of(4.0, 3.0, 0.22);
        assert!(
            weight == Weight::Warning
                && text.ends_with("75 % of what is desired. Its cues are false for 22 % of the time.")
        );
        assert_eq!(of(4.0, 3.0, 0.06).0, Weight::Note);
        assert_eq!(of(4.0, 0.9, 0.01).0, Weight::Good);
        let (weight, text) = of(0.0, 2.0, 0.08);
        assert!(weight == Weight::Warning && text.contains("is felt although nearly none is desired"), "{text}");
    }

    #[test]
    fn nothing_desired_and_nothing_sensed_has_no_sentence() {
        assert_eq!(finding_on(0.0, 2.0, 0.0), None);
    }
}
