//! The measures as a list for people: the table of them is the one place that names each.

use serde::Serialize;

use super::all::{Axes, Measures};

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

/// One measure of a run, with its value, unit, definition and source.
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

/// A measure as it is declared: a row of the tables below.
struct Measure<T: 'static = Measures> {
    name: &'static str,
    unit: &'static str,
    better: Better,
    definition: &'static str,
    source: &'static str,
    /// The value in `unit`, on an axis where the subject has axes; none where it is not defined.
    value: fn(&T, usize) -> Option<f64>,
}

impl<T> Measure<T> {
    fn row(&self, subject: String, value: Option<f64>) -> Row {
        let Measure { name, unit, better, definition, source, .. } = *self;
        Row { subject, name, value, unit, better, definition, source }
    }
}

/// A subject with its measures.
struct Subject {
    name: &'static str,
    /// Number of axes that it has, of x, y and z; 0 for the run as a whole.
    axes: usize,
    /// False for a run, or an axis of it, in which nothing happens.
    is_present: fn(&Measures, usize) -> bool,
    measures: &'static [Measure],
}

impl Subject {
    /// The measure's name on an axis.
    fn title(&self, axis: usize) -> String {
        const AXIS_NAMES: Axes<&str> = ["x", "y", "z"];
        if self.axes == 0 { self.name.to_owned() } else { format!("{} {}", self.name, AXIS_NAMES[axis]) }
    }
}

const DEGREES_PER_RADIAN: f64 = 180.0 / std::f64::consts::PI;

/// Entry for a measure that needs no source.
const COMMON_USAGE: &str = "common usage";
const VESTIBULAR_SOURCE: &str = "Telban, Cardullo: Motion Cueing Algorithm Development: Human-Centered Linear and Nonlinear \
    Approaches, NASA/CR-2005-213747";
const SHAPE_SOURCE: &str = "docs/measures.md, shape; threshold: Reid, Nahon, UTIAS Report 296, 1985";

/// Measures of one source, a row each: name, unit, the better of two values, value, definition.
macro_rules! measures {
    ($source:expr; $( $name:literal [$unit:expr] $better:ident: $value:expr, $definition:literal; )+) => {
        &[$( Measure {
            name: $name,
            unit: $unit,
            better: Better::$better,
            definition: $definition,
            source: $source,
            value: $value,
        }, )+]
    };
}

/// A subject: its name, number of axes, where something happens, and its measures.
macro_rules! subject {
    ($name:expr, $axes:literal, $is_present:expr, $($measures:tt)+) => {
        Subject { name: $name, axes: $axes, is_present: $is_present, measures: measures! { $($measures)+ } }
    };
}

/// The fidelity of a signal, whose errors are written in a unit that is so many times that of SI.
macro_rules! fidelity {
    ($name:expr, $signal:ident, $unit:expr, $factor:expr, $source:expr) => {
        subject! { $name, 3, |of, k| of.$signal[k].is_some(), $source;
            "RMS error" [$unit] Less: |of, k| of.$signal[k].map(|signal| $factor * signal.rms_error),
                "Root mean square over the run of felt minus desired.";
            "peak error" [$unit] Less: |of, k| of.$signal[k].map(|signal| $factor * signal.peak_error),
                "Largest absolute value of felt minus desired.";
            "correlation" [""] More: |of, k| of.$signal[k]?.correlation,
                "Pearson's correlation of felt and desired, which no scale changes; undefined where one of them is constant.";
            "delay" ["ms"] Less: |of, k| Some(1000.0 * of.$signal[k]?.delay?),
                "How much later felt comes: the shift, within 2 s, at which the two correlate best; undefined where they \
                 correlate by less than 0.9 there.";
        }
    };
}

/// False and missing cues of a sensed signal.
macro_rules! cues {
    ($name:expr, $sensed:ident, $cues:ident) => {
        subject! { $name, 3, |of, k| of.$sensed[k].is_some(), "thresholds: Reid, Nahon: Flight Simulation Motion-Base Drive \
        Algorithms, Part 1, UTIAS Report 296, 1985; vestibular model: Telban, Cardullo, NASA/CR-2005-213747";
            "sensed in the vehicle" ["%"] Neither: |of, k| Some(100.0 * of.$cues[k].desired),
                "Fraction of the run in which the vehicle's motion is above the threshold.";
            "false cues" ["%"] Less: |of, k| Some(100.0 * of.$cues[k].false_cues),
                "Fraction of the run in which the platform's motion is above the threshold and the vehicle's is not, or has \
                 the opposite sign.";
            "missing cues" ["%"] Less: |of, k| Some(100.0 * of.$cues[k].missing_cues),
                "Fraction of the run in which the vehicle's motion is above the threshold and the platform's is not.";
        }
    };
}

