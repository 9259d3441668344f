//! The measures as a list for people.

use serde::Serialize;

use super::all::{Axes, Measures, Rider};
use super::comfort::Comfort;
use super::cues::Cues;
use super::effort::Effort;
use super::fidelity::Fidelity;
use super::run::{Limits, Platform, Run};
use super::shape::{AxisShape, Shape};

/// The better of two values of a measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// The smaller value.
    Less,
    /// The larger value.
    More,
    /// Neither value: the measure describes, and does not judge.
    Neither,
}

/// One measure, with its value, unit, definition and source.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Subject: `specific force x`, `sensed angular velocity y`, `platform`, ...
    #[serde(rename = "group")]
    pub subject: String,
    /// Measure: `RMS error`, `false cues`, ...
    pub name: &'static str,
    /// The value in `unit`; none where the measure is not defined for this run.
    pub value: Option<f64>,
    /// `m/s²`, `°/s`, `ms`, `%`, ... or empty.
    pub unit: &'static str,
    /// The better of two values.
    pub better: Better,
    /// Definition, in a sentence.
    pub definition: &'static str,
    /// Publication or page that defines the measure.
    pub source: &'static str,
}

const AXES: Axes<&str> = ["x", "y", "z"];

/// Entry for a measure that needs no source.
const COMMON: &str = "common usage";
const VESTIBULAR: &str = "Telban, Cardullo: Motion Cueing Algorithm Development: Human-Centered Linear and Nonlinear \
    Approaches, NASA/CR-2005-213747";
const COMFORT: &str = "docs/measures.md, comfort";
const SICKNESS: &str = "Inoue, Liu, Wada: Revisiting Motion Sickness Models Based on SVC Theory Considering Motion Perception, \
    SAE Technical Paper 2023-01-0176";
const DOSE: &str = "ISO 2631-1";
const RATING: &str = "docs/measures.md, incongruence";
const SHAPE: &str = "docs/measures.md, shape; threshold: Reid, Nahon, UTIAS Report 296, 1985";
const BOUND: &str = "docs/measures.md, the bound; an interior-point method after Rao, Wright, Rawlings 1998";
const THRESHOLDS: &str = "thresholds: Reid, Nahon: Flight Simulation Motion-Base Drive Algorithms, Part 1, UTIAS Report 296, \
    1985; vestibular model: Telban, Cardullo, NASA/CR-2005-213747";

impl Measures {
    /// The measures as rows, in the order in which one reads them. Axes on which nothing is desired
    /// and nothing felt are left out.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for (k, axis) in AXES.iter().enumerate() {
            rows.extend(FORCE.rows(axis, &self.force[k]));
            rows.extend(self.shape.axes.get(k).copied().flatten().iter().flat_map(|shape| shape_rows(axis, shape)));
            rows.extend(self.comfort[k].iter().flat_map(|comfort| comfort_rows(axis, comfort)));
            rows.extend(SENSED_FORCE.rows(axis, &self.sensed_force[k]));
            if self.sensed_force[k].is_some() {
                rows.extend(cue_rows(format!("sensed specific force {axis}"), &self.force_cues[k]));
            }
        }
        rows.extend(pooled_shape_rows(&self.shape));
        for (k, axis) in AXES.iter().enumerate() {
            rows.extend(RATE.rows(axis, &self.rate[k]));
            rows.extend(SENSED_RATE.rows(axis, &self.sensed_rate[k]));
            if self.sensed_rate[k].is_some() {
                rows.extend(cue_rows(format!("sensed angular velocity {axis}"), &self.rate_cues[k]));
            }
        }
        rows.extend(rider_rows(&self.rider));
        rows.extend(effort_rows(&self.effort));
        rows
    }
}

/// The rows that a run with motion on every axis has: those of any other run are among them, in the
/// same order. Their values mean nothing.
pub fn all_rows() -> Vec<Row> {
    let count = 16;
    let moving: Vec<[f64; 3]> = (0..count).map(|k| [f64::from(k); 3]).collect();
    let still = vec![[0.0; 3]; moving.len()];
    let run = Run {
        step: 0.1,
        desired_force: &moving,
        felt_force: &still,
        felt_force_within_steps: &still,
        desired_rate: &moving,
        scale: [1.0; 2],
        felt_rate: &still,
        platform: Platform {
            legs: &vec![[1.0; 6]; moving.len()],
            stroke: [0.5, 1.5],
            displacement: &still,
            tilt_rate: &vec![[0.0; 2]; moving.len()],
            limited: &vec![Limits::default(); moving.len()],
        },
    };
    Measures::of(&run).expect("the run has equal series of numbers").rows()
}

