//! The table that `moris worst-case` prints.

use moris_analysis::worst_case::figures::Measure;
use moris_analysis::worst_case::points::Point;
use moris_analysis::worst_case::study::{MachineFigures, Study};
use moris_setup::Setup;

use crate::text_table::{Column, TextTable};

/// The tables of all studies, as text.
pub fn text(setup: &Setup, rides: usize, studies: &[Study]) -> String {
    let machines = studies.first().map_or(0, |study| study.machines.len());
    let mut text = format!(
        "{}, parameters {}, {rides} recordings, {machines} machines\n\n",
        setup.rig_name, setup.parameters_name
    );
    text += &format!("{}\n{}", figure_table(studies), effect_table(studies));
    text
}

fn figure_table(studies: &[Study]) -> TextTable {
    let columns: [Column<(&Study, Measure)>; 8] = [
        ("strategy", |(study, measure)| if *measure == Measure::Error { study.strategy.name() } else { "" }.to_owned()),
        ("measure, m/s²", |(_, measure)| ["RMS error", "shake", "jolt"][*measure as usize].to_owned()),
        ("commanded", |(study, measure)| number(*measure, study.commanded[*measure as usize])),
        ("nominal", |(study, measure)| number(*measure, study.machines[0].figures[*measure as usize])),
        ("worst", |(study, measure)| number(*measure, study.worst(*measure).figures[*measure as usize])),
        ("at load", |(study, measure)| format!("{:.0} %", 100.0 * study.worst(*measure).point.load)),
        ("at bandwidth", |(study, measure)| format!("{:.0} %", 100.0 * study.worst(*measure).point.bandwidth)),
        ("at dead time", |(study, measure)| format!("{:.1} ms", 1e3 * study.worst(*measure).point.dead_time)),
    ];
    TextTable::of(&columns, studies.iter().flat_map(|study| Measure::ALL.map(|measure| (study, measure))))
}

fn number(measure: Measure, value: f64) -> String {
    let decimals = [3, 2, 1][measure as usize];
    format!("{value:.decimals$}")
}

fn effect_table(studies: &[Study]) -> TextTable {
    let columns: [Column<Study>; 7] = [
        ("largest RMS error, m/s²", |study| study.strategy.name().to_owned()),
        ("load alone", |study| largest(study, |point, nominal| Point { load: point.load, ..nominal })),
        ("bandwidth alone", |study| largest(study, |point, nominal| Point { bandwidth: point.bandwidth, ..nominal })),
        ("dead time alone", |study| largest(study, |point, nominal| Point { dead_time: point.dead_time, ..nominal })),
        ("all", |study| largest(study, |point, _| point)),
        ("machines with limited speed or stroke", |study| count(study, |machine| machine.drive_limited)),
        ("with limited force", |study| count(study, |machine| machine.force_limited)),
    ];
    TextTable::of(&columns, studies)
}

/// The largest error on machines that are what `like` makes of them and the nominal one.
fn largest(study: &Study, like: fn(Point, Point) -> Point) -> String {
    let nominal = study.machines[0].point;
    let machines = study.machines.iter().filter(|machine| machine.point == like(machine.point, nominal));
    let errors = machines.map(|machine| machine.figures[Measure::Error as usize]);
    number(Measure::Error, errors.fold(0.0, f64::max))
}

fn count(study: &Study, is_limited: fn(&MachineFigures) -> bool) -> String {
    study.machines.iter().filter(|machine| is_limited(machine)).count().to_string()
}
