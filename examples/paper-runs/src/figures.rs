//! The paper's figures 5 to 9: felt against desired specific force and angular velocity, and the
//! legs; and one that compares the strategies.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use plotters::style::{BLACK, RGBColor};

use crate::chart::{Curve, Panel, Stroke, draw};
use crate::trace::{Sample, Trace};
use moris_simulation::drives::runs::{RUN_A, RUN_B, RUN_C, TOWN_RUN};

/// Colours that the colour-blind tell apart too (Okabe and Ito's).
const COLOUR_BLUE: RGBColor = RGBColor(0, 114, 178);
const COLOUR_GREEN: RGBColor = RGBColor(0, 158, 115);
const COLOUR_PURPLE: RGBColor = RGBColor(204, 121, 167);

const PANEL_HEIGHT: u32 = 560;

/// Writes `figure-5.svg` to `figure-9.svg` into the directory and returns their paths.
///
/// # Errors
/// A run is missing from the traces, or a file cannot be written.
pub fn write_figures(directory: &Path, traces: &[Trace]) -> Result<Vec<PathBuf>> {
    let a = traces_of_run(traces, RUN_A.name)?;
    let b = traces_of_run(traces, RUN_B.name)?;
    let c = traces_of_run(traces, RUN_C.name)?;
    let figures = [
        ("figure-5.svg", vec![force_panel("Figure 5 (a)", &a, 0), force_panel("Figure 5 (b)", &a, 2)]),
        ("figure-6.svg", vec![rate_panel("Figure 6 (a)", &a, 1), leg_panel("Figure 6 (b)", a[0])]),
        ("figure-7.svg", vec![force_panel("Figure 7 (a)", &b, 0), force_panel("Figure 7 (b)", &b, 1)]),
        ("figure-8.svg", vec![force_panel("Figure 8 (a)", &b, 2), rate_panel("Figure 8 (b)", &b, 0)]),
        ("figure-9.svg", vec![force_panel("Figure 9", &c, 0)]),
    ];
    let write = |(name, panels): &(&str, Vec<Panel>)| {
        let path = directory.join(name);
        draw(&path, panels, PANEL_HEIGHT).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    };
    figures.iter().map(write).collect()
}

/// Writes a figure of the strategies on run c and on the ride through town.
///
/// # Errors
/// One of these runs is missing from the traces, or the file cannot be written.
pub fn write_strategies(path: &Path, traces: &[Trace]) -> Result<()> {
    let (c, town) = (traces_of_run(traces, RUN_C.name)?, traces_of_run(traces, TOWN_RUN.name)?);
    let panels = [("a", &c, 0), ("b", &town, 0), ("c", &town, 1)]
        .map(|(letter, runs, axis)| with_roughest_second(force_panel(&format!("Strategies ({letter})"), runs, axis)));
    draw(path, &panels, PANEL_HEIGHT).with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a figure of the ride through town: surge and sway, and the legs.
///
/// # Errors
/// The ride is missing from the traces, or the file cannot be written.
pub fn write_ride(path: &Path, traces: &[Trace]) -> Result<()> {
    const RIDE_PANEL_HEIGHT: u32 = 360;
    let ride = traces_of_run(traces, TOWN_RUN.name)?;
    let surge = "Surge: what the vehicle asks for, and what the rider feels".to_owned();
    let panels = [
        with_roughest_second(Panel { title: surge, ..force_panel("", &ride, 0) }),
        with_roughest_second(Panel { title: "Sway".to_owned(), ..force_panel("", &ride, 1) }),
        Panel { title: "What the six legs do for it".to_owned(), ..leg_panel("", ride[0]) },
    ];
    draw(path, &panels, RIDE_PANEL_HEIGHT).with_context(|| format!("cannot write {}", path.display()))
}

/// The traces of one run, at least one.
fn traces_of_run<'a>(traces: &'a [Trace], run: &str) -> Result<Vec<&'a Trace>> {
    let runs: Vec<_> = traces.iter().filter(|trace| trace.run == run).collect();
    anyhow::ensure!(!runs.is_empty(), "run {run} has not been made");
    Ok(runs)
}