/// Name and source that all rows of a subject have.
struct Subject {
    name: String,
    source: &'static str,
}

impl Subject {
    /// A row that still needs its definition.
    fn row(&self, name: &'static str, better: Better, value: impl Into<Option<f64>>, unit: &'static str) -> Row {
        let (subject, value, source) = (self.name.clone(), value.into(), self.source);
        Row { subject, name, value, unit, better, definition: "", source }
    }
}

impl Row {
    fn defined(self, definition: &'static str) -> Self {
        Row { definition, ..self }
    }
}

/// A signal that is compared: how its errors are written.
struct Signal {
    subject: &'static str,
    unit: &'static str,
    /// From SI to `unit`.
    factor: f64,
    source: &'static str,
}

const DEGREE: f64 = 180.0 / std::f64::consts::PI;
const FORCE: Signal = Signal { subject: "specific force", unit: "m/s²", factor: 1.0, source: COMMON };
const RATE: Signal = Signal { subject: "angular velocity", unit: "°/s", factor: DEGREE, source: COMMON };
const SENSED_FORCE: Signal = Signal { subject: "sensed specific force", source: VESTIBULAR, ..FORCE };
const SENSED_RATE: Signal = Signal { subject: "sensed angular velocity", source: VESTIBULAR, ..RATE };

impl Signal {
    fn rows(&self, axis: &str, fidelity: &Option<Fidelity>) -> Vec<Row> {
        let Some(fidelity) = fidelity else { return Vec::new() };
        let on = Subject { name: format!("{} {axis}", self.subject), source: self.source };
        vec![
            on.row("RMS error", Better::Less, self.factor * fidelity.rms_error, self.unit)
                .defined("Root mean square over the run of felt minus desired."),
            on.row("peak error", Better::Less, self.factor * fidelity.peak_error, self.unit)
                .defined("Largest absolute value of felt minus desired."),
            on.row("correlation", Better::More, fidelity.correlation, "").defined(
                "Pearson's correlation of felt and desired, which no scale changes; undefined where one of them is constant.",
            ),
            on.row("delay", Better::Less, fidelity.delay.map(|delay| 1000.0 * delay), "ms").defined(
                "How much later felt comes: the shift, within 2 s, at which the two correlate best; undefined where they \
                 correlate by less than 0.9 there.",
            ),
        ]
    }
}

fn comfort_rows(axis: &str, comfort: &Comfort) -> [Row; 3] {
    let on = Subject { name: format!("specific force {axis}"), source: COMFORT };
    [
        on.row("shake", Better::Less, comfort.shake.map(|excess| excess.value), "m/s²").defined(
            "RMS over 2 s of the felt force above 8 Hz less that of the desired force, the largest over the run, at least 0; \
             undefined up to 16 samples a second and for runs of 15 samples or less.",
        ),
        on.row("jolt", Better::Less, comfort.jolt.map(|excess| excess.value), "m/s²").defined(
            "Largest difference between two values of the felt force within 20 ms, less the largest such difference of the \
             desired force in the 60 ms around it, at least 0; undefined where less than 50 samples a second are known.",
        ),
        on.row("peak", Better::Less, comfort.peak.value, "m/s²").defined(
            "Largest absolute value of the felt force, without gravity, less that of the desired force, at least 0.",
        ),
    ]
}

fn shape_rows(axis: &str, shape: &AxisShape) -> [Row; 3] {
    let on = Subject { name: format!("specific force {axis}"), source: SHAPE };
    [
        on.row("shape", Better::More, shape.shape, "").defined(
            "Correlation of felt and desired below 2 Hz: sign, time and proportion, whatever the size; 0 where nothing is felt.",
        ),
        on.row("size", Better::More, shape.size, "")
            .defined("RMS of the felt force below 2 Hz over that of the desired force; 1 is full size."),
        on.row("inverted", Better::Less, 100.0 * shape.inverted, "%").defined(
            "Fraction of the run in which the felt force below 2 Hz is above 0.17 m/s² and has the opposite sign of the desired \
             force.",
        ),
    ]
}