/// The subjects in the order in which one reads them: those of a group are repeated axis by axis.
const SUBJECT_GROUPS: [&[Subject]; 4] = [
    &[
        fidelity!("specific force", force, "m/s²", 1.0, COMMON_USAGE),
        subject! { "specific force", 2, |of, k| of.shape.axes[k].is_some(), SHAPE_SOURCE;
            "shape" [""] More: |of, k| Some(of.shape.axes[k]?.shape),
                "Correlation of felt and desired below 2 Hz: sign, time and proportion, whatever the size; 0 where nothing is felt.";
            "size" [""] More: |of, k| Some(of.shape.axes[k]?.size),
                "RMS of the felt force below 2 Hz over that of the desired force; 1 is full size.";
            "inverted" ["%"] Less: |of, k| Some(100.0 * of.shape.axes[k]?.inverted),
                "Fraction of the run in which the felt force below 2 Hz is above 0.17 m/s² and has the opposite sign of the desired \
                 force.";
        },
        subject! { "specific force", 3, |of, k| of.comfort[k].is_some(), "docs/measures.md, comfort";
            "shake" ["m/s²"] Less: |of, k| Some(of.comfort[k].as_ref()?.shake.as_ref()?.value),
                "RMS over 2 s of the felt force above 8 Hz less that of the desired force, the largest over the run, at least 0; \
                 undefined up to 16 samples a second and for runs of 15 samples or less.";
            "jolt" ["m/s²"] Less: |of, k| Some(of.comfort[k].as_ref()?.jolt.as_ref()?.value),
                "Largest difference between two values of the felt force within 20 ms, less the largest such difference of the \
                 desired force in the 60 ms around it, at least 0; undefined where less than 50 samples a second are known.";
            "peak" ["m/s²"] Less: |of, k| Some(of.comfort[k].as_ref()?.peak.value),
                "Largest absolute value of the felt force, without gravity, less that of the desired force, at least 0.";
        },
        fidelity!("sensed specific force", sensed_force, "m/s²", 1.0, VESTIBULAR_SOURCE),
        cues!("sensed specific force", sensed_force, force_cues),
    ],
    &[subject! { "horizontal specific force", 0, |of, _| of.shape.inverted_horizontal.is_some(), SHAPE_SOURCE;
        "inverted" ["%"] Less: |of, _| Some(100.0 * of.shape.inverted_horizontal?),
            "Fraction of the run in which the felt force below 2 Hz is above 0.17 m/s² and more than 90 degrees from the desired \
             force.";
        "shape error" ["%"] Less: |of, _| Some(100.0 * of.shape.error?),
            "RMS below 2 Hz of felt less scaled desired force, relative to the RMS of the scaled desired force; undefined at a \
             scale of 0.";
    }],
    &[
        fidelity!("angular velocity", rate, "°/s", DEGREES_PER_RADIAN, COMMON_USAGE),
        fidelity!("sensed angular velocity", sensed_rate, "°/s", DEGREES_PER_RADIAN, VESTIBULAR_SOURCE),
        cues!("sensed angular velocity", sensed_rate, rate_cues),
    ],
    &[
        subject! { "rider", 0, |_, _| true, "Inoue, Liu, Wada: Revisiting Motion Sickness Models Based on SVC Theory Considering \
        Motion Perception, SAE Technical Paper 2023-01-0176";
            "sick in the vehicle" ["%"] Neither: |of, _| Some(of.rider.sick[0]),
                "People who are sick after half an hour of the vehicle's motion, by the conflict between sensed and expected \
                 vertical; without vision, from data of passengers.";
            "sick on the platform" ["%"] Less: |of, _| Some(of.rider.sick[1]),
                "The same of the platform's motion.";
        },
        subject! { "rider", 0, |_, _| true, "ISO 2631-1";
            "sickness dose in the vehicle" ["m/s^1.5"] Neither: |of, _| Some(of.rider.dose[0]),
                "Motion sickness dose value: root of the integral of the squared vertical acceleration, weighted by Wf.";
            "sickness dose on the platform" ["m/s^1.5"] Less: |of, _| Some(of.rider.dose[1]),
                "The same of the platform's motion.";
        },
        subject! { "rider", 0, |_, _| true, "docs/measures.md, incongruence";
            "incongruence" ["%"] Less: |of, _| Some(100.0 * of.rider.incongruence.as_ref()?.value),
                "Largest value of a low-pass of 3 s over the mismatch of lateral (66 %) and longitudinal force (34 %), relative to \
                 that of a platform at rest.";
        },
        subject! { "platform", 0, |_, _| true, COMMON_USAGE;
            "stroke used" ["%"] Neither: |of, _| Some(100.0 * of.effort.stroke_used),
                "Span from the shortest to the longest length of any actuator, as a fraction of the stroke.";
            "smallest stroke margin" ["m"] More: |of, _| Some(of.effort.smallest_margin),
                "Smallest distance of any actuator from either end of its stroke.";
            "largest tilt rate" ["°/s"] Neither: |of, _| Some(of.effort.largest_tilt_rate.to_degrees()),
                "Largest rate of tilt coordination in roll or pitch.";
            "tilt limited" ["%"] Less: |of, _| Some(100.0 * of.effort.limited.tilt),
                "Fraction of the steps in which tilt coordination lagged behind its target at its rate or angle limit, or for at \
                 least 0.1 s at its acceleration limit.";
            "soft limits active" ["%"] Less: |of, _| Some(100.0 * of.effort.limited.soft),
                "Fraction of the steps in which the soft limits changed the motion to stay within stroke, speed and acceleration.";
            "safety units active" ["%"] Less: |of, _| Some(100.0 * of.effort.limited.safety),
                "Fraction of the steps in which a safety unit limited the platform.";
            "actuators limited" ["%"] Less: |of, _| Some(100.0 * of.effort.limited.actuator),
                "Fraction of the steps in which the actuator guard limited an actuator.";
            "final distance from neutral" ["m"] Less: |of, _| Some(of.effort.final_distance),
                "Distance of the platform from neutral at the end.";
        },
    ],
];

