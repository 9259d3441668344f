//! `moris bench`: washouts compared on fixed drives and rigs.
//!
//! [`moris_analysis::bench`] computes the rows. [`table`] writes them as CSV, and prints their
//! means; [`page`] writes them as a page.

pub mod page;
pub mod table;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::builder::PossibleValuesParser;
use moris_analysis::bench::drives::{BENCH_DRIVES, Drive};
use moris_analysis::bench::run::{Foreign, Row, rigs, rows};
use moris_washout::interface::StrategyKind;
use rayon::prelude::*;

use crate::progress::Progress;
use crate::setup_options::strategies;

/// Compare washouts on fixed drives and rigs
///
/// Simulates each drive on each rig with each strategy: with the vehicle's force unscaled, at the
/// scale that `moris fit` finds, and with the automatic scale. Writes bench.csv with a row for
/// each and bench.html with the means, which it prints. A platform at rest is the first row of each
/// drive. The bound and the best attained stand beside every error. The same program writes the
/// same bytes each time.
///
/// A washout of your own: write the drives with --write-drives, compute its motion for each, and
/// give the folder of the results with --felt. Or give its FMU with --washout. docs/bench.md has
/// the steps.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Drives, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = PossibleValuesParser::new(BENCH_DRIVES.iter().map(|drive| drive.name.as_str())))]
    drive: Vec<String>,

    /// Rigs, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = PossibleValuesParser::new(rigs()))]
    rig: Vec<String>,

    /// Strategies, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = strategies())]
    strategy: Vec<StrategyKind>,

    /// Folder with the motion that another washout computed: RIG/DRIVE.csv, or DRIVE.csv for every
    /// rig. docs/your-washout.md has the columns. The folder's name is the washout's
    #[arg(long, value_name = "FOLDER")]
    felt: Vec<PathBuf>,

    /// Another washout as an FMU for co-simulation of FMI 2.0 or 3.0, which is stepped through each
    /// drive. Its poses do not know the rig: choose the one that it is for with --rig
    #[arg(long, value_name = "FMU", requires = "map")]
    washout: Option<PathBuf>,

    /// Map of the inputs and outputs of --washout, in TOML. docs/your-washout.md has an example
    #[arg(long, value_name = "FILE", requires = "washout")]
    map: Option<PathBuf>,

    /// Write the drives as recordings into a folder, and end
    #[arg(long, value_name = "FOLDER")]
    write_drives: Option<PathBuf>,

    /// Directory for bench.csv and bench.html
    #[arg(long, value_name = "DIRECTORY", default_value = crate::REPORT_DIRECTORY)]
    report: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A file cannot be read or written, or a motion cannot be judged.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let chosen = |name: &str, names: &[String]| names.is_empty() || names.iter().any(|other| other == name);
    let drives: Vec<&Drive> = BENCH_DRIVES.iter().filter(|drive| chosen(&drive.name, &options.drive)).collect();
    if let Some(folder) = &options.write_drives {
        write_drives(folder, &drives, out)?;
        return Ok(ExitCode::SUCCESS);
    }
    let rigs: Vec<&str> = rigs().filter(|rig| chosen(rig, &options.rig)).collect();
    let chosen = |strategy: &StrategyKind| options.strategy.is_empty() || options.strategy.contains(strategy);
    let strategies: Vec<StrategyKind> = StrategyKind::ALL.iter().copied().filter(chosen).collect();
    let fmu = options.washout.iter().zip(&options.map).map(|(file, map)| Ok(Foreign::fmu(file, map)?));
    let foreign = options.felt.iter().map(|folder| felt_motion(folder)).chain(fmu).collect::<Result<Vec<_>>>()?;
    let pairs: Vec<(&str, &Drive)> =
        rigs.iter().flat_map(|rig| drives.iter().map(move |drive| (*rig, *drive))).collect();
    if !foreign.is_empty() && !pairs.iter().any(|(rig, drive)| foreign.iter().any(|one| one.file(rig, drive).is_some()))
    {
        bail!("--felt: there is no file DRIVE.csv or RIG/DRIVE.csv, such as {}.csv", drives[0].name);
    }
    let progress = Progress::new("bench", "simulating")?;
    let of_pair = |(rig, drive): &(&'static str, &'static Drive)| Ok(rows(rig, drive, &strategies, &foreign)?);
    let rows: Vec<Row> = pairs.par_iter().map(of_pair).collect::<Result<Vec<_>>>()?.concat();
    progress.finish();
    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    let file = options.report.join("bench.csv");
    let page = options.report.join("bench.html");
    table::write(&file, &rows)?;
    page::write(&page, &rows)?;
    write!(out, "{}", table::text(&rows, drives.len(), rigs.len()))?;
    for remark in distinct_remarks(&rows) {
        writeln!(out, "{remark}\n")?;
    }
    writeln!(out, "wrote {}\nwrote {}", file.display(), page.display())?;
    Ok(ExitCode::SUCCESS)
}

/// The washout whose motion is in a folder.
fn felt_motion(folder: &Path) -> Result<Foreign> {
    if !folder.is_dir() {
        bail!("--felt {}: there is no such folder", folder.display());
    }
    Ok(Foreign::of(folder))
}

/// The remarks on the motions of each other washout: each once, with the first drive and rig.
fn distinct_remarks(rows: &[Row]) -> Vec<String> {
    let mut found: Vec<(&str, &str, String, usize)> = Vec::new();
    for row in rows {
        for remark in &row.remarks {
            match found.iter_mut().find(|(washout, text, ..)| *washout == row.washout && text == remark) {
                Some((.., count)) => *count += 1,
                None => found.push((&row.washout, remark, format!("{} on {}", row.drive, row.rig), 1)),
            }
        }
    }
    let written = |(washout, text, first, count): (&str, &str, String, usize)| {
        let more = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        format!("{washout}, {first}{more}: {text}")
    };
    found.into_iter().map(written).collect()
}

/// Writes the drives as recordings.
fn write_drives(folder: &Path, drives: &[&Drive], out: &mut dyn Write) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for drive in drives {
        let file = folder.join(format!("{}.csv", drive.name));
        let mut text = "time,ax,ay,az,wx,wy,wz,speed\n".to_owned();
        let manoeuvre = drive.manoeuvre();
        for (k, input) in manoeuvre.inputs().iter().enumerate() {
            let (force, rate) = (input.specific_force, input.angular_velocity);
            let values = [force.x, force.y, force.z, rate.x, rate.y, rate.z, input.speed];
            let fields = values.map(|value| value.to_string()).join(",");
            text += &format!("{:.2},{fields}\n", k as f64 * manoeuvre.step());
        }
        fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
        writeln!(out, "wrote {}: {}", file.display(), drive.text)?;
    }
    Ok(())
}
