//! Consistency of a report's data.

use thiserror::Error;

use crate::report::data::{LimitHistory, Report, Run};

/// Why no page can be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ReportError {
    #[error("the report has no runs: give it at least one")]
    NoRuns,
    #[error("run {selected} is selected but there are {runs}, counted from 0")]
    NoSuchRun { selected: usize, runs: usize },
    #[error("run \"{run}\" has {samples} samples: a run has at least two")]
    TooShort { run: String, samples: usize },
    #[error("run \"{run}\": time {index} is not a number or does not come after the time before it")]
    Times { run: String, index: usize },
    #[error("run \"{run}\": {series} has {found} values, but there are {expected} times")]
    Length { run: String, series: String, found: usize, expected: usize },
    #[error("the rig's stroke must go from a shorter to a longer length")]
    Stroke,
}

/// # Errors
/// The first thing that does not fit, and where.
pub fn check(report: &Report) -> Result<(), ReportError> {
    if report.runs.is_empty() {
        return Err(ReportError::NoRuns);
    }
    if report.selected >= report.runs.len() {
        return Err(ReportError::NoSuchRun { selected: report.selected, runs: report.runs.len() });
    }
    let [shortest, longest] = report.rig.stroke;
    if shortest.is_nan() || longest.is_nan() || shortest >= longest {
        return Err(ReportError::Stroke);
    }
    report.runs.iter().try_for_each(check_run)
}

fn check_run(run: &Run) -> Result<(), ReportError> {
    let name = || run.name.clone();
    if run.times.len() < 2 {
        return Err(ReportError::TooShort { run: name(), samples: run.times.len() });
    }
    ascending(&run.times).map_err(|index| ReportError::Times { run: name(), index })?;
    for (series, found) in series_of(run) {
        if found != run.times.len() {
            return Err(ReportError::Length { run: name(), series, found, expected: run.times.len() });
        }
    }
    for chart in &run.charts {
        ascending(&chart.times).map_err(|index| ReportError::Times { run: name(), index })?;
        let expected = if chart.times.is_empty() { run.times.len() } else { chart.times.len() };
        if let Some(line) = chart.lines.iter().find(|line| line.values.len() != expected) {
            let series = format!("the line \"{}\" of the chart \"{}\"", line.label, chart.title);
            return Err(ReportError::Length { run: name(), series, found: line.values.len(), expected });
        }
    }
    Ok(())
}

/// The index of the first time that is not finite or not after the one before, if there is one.
fn ascending(times: &[f64]) -> Result<(), usize> {
    let wrong = |&index: &usize| !times[index].is_finite() || (index > 0 && times[index] <= times[index - 1]);
    (0..times.len()).find(wrong).map_or(Ok(()), Err)
}

/// Names and lengths of a run's series.
fn series_of(run: &Run) -> Vec<(String, usize)> {
    let groups: [(&str, &[Vec<f64>]); 9] = [
        ("desired specific force", &run.desired.specific_force),
        ("desired angular velocity", &run.desired.angular_velocity),
        ("felt specific force", &run.felt.specific_force),
        ("felt angular velocity", &run.felt.angular_velocity),
        ("position", &run.position),
        ("orientation", &run.orientation),
        ("leg", &run.legs),
        ("tilt", &run.tilt),
        ("tilt rate", &run.tilt_rate),
    ];
    let mut lengths: Vec<(String, usize)> = groups
        .iter()
        .flat_map(|(name, group)| group.iter().enumerate().map(move |(i, one)| (format!("{name}[{i}]"), one.len())))
        .collect();
    let LimitHistory { tilt, soft, safety, actuator, .. } = &run.limited;
    for (name, flags) in [("tilt", tilt), ("soft", soft), ("safety", safety), ("actuator", actuator)] {
        lengths.push((format!("limited.{name}"), flags.len()));
    }
    if !run.lean.is_empty() {
        lengths.push(("lean".into(), run.lean.len()));
    }
    lengths
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::report::data::{Chart, Cues, Line, Rig};

    /// The smallest report that there can be: two samples of one run.
    pub(crate) fn smallest() -> Report {
        fn zeros<const N: usize>() -> [Vec<f64>; N] {
            std::array::from_fn(|_| vec![0.0; 2])
        }
        let cues = || Cues { specific_force: zeros(), angular_velocity: zeros() };
        let run = Run {
            name: "default".into(),
            times: vec![0.0, 0.1],
            desired: cues(),
            felt: cues(),
            position: zeros(),
            orientation: zeros(),
            legs: zeros(),
            tilt: zeros(),
            tilt_rate: zeros(),
            limited: LimitHistory {
                tilt: vec![false; 2],
                soft: vec![false; 2],
                safety: vec![false; 2],
                actuator: vec![false; 2],
                ..LimitHistory::default()
            },
            ..Run::default()
        };
        Report { rig: Rig { stroke: [1.0, 1.6], ..Rig::default() }, runs: vec![run], ..Report::default() }
    }

    /// Error of the smallest report after a change.
    fn error_of(change: impl Fn(&mut Report)) -> String {
        let mut report = smallest();
        change(&mut report);
        check(&report).map_or_else(|error| error.to_string(), |()| "nothing".into())
    }

    #[test]
    fn the_smallest_report_is_good() {
        assert_eq!(error_of(|_| ()), "nothing");
    }

    #[test]
    fn what_does_not_fit_is_named() {
        assert!(error_of(|report| report.runs.clear()).contains("no runs"));
        assert!(error_of(|report| report.selected = 1).contains("run 1 is selected but there are 1"));
        assert!(error_of(|report| report.rig.stroke = [1.6, 1.0]).contains("stroke"));
        assert!(error_of(|report| report.rig.stroke = [f64::NAN, 1.0]).contains("stroke"));
        assert!(error_of(|report| report.runs[0].times.truncate(1)).contains("\"default\" has 1 samples"));
        assert!(error_of(|report| report.runs[0].times[1] = 0.0).contains("time 1"));
        assert!(error_of(|report| report.runs[0].times[1] = f64::NAN).contains("time 1"));
        assert!(
            error_of(|report| report.runs[0].legs[4].push(1.0)).contains("leg[4] has 3 values, but there are 2 times")
        );
        assert!(error_of(|report| report.runs[0].lean.push(0.1)).contains("lean has 1"));
        assert!(error_of(|report| report.runs[0].limited.safety.clear()).contains("limited.safety has 0"));
    }

    #[test]
    fn a_chart_has_as_many_values_as_times_of_its_own_or_of_the_run() {
        let chart = |times: &[f64], values: &[f64]| Chart {
            title: "bound".into(),
            times: times.into(),
            lines: vec![Line { label: "best".into(), values: values.into() }],
            ..Chart::default()
        };
        let with = |one: &Chart| error_of(|report| report.runs[0].charts.push(one.clone()));
        assert_eq!(with(&chart(&[], &[1.0, 2.0])), "nothing");
        assert_eq!(with(&chart(&[0.0, 0.5, 1.0], &[1.0, f64::NAN, 2.0])), "nothing");
        assert!(with(&chart(&[], &[1.0])).contains("the line \"best\" of the chart \"bound\" has 1 values"));
        assert!(with(&chart(&[1.0, 0.5], &[1.0, 2.0])).contains("time 1"));
    }
}