/// Surge and sway together.
fn pooled_shape_rows(shape: &Shape) -> Vec<Row> {
    let on = Subject { name: "horizontal specific force".to_owned(), source: SHAPE };
    let Some(inverted) = shape.inverted else { return Vec::new() };
    vec![
        on.row("inverted", Better::Less, 100.0 * inverted, "%").defined(
            "Fraction of the run in which the felt force below 2 Hz is above 0.17 m/s² and more than 90 degrees from the desired \
             force.",
        ),
        on.row("shape error", Better::Less, shape.error.map(|error| 100.0 * error), "%").defined(
            "RMS below 2 Hz of felt less scaled desired force, relative to the RMS of the scaled desired force; undefined at a \
             scale of 0.",
        ),
    ]
}

fn cue_rows(subject: String, cues: &Cues) -> [Row; 3] {
    let on = Subject { name: subject, source: THRESHOLDS };
    [
        on.row("sensed in the vehicle", Better::Neither, 100.0 * cues.desired, "%")
            .defined("Fraction of the run in which the vehicle's motion is above the threshold."),
        on.row("false cues", Better::Less, 100.0 * cues.false_cues, "%").defined(
            "Fraction of the run in which the platform's motion is above the threshold and the vehicle's is not, or has the \
             opposite sign.",
        ),
        on.row("missing cues", Better::Less, 100.0 * cues.missing_cues, "%").defined(
            "Fraction of the run in which the vehicle's motion is above the threshold and the platform's is not.",
        ),
    ]
}

/// The bound of one axis, `x`, `y` or `z`, beside what was felt there.
///
/// `desired` is the RMS of the desired specific force as a deviation from rest \[m/s2\], `felt` the
/// RMS error that was felt.
pub fn bound_rows(axis: &str, desired: f64, felt: f64, bound: f64) -> [Row; 4] {
    let on = Subject { name: format!("specific force {axis}"), source: BOUND };
    let percentage = |error: f64| (desired > 0.0).then(|| 100.0 * error / desired);
    [
        on.row("bound", Better::Neither, bound, "m/s²").defined(
            "Smallest RMS error of any controller, even with preview of the whole recording, on the linearised axis under the \
             same limits of tilt, tilt rate, travel, speed and acceleration.",
        ),
        on.row("gap to the bound", Better::Less, (felt - bound).max(0.0), "m/s²")
            .defined("RMS error beyond the bound: the most that a better controller could gain."),
        on.row("relative error", Better::Less, percentage(felt), "%").defined(
            "RMS error as a fraction of the RMS of the desired specific force without gravity; 100 % for a platform at rest.",
        ),
        on.row("relative bound", Better::Neither, percentage(bound), "%").defined("The bound as the same fraction."),
    ]
}

fn rider_rows(rider: &Rider) -> [Row; 5] {
    let from = |source| Subject { name: "rider".to_owned(), source };
    let [vehicle, platform] = rider.sick;
    let [vehicle_dose, platform_dose] = rider.dose;
    [
        from(SICKNESS).row("sick in the vehicle", Better::Neither, vehicle, "%").defined(
            "People who are sick after half an hour of the vehicle's motion, by the conflict between sensed and expected \
             vertical; without vision, from data of passengers.",
        ),
        from(SICKNESS).row("sick on the platform", Better::Less, platform, "%").defined("The same of the platform's motion."),
        from(DOSE).row("sickness dose in the vehicle", Better::Neither, vehicle_dose, "m/s^1.5").defined(
            "Motion sickness dose value: root of the integral of the squared vertical acceleration, weighted by Wf.",
        ),
        from(DOSE)
            .row("sickness dose on the platform", Better::Less, platform_dose, "m/s^1.5")
            .defined("The same of the platform's motion."),
        from(RATING)
            .row("incongruence", Better::Less, rider.incongruence.map(|incongruence| 100.0 * incongruence.value), "%")
            .defined(
                "Largest value of a low-pass of 3 s over the mismatch of lateral (66 %) and longitudinal force (34 %), relative to \
                 that of a platform at rest.",
            ),
    ]
}

