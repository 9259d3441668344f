//! The measures as a list for people.

use crate::comfort::{Comfort, Excess};
use crate::cues::Cues;
use crate::effort::Effort;
use crate::fidelity::Fidelity;
use crate::measures::{Axes, Measures, Rider};
use crate::run::{LimitFlags, Platform, Run};

/// One measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Subject: `specific force x`, `sensed angular velocity y`, `platform`, ...
    pub subject: String,
    /// Measure: `RMS error`, `false cues`, ...
    pub name: &'static str,
    /// The value in `unit`; none where the measure is not defined for this run.
    pub value: Option<f64>,
    /// `m/s²`, `°/s`, `ms`, `%`, ... or empty.
    pub unit: &'static str,
    /// Definition, in a sentence.
    pub definition: &'static str,
    /// Where it is from.
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
const BOUND: &str = "docs/measures.md, the bound; solved with Clarabel (Goulart, Chen 2024)";
const THRESHOLDS: &str = "thresholds: Reid, Nahon: Flight Simulation Motion-Base Drive Algorithms, Part 1, UTIAS Report 296, \
    1985; vestibular model: Telban, Cardullo, NASA/CR-2005-213747";

impl Measures {
    /// The measures as rows, in the order in which one reads them. Axes on which nothing is desired
    /// and nothing felt are left out.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for (k, axis) in AXES.iter().enumerate() {
            rows.extend(FORCE.rows(axis, &self.force[k]));
            rows.extend(self.comfort[k].iter().flat_map(|comfort| comfort_rows(axis, comfort)));
            rows.extend(SENSED_FORCE.rows(axis, &self.sensed_force[k]));
            if self.sensed_force[k].is_some() {
                rows.extend(cue_rows(format!("sensed specific force {axis}"), &self.force_cues[k]));
            }
        }
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
    let count = 8;
    let moving: Vec<[f64; 3]> = (0..count).map(|k| [f64::from(k); 3]).collect();
    let still = vec![[0.0; 3]; moving.len()];
    let run = Run {
        step: 0.1,
        desired_force: &moving,
        felt_force: &still,
        felt_force_within_steps: &still,
        desired_rate: &moving,
        felt_rate: &still,
        platform: Platform {
            legs: &vec![[1.0; 6]; moving.len()],
            stroke: [0.5, 1.5],
            displacement: &still,
            tilt_rate: &vec![[0.0; 2]; moving.len()],
            limited: &vec![LimitFlags::default(); moving.len()],
        },
    };
    Measures::of(&run).expect("the run has equal series of numbers").rows()
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
const SENSED_FORCE: Signal =
    Signal { subject: "sensed specific force", unit: "m/s²", factor: 1.0, source: VESTIBULAR };
const SENSED_RATE: Signal =
    Signal { subject: "sensed angular velocity", unit: "°/s", factor: DEGREE, source: VESTIBULAR };

impl Signal {
    fn rows(&self, axis: &str, fidelity: &Option<Fidelity>) -> Vec<Row> {
        let Some(fidelity) = fidelity else { return Vec::new() };
        let row = |name, value, unit, definition| Row {
            subject: format!("{} {axis}", self.subject),
            name,
            value,
            unit,
            definition,
            source: self.source,
        };
        vec![
            row(
                "RMS error",
                Some(self.factor * fidelity.rms_error),
                self.unit,
                "Root mean square over the run of felt minus desired.",
            ),
            row(
                "peak error",
                Some(self.factor * fidelity.peak_error),
                self.unit,
                "Largest absolute value of felt minus desired.",
            ),
            row(
                "correlation",
                fidelity.correlation,
                "",
                "Pearson's correlation of felt and desired, which no scale changes; undefined where one of them is constant.",
            ),
            row(
                "delay",
                fidelity.delay.map(|delay| 1000.0 * delay),
                "ms",
                "How much later felt comes: the shift, within 2 s, at which the two correlate best; undefined where they \
                 correlate by less than 0.9 there.",
            ),
        ]
    }
}

fn comfort_rows(axis: &str, comfort: &Comfort) -> [Row; 3] {
    let row = |name, excess: Option<Excess>, definition| Row {
        subject: format!("specific force {axis}"),
        name,
        value: excess.map(|excess| excess.value),
        unit: "m/s²",
        definition,
        source: COMFORT,
    };
    [
        row(
            "shake",
            comfort.shake,
            "RMS over 2 s of the felt force above 8 Hz less that of the desired force, the largest over the run, at least 0; \
             undefined up to 16 samples a second and for runs of 15 samples or less.",
        ),
        row(
            "jolt",
            comfort.jolt,
            "Largest difference between two values of the felt force within 20 ms, less the largest such difference of the \
             desired force in the 60 ms around it, at least 0; undefined where less than 50 samples a second are known.",
        ),
        row(
            "peak",
            Some(comfort.peak),
            "Largest absolute value of the felt force, without gravity, less that of the desired force, at least 0.",
        ),
    ]
}

fn cue_rows(subject: String, cues: &Cues) -> [Row; 3] {
    let row = |name, fraction: f64, definition| Row {
        subject: subject.clone(),
        name,
        value: Some(100.0 * fraction),
        unit: "%",
        definition,
        source: THRESHOLDS,
    };
    [
        row(
            "sensed in the vehicle",
            cues.desired,
            "Fraction of the run in which the vehicle's motion is above the threshold.",
        ),
        row(
            "false cues",
            cues.false_cues,
            "Fraction of the run in which the platform's motion is above the threshold and the vehicle's is not, or has the \
             opposite sign.",
        ),
        row(
            "missing cues",
            cues.missing_cues,
            "Fraction of the run in which the vehicle's motion is above the threshold and the platform's is not.",
        ),
    ]
}

