//! The table that `moris worst-case` prints.

use moris_setup::Setup;

use super::figures::Measure;
use super::points::Point;
use super::study::{MachineFigures, Study};
use crate::text_table::TextTable;

/// The whole text.
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
    let mut table = TextTable::new([
        "strategy",
        "measure, m/s²",
        "commanded",
        "nominal",
        "worst",
        "at load",
        "at bandwidth",
        "at dead time",
    ]);
    for study in studies {
        for measure in Measure::ALL {
            let name = if measure == Measure::Error { study.strategy.name() } else { "" };
            let worst = study.worst(measure);
            let number = |figures: &[f64; 3]| number(measure, figures[measure as usize]);
            table.push(vec![
                name.to_owned(),
                ["RMS error", "shake", "jolt"][measure as usize].to_owned(),
                number(&study.commanded),
                number(&study.machines[0].figures),
                number(&worst.figures),
                format!("{:.0} %", 100.0 * worst.point.load),
                format!("{:.0} %", 100.0 * worst.point.bandwidth),
                format!("{:.1} ms", 1e3 * worst.point.dead_time),
            ]);
        }
    }
    table
}

fn number(measure: Measure, value: f64) -> String {
    let decimals = [3, 2, 1][measure as usize];
    format!("{value:.decimals$}")
}

fn effect_table(studies: &[Study]) -> TextTable {
    let mut table = TextTable::new([
        "largest RMS error, m/s²",
        "load alone",
        "bandwidth alone",
        "dead time alone",
        "all",
        "machines with limited speed or stroke",
        "with limited force",
    ]);
    for study in studies {
        let nominal = study.machines[0].point;
        let largest = |of: &dyn Fn(&Point) -> bool| {
            let machines = study.machines.iter().filter(|machine| of(&machine.point));
            let error = |machine: &MachineFigures| machine.figures[Measure::Error as usize];
            number(Measure::Error, machines.map(error).fold(0.0, f64::max))
        };
        let count = |limited: fn(&MachineFigures) -> bool| {
            study.machines.iter().filter(|machine| limited(machine)).count().to_string()
        };
        table.push(vec![
            study.strategy.name().to_owned(),
            largest(&|point| *point == Point { load: point.load, ..nominal }),
            largest(&|point| *point == Point { bandwidth: point.bandwidth, ..nominal }),
            largest(&|point| *point == Point { dead_time: point.dead_time, ..nominal }),
            largest(&|_| true),
            count(|machine| machine.drive_limited),
            count(|machine| machine.force_limited),
        ]);
    }
    table
}