fn effort_rows(effort: &Effort) -> [Row; 8] {
    let on = Subject { name: "platform".to_owned(), source: COMMON };
    [
        on.row("stroke used", Better::Neither, 100.0 * effort.stroke_used, "%").defined(
            "Span from the shortest to the longest length of any actuator, as a fraction of the stroke.",
        ),
        on.row("smallest stroke margin", Better::More, effort.smallest_margin, "m")
            .defined("Smallest distance of any actuator from either end of its stroke."),
        on.row("largest tilt rate", Better::Neither, effort.largest_tilt_rate.to_degrees(), "°/s")
            .defined("Largest rate of tilt coordination in roll or pitch."),
        on.row("tilt limited", Better::Less, 100.0 * effort.limited.tilt, "%").defined(
            "Fraction of the steps in which tilt coordination lagged behind its target at its rate or angle limit, or for at \
             least 0.1 s at its acceleration limit.",
        ),
        on.row("soft limits active", Better::Less, 100.0 * effort.limited.soft, "%").defined(
            "Fraction of the steps in which the soft limits changed the motion to stay within stroke, speed and acceleration.",
        ),
        on.row("safety units active", Better::Less, 100.0 * effort.limited.safety, "%")
            .defined("Fraction of the steps in which a safety unit limited the platform."),
        on.row("actuators limited", Better::Less, 100.0 * effort.limited.actuator, "%")
            .defined("Fraction of the steps in which the actuator guard limited an actuator."),
        on.row("final distance from neutral", Better::Less, effort.final_distance, "m")
            .defined("Distance of the platform from neutral at the end."),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 500;

    /// The rows of a run on which half of the surge and all of the rest is felt.
    fn rows_of(force: impl Fn(f64) -> [f64; 3]) -> Vec<Row> {
        let desired: Vec<[f64; 3]> = (0..COUNT).map(|k| force(0.01 * k as f64)).collect();
        let felt: Vec<[f64; 3]> = desired.iter().map(|[x, y, z]| [0.5 * x, *y, *z]).collect();
        let run = Run {
            step: 0.01,
            desired_force: &desired,
            felt_force: &felt,
            felt_force_within_steps: &felt,
            desired_rate: &vec![[0.0; 3]; COUNT],
            scale: [1.0; 2],
            felt_rate: &vec![[0.0; 3]; COUNT],
            platform: Platform {
                legs: &vec![[1.3; 6]; COUNT],
                stroke: [1.0, 1.6],
                displacement: &vec![[0.0; 3]; COUNT],
                tilt_rate: &vec![[0.0; 2]; COUNT],
                limited: &[Limits::default(); COUNT],
            },
        };
        Measures::of(&run).unwrap().rows()
    }

    #[test]
    fn an_axis_on_which_nothing_happens_has_no_rows() {
        let rows = rows_of(|t| [(2.0 * t).sin(), 0.0, 9.80665]);
        assert!(rows.iter().any(|row| row.subject == "specific force x"));
        assert!(rows.iter().all(|row| !row.subject.ends_with('y') && !row.subject.ends_with('z')));
        assert!(rows.iter().any(|row| row.subject == "platform"));
    }

    #[test]
    fn half_of_what_is_desired_is_an_error_of_half_its_size_however_it_correlates() {
        let rows = rows_of(|t| [(2.0 * t).sin(), 0.0, 9.80665]);
        let value = |name| rows.iter().find(|row| row.name == name && row.subject == "specific force x").unwrap().value;
        let rms = ((0..COUNT).map(|k| (0.02 * k as f64).sin().powi(2)).sum::<f64>() / COUNT as f64).sqrt();
        assert!((value("RMS error").unwrap() - 0.5 * rms).abs() < 1e-12);
        assert!((value("correlation").unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_rows_of_any_run_are_among_all_rows_in_their_order() {
        let all = all_rows();
        assert_eq!(all.len(), 3 * (4 + 3 + 4 + 3) + 2 * 3 + 2 + 3 * (4 + 4 + 3) + 5 + 8);
        let mut rest = all.iter();
        for row in rows_of(|t| [(2.0 * t).sin(), 0.0, 9.80665]) {
            let same = |other: &&Row| (&other.subject, other.name, other.unit) == (&row.subject, row.name, row.unit);
            assert!(rest.any(|other| same(&other)), "{}, {}", row.subject, row.name);
        }
    }

    #[test]
    fn a_measure_says_which_of_two_values_is_the_better() {
        let is = |kind| all_rows().into_iter().filter(|row| row.better == kind).map(|row| row.name).collect::<Vec<_>>();
        let more = ["shape", "size", "correlation", "smallest stroke margin"];
        assert!(is(Better::More).iter().all(|name| more.contains(name)));
        assert!(more.iter().all(|name| is(Better::More).contains(name)));
        for name in ["RMS error", "delay", "shake", "inverted", "shape error", "false cues", "soft limits active"] {
            assert!(is(Better::Less).contains(&name), "{name}");
        }
    }

    #[test]
    fn every_row_says_what_it_is_and_where_from() {
        let rows = rows_of(|t| [t.sin(), t.cos(), 9.80665 + 0.3 * t.sin()]);
        assert!(rows.iter().all(|row| row.definition.ends_with('.') && !row.source.is_empty()));
    }
}
