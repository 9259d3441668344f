//! The verdict of a simulation: the most important fault, the size that is left, and the simulated
//! alternative that is best.

use moris_washout::platform::reach::Axis;

use crate::channels::channels;
use crate::findings::{FORCE_AXIS_NAMES, MAX_INVERTED_FRACTION, RIGHT_SHAPE, fits_freely, fits_the_rig};
use crate::frequency_response::channel::name;
use crate::{Evaluated, capitalised};
use crate::{Finding, Weight};

/// Jolt and shake from which they are the verdict \[m/s2\].
const MAX_SMOOTH_JOLT: f64 = 1.0;
const MAX_SMOOTH_SHAKE: f64 = 0.1;

/// Subjects of a verdict, in order of importance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A safety unit or an actuator's limit stops the platform.
    Limits,
    /// Surge or sway has the wrong sign.
    Inverted,
    /// The platform jolts or shakes the rider.
    Rough,
    /// A channel is worse than on a platform at rest.
    WorseThanRest(Axis),
    /// Surge or sway is out of time or proportion.
    Disproportion,
}

impl Evaluated<'_> {
    /// The faults that were looked for, in order of importance, with their severity: 1 is where a
    /// fault begins.
    pub fn severities(&self) -> Vec<(Fault, f64)> {
        let measures = self.measures;
        let limited = self.limited();
        let [shake, jolt] = [0, 1].map(|which| self.roughest(which).map_or(0.0, |(_, value)| value));
        let inverted = measures.shape.most_inverted_axis().map_or(0.0, |(_, inverted)| inverted);
        let least_shape = measures.shape.least_shape().unwrap_or(1.0);
        let mut worse: Vec<_> =
            channels(self).iter().map(|channel| (Fault::WorseThanRest(channel.axis), channel.severity())).collect();
        worse.sort_by(|one, other| other.1.total_cmp(&one.1));
        // A single limited sample is a fault, however long the recording is.
        let of_limits = if limited > 0.0 { 1.0 + 1e4 * limited } else { 0.0 };
        let first = [
            (Fault::Limits, of_limits),
            (Fault::Inverted, inverted / MAX_INVERTED_FRACTION),
            (Fault::Rough, (jolt / MAX_SMOOTH_JOLT).max(shake / MAX_SMOOTH_SHAKE)),
        ];
        // A correlation that is just right is none.
        let disproportion = (1.0 - least_shape) / (1.0 - RIGHT_SHAPE);
        let last = (Fault::Disproportion, if least_shape >= RIGHT_SHAPE { 0.0 } else { disproportion });
        first.into_iter().chain(worse).chain([last]).collect()
    }

    /// The most important fault; none where nothing is wrong.
    pub fn fault(&self) -> Option<Fault> {
        self.severities().into_iter().find(|(_, severity)| *severity >= 1.0).map(|(fault, _)| fault)
    }

    /// The verdict: the most important fault with the size that is left, and what to change.
    pub fn verdict(&self) -> Finding {
        // Remedy where a foreign motion seems to be read wrongly.
        const READ_WRONGLY: &str = " A unit, a sign or an axis of the felt motion may be wrong; the findings name it.";
        // Sentence where alternatives were simulated, and none is better.
        const NOTHING_BETTER: &str = " No other scale, strategy, preview or tilt that was simulated is better.";
        let size = self.size_clause();
        let soft = if fits_freely(self.measures) { "" } else { " Soft limits take a part of the cues." };
        let Some(fault) = self.fault() else {
            let (weight, text) = match size.as_str() {
                "" => (
                    Weight::Note,
                    format!("The recording has nearly no surge or sway: there is little to judge.{soft}"),
                ),
                size => (Weight::Good, format!("Felt the right way round{size}.{soft}")),
            };
            return Finding { weight, text };
        };
        let is_doubtful = self.simulation.foreign.as_ref().is_some_and(|foreign| foreign.is_doubtful);
        let remedy = match self.advice {
            _ if is_doubtful => READ_WRONGLY.to_owned(),
            Some(advice) => advice.sentence().map_or_else(|| NOTHING_BETTER.to_owned(), |text| format!(" {text}")),
            None => String::new(),
        };
        let (weight, soft) = match fault {
            Fault::Disproportion => (Weight::Note, soft),
            _ => (Weight::Warning, ""),
        };
        Finding { weight, text: format!("{}{size}.{soft}{remedy}", self.subject(fault)) }
    }

    /// Clause on the size of surge and sway: `, at 45 % of the vehicle's force`.
    pub(crate) fn size_clause(&self) -> String {
        let size = self.measures.shape.size();
        size.map_or_else(String::new, |size| format!(", at {:.0} % of the vehicle's force", 100.0 * size))
    }

    /// A fault as the beginning of a sentence.
    fn subject(&self, fault: Fault) -> String {
        let stopped = percent(self.limited());
        match fault {
            Fault::Limits if self.simulation.foreign.is_some() => {
                format!("Too much for the rig: the motion exceeds its actuators' limits for {stopped} of the time")
            }
            Fault::Limits => format!("Too much for the rig: its limits stop the platform for {stopped} of the time"),
            Fault::Inverted => format!("Felt the wrong way round for {} of the time", self.result(fault)),
            Fault::Rough => format!("Not smooth: {}", self.result(fault)),
            Fault::WorseThanRest(axis) => {
                format!("{} is worse than on a platform at rest: {}", capitalised(name(axis)), self.result(fault))
            }
            Fault::Disproportion => format!("Felt the right way round, but not in proportion: {}", self.result(fault)),
        }
    }

    /// True where shaking is further beyond its limit than jolts are.
    pub(crate) fn shakes(&self) -> bool {
        let [shake, jolt] = [0, 1].map(|which| self.roughest(which).unwrap_or_default().1);
        jolt / MAX_SMOOTH_JOLT < shake / MAX_SMOOTH_SHAKE
    }

    /// The largest shaking, or the largest jolt.
    pub(crate) fn roughness(&self, shakes: bool) -> String {
        let (axis, value) = self.roughest(usize::from(!shakes)).unwrap_or_default();
        let name = FORCE_AXIS_NAMES[axis].to_lowercase();
        if shakes { format!("{name} shakes by {value:.2} m/s²") } else { format!("{name} jolts by {value:.1} m/s²") }
    }

    /// The figure of a fault.
    pub(crate) fn result(&self, fault: Fault) -> String {
        let shape = &self.measures.shape;
        match fault {
            Fault::Limits if fits_the_rig(self.measures) => "no limit stops the platform".to_owned(),
            Fault::Limits => format!("its limits stop the platform for {}", percent(self.limited())),
            Fault::Inverted => percent(shape.most_inverted_axis().map_or(0.0, |(_, inverted)| inverted)),
            Fault::Rough => self.roughness(self.shakes()),
            Fault::WorseThanRest(axis) => {
                let channels = channels(self);
                let channel = channels.iter().find(|channel| channel.axis == axis);
                channel.map_or_else(|| "nothing is felt".to_owned(), |channel| channel.figure())
            }
            Fault::Disproportion => {
                let axes = shape
                    .axes
                    .iter()
                    .zip(FORCE_AXIS_NAMES)
                    .filter_map(|(axis, name)| Some((axis.as_ref()?.shape, name)));
                let least = axes.reduce(|least, next| if next.0 < least.0 { next } else { least });
                least.map_or_else(String::new, |(shape, name)| {
                    format!("a shape of {shape:.2} in {}", name.to_lowercase())
                })
            }
        }
    }

    /// Fraction of the time in which a safety unit or the actuator guard was active.
    fn limited(&self) -> f64 {
        let limited = &self.measures.effort.limited;
        limited.safety.max(limited.actuator)
    }

    /// The axis with the largest shake (0) or jolt (1), with its value; none where it is not known.
    fn roughest(&self, which: usize) -> Option<(usize, f64)> {
        let value = |axis: usize| Some((axis, self.measures.comfort[axis].as_ref()?.values()[which]));
        (0..3).filter_map(value).reduce(|most, next| if next.1 > most.1 { next } else { most })
    }
}

/// A fraction in percent, with a digit behind the point where it is small.
pub(crate) fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    match percent {
        0.0 => "0 %".to_owned(),
        ..0.1 => "less than 0.1 %".to_owned(),
        ..9.95 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}
