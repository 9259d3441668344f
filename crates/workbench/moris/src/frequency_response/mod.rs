//! `moris frequency-response`: the frequency response of the whole washout, from the head in the
//! vehicle to the head on the platform.
//!
//! Sines of twelve frequencies are applied to one channel at a time, as in the objective motion
//! cueing test of ICAO Doc 9625, by [`moris_simulation::frequency_response`]. The results are
//! shown by [`table`] and [`picture`].

pub mod picture;
pub mod table;

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Error, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
pub use moris_analysis::frequency_response::Measured;
use moris_analysis::frequency_response::limits::Limit;
use moris_simulation::frequency_response::channel::{CROSS_CHANNELS, direct};
use moris_simulation::frequency_response::excitation::Amplitudes;

use crate::setup_options::SetupOptions;
use crate::status::WORSE_RESULT;
use crate::text;
use crate::words::option;

/// Measure the frequency response of the whole washout
///
/// The test follows ICAO Doc 9625's objective motion cueing test. The vehicle moves on one channel
/// at a time: surge, sway, heave, roll, pitch or yaw. The motion consists of sines of twelve
/// frequencies from 0.1 to 15.8 rad/s. The felt motion is compared with it on the same channel and
/// on those coupled by gravity. Each test is made twice. With the amplitudes below, the tilt's rate
/// limit may be active. With a thousandth of them, the response is that of the linear filters.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    setup: SetupOptions,

    /// Amplitude of the specific force [m/s2]
    #[arg(long, value_name = "M/S2", default_value_t = 1.0)]
    force: f64,

    /// Amplitude of the angular velocity [deg/s]. At low frequencies the angle is limited to 6 deg,
    /// at high ones the angular acceleration to 10 deg/s2, both times this value
    #[arg(long, value_name = "DEG/S", default_value_t = 1.0)]
    rate: f64,

    /// Let orientation and gravity follow the vehicle's roll and pitch, as for a vehicle
    /// that tilts without accelerating. By default only the rates are present, as for a
    /// motorcycle in a balanced turn
    #[arg(long)]
    gravity_turns: bool,

    /// Move the nominal platform with its drives by the commands, in place of one that
    /// moves exactly as commanded
    #[arg(long, conflicts_with = "measured")]
    platform: bool,

    /// Recordings of the test on a real machine, one for each channel and frequency, in place of a
    /// simulation. The columns rider.specificForce.x to .z and rider.angularVelocity.x to .z hold
    /// what was measured at the head
    #[arg(long, value_name = "FILES", num_args = 1.., value_delimiter = ',')]
    measured: Vec<PathBuf>,

    /// CSV file of bounds of one's own: channel, frequency, and any of modulus_low, modulus_high,
    /// phase_low, phase_high. The verdict is printed, and the exit status is 4 where a bound is not
    /// held
    #[arg(long, value_name = "FILE.csv")]
    bounds: Option<PathBuf>,

    /// As for `moris simulate`, which alone steps another washout
    #[arg(long, value_name = "FMU", hide = true)]
    washout: Option<PathBuf>,

    /// Directory for the table (response.csv) and the pictures (direct.svg, cross.svg)
    #[arg(long, value_name = "DIRECTORY", default_value = "response")]
    report: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// The rig or the parameters cannot be used, an amplitude is not positive, or a
/// file cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    ensure!(options.washout.is_none(), text!["response-of-others"]);
    let setup = options.setup.load_with_notes()?;
    for (name, value) in [("--force", options.force), ("--rate", options.rate)] {
        ensure!(value.is_finite() && value > 0.0, "{name} must be a positive number, not {value}");
    }
    // Before anything is measured.
    let limits = options.bounds.as_deref().map(Limit::read).transpose().map_err(Error::msg)?.unwrap_or_default();
    let amplitudes = Amplitudes { force: options.force, ..Amplitudes::default().scaled(options.rate) };
    let measured = if options.measured.is_empty() {
        let bar = ProgressBar::new(Measured::TESTS);
        bar.set_style(ProgressStyle::with_template("frequency response {wide_bar} {pos} of {len} tests")?);
        let measured =
            Measured::of(&setup.parameters, amplitudes, options.gravity_turns, options.platform, || bar.inc(1))?;
        bar.finish_and_clear();
        let on = if options.platform { ", on the platform with its drives" } else { "" };
        let (rig, parameters) = (&setup.rig_name, &setup.parameters_name);
        writeln!(out, "Frequency response, felt over desired{on}: {rig}, parameters: {parameters}")?;
        measured
    } else {
        let measured = Measured::recorded(&options.measured).map_err(|reason| Error::msg(reason.worded(option)))?;
        writeln!(out, "Frequency response, felt over desired, of {} recordings", measured.test.len())?;
        measured
    };
    write!(out, "{}", table::text(&measured))?;
    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    let file = |name: &str| options.report.join(name);
    table::write(&file("response.csv"), &measured)?;
    picture::draw(&file("direct.svg"), &measured, &limits, &direct(), 3)?;
    picture::draw(&file("cross.svg"), &measured, &limits, &CROSS_CHANNELS, 2)?;
    for name in ["response.csv", "direct.svg", "cross.svg"] {
        writeln!(out, "wrote {}", file(name).display())?;
    }
    if limits.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    let (are_held, verdicts) = table::verdicts(&limits, &measured);
    write!(out, "{verdicts}")?;
    Ok(if are_held { ExitCode::SUCCESS } else { ExitCode::from(WORSE_RESULT) })
}