fn force_panel(figure: &str, runs: &[&Trace], axis: usize) -> Panel {
    const FORCE_LABEL: &str = "specific force [m/s²]";
    let quantity = format!("specific force along {}_H", ["x", "y", "z"][axis]);
    Panel {
        title: format!("{figure}: {quantity}, run {}", runs[0].run),
        quantity: FORCE_LABEL,
        curves: felt_against_desired(runs, |s| s.desired_force[axis], |s| s.felt_force[axis]),
        ..Panel::default()
    }
}

fn rate_panel(figure: &str, runs: &[&Trace], axis: usize) -> Panel {
    const RATE_LABEL: &str = "angular velocity [deg/s]";
    let quantity = format!("ω_{} at the head", ["x", "y", "z"][axis]);
    Panel {
        title: format!("{figure}: {quantity}, run {}", runs[0].run),
        quantity: RATE_LABEL,
        curves: felt_against_desired(runs, |s| s.desired_rate[axis].to_degrees(), |s| s.felt_rate[axis].to_degrees()),
        ..Panel::default()
    }
}

/// The panel with the second in which a felt curve has least of the desired curve's shape: where
/// the standard deviation of their difference is largest. The desired curve is the first.
fn with_roughest_second(panel: Panel) -> Panel {
    let (desired, felt) = panel.curves.split_first().expect("a desired curve");
    let roughest = felt.iter().map(|curve| roughest_second(&desired.points, &curve.points));
    let enlarged = roughest.max_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, from)| from);
    Panel { enlarged, ..panel }
}

/// Largest variance within a second of the difference of two curves at the same times, and the
/// start of that second.
fn roughest_second(desired: &[(f64, f64)], felt: &[(f64, f64)]) -> (f64, f64) {
    let step = felt[1].0 - felt[0].0;
    let count = ((1.0 / step).round() as usize).clamp(1, felt.len());
    let errors: Vec<f64> = desired.iter().zip(felt).map(|(desired, felt)| felt.1 - desired.1).collect();
    let variance = |errors: &[f64]| {
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / errors.len() as f64
    };
    // Each twentieth of a second is near enough.
    let begins = (0..=felt.len() - count).step_by((count / 20).max(1));
    let each = begins.map(|begin| (variance(&errors[begin..begin + count]), felt[begin].0));
    each.max_by(|one, other| one.0.total_cmp(&other.0)).expect("a curve of points")
}

/// Desired motion of a run, and felt motion with each parameter set.
fn felt_against_desired(
    runs: &[&Trace],
    desired: impl Fn(&Sample) -> f64,
    felt: impl Fn(&Sample) -> f64,
) -> Vec<Curve> {
    const COLOUR_VERMILION: RGBColor = RGBColor(213, 94, 0);
    const COLOUR_GREY: RGBColor = RGBColor(170, 170, 170);
    let mut curves = vec![trace_curve("desired", COLOUR_GREY, Stroke::Broad, runs[0], desired)];
    let colours = [COLOUR_BLUE, COLOUR_VERMILION, COLOUR_GREEN, COLOUR_PURPLE, BLACK];
    assert!(runs.len() <= colours.len(), "no colour for each of {} curves", runs.len());
    for (run, colour) in runs.iter().zip(colours) {
        let label = match runs.len() {
            1 => "felt".into(),
            2 => format!("felt, parameters “{}”", run.parameters),
            // So that the legend fits into a row.
            _ => run.parameters.into(),
        };
        curves.push(trace_curve(&label, colour, Stroke::Fine, run, &felt));
    }
    curves
}

/// The six legs. In a straight run legs 2, 6 and 5 do as 1, 3 and 4 do, and are dashed on top of
/// them to show it.
fn leg_panel(figure: &str, run: &Trace) -> Panel {
    const COLOUR_SKY: RGBColor = RGBColor(86, 180, 233);
    const COLOUR_ORANGE: RGBColor = RGBColor(230, 159, 0);
    let styles = [
        (COLOUR_BLUE, Stroke::Broad),
        (COLOUR_ORANGE, Stroke::Dashed),
        (COLOUR_GREEN, Stroke::Broad),
        (COLOUR_SKY, Stroke::Broad),
        (BLACK, Stroke::Dashed),
        (COLOUR_PURPLE, Stroke::Dashed),
    ];
    let leg = |(i, (colour, stroke))| trace_curve(&format!("leg {}", i + 1), colour, stroke, run, |s| s.legs[i]);
    Panel {
        title: format!("{figure}: actuators' lengths, run {}", run.run),
        quantity: "length [m]",
        curves: styles.into_iter().enumerate().map(leg).collect(),
        limits: run.stroke.to_vec(),
        ..Panel::default()
    }
}