/// The bound of one axis, `x`, `y` or `z`, beside what was felt there.
///
/// `desired` is the RMS of the desired specific force as a deviation from rest \[m/s2\], `felt` the
/// RMS error that was felt.
pub fn bound_rows(axis: &str, desired: f64, felt: f64, bound: f64) -> [Row; 4] {
    let row = |name, value, unit, definition| Row {
        subject: format!("specific force {axis}"),
        name,
        value,
        unit,
        definition,
        source: BOUND,
    };
    let percentage = |error: f64| (desired > 0.0).then(|| 100.0 * error / desired);
    [
        row(
            "bound",
            Some(bound),
            "m/s²",
            "Smallest RMS error of any controller, even with preview of the whole recording, on the linearised axis under the \
             same limits of tilt, tilt rate, travel, speed and acceleration.",
        ),
        row(
            "gap to the bound",
            Some((felt - bound).max(0.0)),
            "m/s²",
            "RMS error beyond the bound: the most that a better controller could gain.",
        ),
        row(
            "relative error",
            percentage(felt),
            "%",
            "RMS error as a fraction of the RMS of the desired specific force without gravity; 100 % for a platform at rest.",
        ),
        row("relative bound", percentage(bound), "%", "The bound as the same fraction."),
    ]
}

fn rider_rows(rider: &Rider) -> [Row; 5] {
    let row = |name, value, unit, definition, source| Row {
        subject: "rider".to_string(),
        name,
        value,
        unit,
        definition,
        source,
    };
    let [vehicle, platform] = rider.sick;
    let [vehicle_dose, platform_dose] = rider.dose;
    [
        row(
            "sick in the vehicle",
            Some(vehicle),
            "%",
            "People who are sick after half an hour of the vehicle's motion, by the conflict between sensed and expected \
             vertical; without vision, from data of passengers.",
            SICKNESS,
        ),
        row("sick on the platform", Some(platform), "%", "The same of the platform's motion.", SICKNESS),
        row(
            "sickness dose in the vehicle",
            Some(vehicle_dose),
            "m/s^1.5",
            "Motion sickness dose value: root of the integral of the squared vertical acceleration, weighted by Wf.",
            DOSE,
        ),
        row(
            "sickness dose on the platform",
            Some(platform_dose),
            "m/s^1.5",
            "The same of the platform's motion.",
            DOSE,
        ),
        row(
            "incongruence",
            rider.incongruence.map(|incongruence| 100.0 * incongruence.value),
            "%",
            "Largest value of a low-pass of 3 s over the mismatch of lateral (66 %) and longitudinal force (34 %), relative to \
             that of a platform at rest.",
            RATING,
        ),
    ]
}

fn effort_rows(effort: &Effort) -> [Row; 8] {
    let row = |name, value, unit, definition| Row {
        subject: "platform".to_string(),
        name,
        value: Some(value),
        unit,
        definition,
        source: COMMON,
    };
    [
        row(
            "stroke used",
            100.0 * effort.stroke_used,
            "%",
            "Span from the shortest to the longest length of any actuator, as a fraction of the stroke.",
        ),
        row(
            "smallest stroke margin",
            effort.smallest_margin,
            "m",
            "Smallest distance of any actuator from either end of its stroke.",
        ),
        row(
            "largest tilt rate",
            effort.largest_tilt_rate.to_degrees(),
            "°/s",
            "Largest rate of tilt coordination in roll or pitch.",
        ),
        row(
            "tilt limited",
            100.0 * effort.tilt_limited,
            "%",
            "Fraction of the steps in which tilt coordination lagged behind its target at its rate or angle limit, or for at least 0.1 s at its acceleration limit.",
        ),
        row(
            "soft limits active",
            100.0 * effort.soft_limited,
            "%",
            "Fraction of the steps in which the soft limits changed the motion to stay within stroke, speed and acceleration.",
        ),
        row(
            "safety units active",
            100.0 * effort.safety_active,
            "%",
            "Fraction of the steps in which a safety unit limited the platform.",
        ),
        row(
            "actuators limited",
            100.0 * effort.actuator_limited,
            "%",
            "Fraction of the steps in which the actuator guard limited an actuator.",
        ),
        row(
            "final distance from neutral",
            effort.final_distance,
            "m",
            "Distance of the platform from neutral at the end.",
        ),
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
            desired_rate: &[[0.0; 3]; COUNT],
            felt_rate: &[[0.0; 3]; COUNT],
            platform: Platform {
                legs: &[[1.3; 6]; COUNT],
                stroke: [1.0, 1.6],
                displacement: &[[0.0; 3]; COUNT],
                tilt_rate: &[[0.0; 2]; COUNT],
                limited: &[LimitFlags::default(); COUNT],
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
        assert_eq!(all.len(), 3 * (4 + 3 + 4 + 3) + 3 * (4 + 4 + 3) + 5 + 8);
        let mut rest = all.iter();
        for row in rows_of(|t| [(2.0 * t).sin(), 0.0, 9.80665]) {
            let same = |other: &&Row| (&other.subject, other.name, other.unit) == (&row.subject, row.name, row.unit);
            assert!(rest.any(|other| same(&other)), "{}, {}", row.subject, row.name);
        }
    }

    #[test]
    fn every_row_says_what_it_is_and_where_from() {
        let rows = rows_of(|t| [t.sin(), t.cos(), 9.80665 + 0.3 * t.sin()]);
        assert!(rows.iter().all(|row| row.definition.ends_with('.') && !row.source.is_empty()));
    }
}