/// Values of the bound's rows: RMS of the desired force, RMS error that was felt, and the bound
/// \[m/s2\].
type BoundValues = [f64; 3];

const BOUND_MEASURES: &[Measure<BoundValues>] = measures! { "docs/measures.md, the bound; an interior-point method after Rao, Wright, Rawlings 1998";
    "bound" ["m/s²"] Neither: |[_, _, bound], _| Some(*bound),
        "Smallest RMS error of any controller, even with preview of the whole recording, on the linearised axis under the \
         same limits of tilt, tilt rate, travel, speed and acceleration.";
    "gap to the bound" ["m/s²"] Less: |[_, felt, bound], _| Some((felt - bound).max(0.0)),
        "RMS error beyond the bound: the most that a better controller could gain.";
    "relative error" ["%"] Less: |[desired, felt, _], _| error_percentage(*felt, *desired),
        "RMS error as a fraction of the RMS of the desired specific force without gravity; 100 % for a platform at rest.";
    "relative bound" ["%"] Neither: |[desired, _, bound], _| error_percentage(*bound, *desired),
        "The bound as the same fraction.";
};

fn error_percentage(error: f64, desired: f64) -> Option<f64> {
    (desired > 0.0).then(|| 100.0 * error / desired)
}

/// Every measure of every subject, in the order of the rows, with the axis.
fn listed_measures() -> impl Iterator<Item = (&'static Subject, usize, &'static Measure)> {
    SUBJECT_GROUPS.iter().flat_map(|group| {
        let axes = group.iter().map(|subject| subject.axes).max().unwrap_or_default();
        let on_axis =
            move |axis| group.iter().filter(move |subject| axis < subject.axes.max(1)).map(move |of| (of, axis));
        (0..axes.max(1))
            .flat_map(on_axis)
            .flat_map(|(of, axis)| of.measures.iter().map(move |measure| (of, axis, measure)))
    })
}

/// Every measure in the order of the rows, without values: the rows of any run are among them, in
/// this order.
pub fn all_rows() -> Vec<Row> {
    listed_measures().map(|(subject, axis, measure)| measure.row(subject.title(axis), None)).collect()
}

impl Measures {
    /// The measures as rows, in the order in which one reads them. Axes on which nothing is desired
    /// and nothing felt are left out.
    pub fn rows(&self) -> Vec<Row> {
        let present = listed_measures().filter(|(subject, axis, _)| (subject.is_present)(self, *axis));
        present.map(|(subject, axis, measure)| measure.row(subject.title(axis), (measure.value)(self, axis))).collect()
    }

    /// The value of each of [`all_rows`]; none where it is not defined.
    pub fn values(&self) -> impl Iterator<Item = Option<f64>> {
        listed_measures().map(|(subject, axis, measure)| {
            (subject.is_present)(self, axis).then(|| (measure.value)(self, axis)).flatten()
        })
    }
}

/// The bound of one axis, `x`, `y` or `z`, beside what was felt there.
///
/// `desired` is the RMS of the desired specific force as a deviation from rest \[m/s2\], `felt` the
/// RMS error that was felt.
pub fn bound_rows(axis: &str, desired: f64, felt: f64, bound: f64) -> Vec<Row> {
    let values = [desired, felt, bound];
    let row =
        |measure: &Measure<BoundValues>| measure.row(format!("specific force {axis}"), (measure.value)(&values, 0));
    BOUND_MEASURES.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::super::run::{Limits, Platform, Run};
    use super::*;

    const COUNT: usize = 500;

    fn rows_of(force: impl Fn(f64) -> [f64; 3]) -> Vec<Row> {
        measures_of(force).rows()
    }

    /// The measures of a run on which half of the surge and all of the rest is felt.
    fn measures_of(force: impl Fn(f64) -> [f64; 3]) -> Measures {
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
        Measures::of(&run).unwrap()
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
    fn the_values_are_those_of_the_rows_at_their_places_in_the_list() {
        let measures = measures_of(|t| [(2.0 * t).sin(), 0.0, 9.80665]);
        let (all, rows) = (all_rows(), measures.rows());
        let values: Vec<Option<f64>> = measures.values().collect();
        assert_eq!(values.len(), all.len());
        for (listed, value) in all.into_iter().zip(values) {
            let found = rows.iter().find(|row| (&row.subject, row.name) == (&listed.subject, listed.name));
            assert_eq!(found.and_then(|row| row.value), value, "{listed:?}");
            assert!(found.is_none_or(|row| *row == Row { value, ..listed }));
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