fn trace_curve(label: &str, colour: RGBColor, stroke: Stroke, trace: &Trace, value: impl Fn(&Sample) -> f64) -> Curve {
    let points = trace.samples.iter().map(|sample| (sample.time, value(sample))).collect();
    Curve { label: label.into(), colour, stroke, points }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter_set::STRATEGY_SETS;
    use moris_simulation::drives::runs::Manoeuvre;

    /// A run felt a tenth of a second late.
    fn trace(run: &Manoeuvre, parameters: &'static str) -> Trace {
        let sample = |k: u32| {
            let time = f64::from(k) * 0.01;
            let (now, before) = (run.motion(time), run.motion(time - 0.1));
            Sample {
                time,
                desired_force: now.specific_force(),
                desired_rate: now.angular_velocity(),
                felt_force: before.specific_force(),
                felt_rate: before.angular_velocity(),
                legs: [1.3; 6],
                ..Sample::default()
            }
        };
        let samples = (0..(100.0 * run.duration) as u32).map(sample).collect();
        Trace { run: run.name, parameters, step: 0.01, stroke: [1.0, 1.6], samples, ..Trace::default() }
    }

    #[test]
    fn every_figure_is_drawn_with_its_title_and_legend() {
        let directory = std::env::temp_dir().join(format!("paper-runs-figures-{}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        let traces =
            [trace(&RUN_A, "paper"), trace(&RUN_B, "paper"), trace(&RUN_B, "small-motions"), trace(&RUN_C, "paper")];
        let paths = write_figures(&directory, &traces).unwrap();
        let drawings: Vec<String> = paths.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
        std::fs::remove_dir_all(&directory).unwrap();

        let titles =
            ["Figure 5 (a): specific", "Figure 6 (b): act", "Figure 7 (b): specific", "Figure 8 (b): ω_x", "Figure 9:"];
        assert_eq!(drawings.len(), titles.len());
        for (drawing, title) in drawings.iter().zip(titles) {
            assert!(drawing.contains(title), "{title}");
            assert!(drawing.contains("time [s]"));
            assert!(drawing.len() < 400_000, "{} is {} bytes", title, drawing.len());
        }
        assert!(drawings[1].contains("leg 6") && drawings[1].contains("limits"));
        assert!(drawings[2].contains("felt, parameters “small-motions”"));
    }

    #[test]
    fn the_strategies_are_told_apart_in_their_figure() {
        let file = std::env::temp_dir().join(format!("paper-runs-strategies-{}.svg", std::process::id()));
        let names = STRATEGY_SETS.map(|set| set.name);
        let traces: Vec<_> = [RUN_C, TOWN_RUN].iter().flat_map(|run| names.map(|name| trace(run, name))).collect();
        write_strategies(&file, &traces).unwrap();
        let drawing = std::fs::read_to_string(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        assert!(["run c", "run town"].iter().all(|title| drawing.contains(title)));
        assert!(names.iter().all(|name| drawing.matches(name).count() == 3));
    }

    #[test]
    fn the_roughest_second_has_the_needle_not_the_offset() {
        let points =
            |value: &dyn Fn(f64) -> f64| (0..1000).map(|k| 0.01 * f64::from(k)).map(|t| (t, value(t))).collect();
        let desired: Vec<(f64, f64)> = points(&|t: f64| t.sin());
        let felt: Vec<(f64, f64)> = points(&|t: f64| {
            if t > 8.0 { t.sin() + 3.0 } else { t.sin() + 4.0 * (-(t - 5.3_f64).powi(2) / 0.002).exp() }
        });
        let (variance, from) = roughest_second(&desired[..800], &felt[..800]);
        assert!(variance > 0.1 && (4.3..5.3).contains(&from), "{variance} from {from}");
        let (variance, _) = roughest_second(&desired[810..], &felt[810..]);
        assert!(variance < 1e-12, "a lasting offset is not rough: {variance}");
    }

    #[test]
    fn a_missing_run_is_an_error_that_names_it() {
        let error = write_figures(Path::new("."), &[trace(&RUN_A, "default")]).unwrap_err();
        assert_eq!(error.to_string(), "run b has not been made");
    }
}
