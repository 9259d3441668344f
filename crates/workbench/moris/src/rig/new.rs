//! `moris rig new`: asks for a platform's geometry and writes a rig file that has been checked.

use std::fmt::Display;
use std::fs::OpenOptions;
use std::io::{BufRead, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use anyhow::{Context, Result, bail};
use moris_setup::rig_file;

use moris_simulation::clearance::Clearance;

/// A new rig file.
#[derive(Clone, Debug, clap::Args)]
pub struct NewOptions {
    /// File to write; it must not exist
    file: PathBuf,
}

/// Where the joints of the default rig are \[deg\].
const BASE_ANGLES: [f64; 6] = [-8.0, 8.0, 112.0, 128.0, 232.0, 248.0];
const PLATFORM_ANGLES: [f64; 6] = [-52.0, 52.0, 68.0, 172.0, 188.0, 292.0];

/// Asks, checks and writes.
///
/// # Errors
/// The file exists or cannot be written, the answers end early, or they make no rig that
/// the washout takes: why.
pub fn main(options: &NewOptions, answers: &mut dyn BufRead, out: &mut dyn Write) -> Result<ExitCode> {
    let file = &options.file;
    if file.exists() {
        bail!("{} exists; name another file", file.display());
    }
    let text = ask(answers, out)?;
    let name = file.display().to_string();
    rig_file::read(&text, &name)?
        .check()
        .with_context(|| format!("{name} is not written, because the washout rejects this rig"))?;
    let clearance = Clearance::of(&rig_file::read(&text, &name)?.rig(), None);
    if clearance.collisions().next().is_some() {
        bail!("{clearance}  {name} is not written");
    }
    let new = OpenOptions::new().write(true).create_new(true).open(file);
    new.and_then(|mut new| new.write_all(text.as_bytes())).with_context(|| format!("cannot write {name}"))?;
    writeln!(out, "\nwrote {name}; moris rig check {name} shows its reach")?;
    Ok(ExitCode::SUCCESS)
}

/// The rig file's text from the answers; an empty answer takes the value in brackets.
fn ask(answers: &mut dyn BufRead, out: &mut dyn Write) -> Result<String> {
    writeln!(out, "Lengths are in m, angles in degrees from x (forward) to y (left), legs 1 to 6 in order.\n")?;
    let mut dialog = Dialog { answers, out };
    let name: String = dialog.value("name of the rig", "my rig".to_owned(), |name: &String| {
        (!name.contains(['"', '\\'])).then_some(()).ok_or("quotes and backslashes cannot be in a name")
    })?;
    let base = dialog.positive("radius of the joints on the base", 1.0)?;
    let base_angles = dialog.angles("angles of the joints on the base", BASE_ANGLES)?;
    let platform = dialog.positive("radius of the joints on the platform", 0.85)?;
    let platform_angles = dialog.angles("angles of the joints on the platform", PLATFORM_ANGLES)?;
    let shortest = dialog.positive("shortest length of a leg, from joint to joint", 1.0)?;
    let longest = dialog.value("longest length of a leg", millimetres(shortest + 0.6), |longest: &f64| {
        (*longest > shortest).then_some(()).ok_or("it must be longer than the shortest")
    })?;
    let middle = 0.5 * (shortest + longest);
    let height = height_at(middle, (base, &base_angles), (platform, &platform_angles)).with_context(|| {
        format!("with these joints no leg is as short as {middle:.3} m, the middle of its stroke; choose longer legs")
    })?;
    let question = "height of the platform at neutral (legs in the middle of their stroke), negative where it hangs";
    let height =
        dialog.value(question, height, |height: &f64| height.is_finite().then_some(()).ok_or("it must be a number"))?;
    let velocity = dialog.positive("velocity limit of a leg, m/s", 1.0)?;
    let acceleration = dialog.positive("acceleration limit of a leg, m/s²", 15.0)?;
    let head = dialog.positive("height of the rider's head above the platform", 1.2)?;
    Ok(format!(
        "name = \"{name}\"\nneutralHeight = {height}\n\n[base]\nradius = {base}\ndegrees = {base_angles:?}\n\n[platform]\nradius = \
         {platform}\ndegrees = {platform_angles:?}\n\n[actuator]\nminLength = {shortest}\nmaxLength = {longest}\nvelocityLimit \
         = {velocity}\naccelerationLimit = {acceleration}\n\n[head]\nheight = {head}\n"
    ))
}

/// Height at which the mean length of the legs is this, to a millimetre; none if the joints are too
/// far apart.
fn height_at(length: f64, (base, base_angles): (f64, &[f64; 6]), (platform, angles): (f64, &[f64; 6])) -> Option<f64> {
    let across: Vec<f64> = (0..6)
        .map(|leg| {
            let between = (base_angles[leg] - angles[leg]).to_radians().cos();
            base * base + platform * platform - 2.0 * base * platform * between
        })
        .collect();
    let mean = |height: f64| across.iter().map(|across| (across + height * height).sqrt()).sum::<f64>() / 6.0;
    let (mut low, mut high) = (0.0, length);
    if mean(low) >= length {
        return None;
    }
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        if mean(middle) < length { low = middle } else { high = middle }
    }
    Some(millimetres(low))
}

/// Questions and answers, line by line.
struct Dialog<'a> {
    answers: &'a mut dyn BufRead,
    out: &'a mut dyn Write,
}

impl Dialog<'_> {
    fn positive(&mut self, question: &str, default: f64) -> Result<f64> {
        self.value(question, default, |value: &f64| {
            (value.is_finite() && *value > 0.0).then_some(()).ok_or("it must be above 0")
        })
    }

    fn angles(&mut self, question: &str, default: [f64; 6]) -> Result<[f64; 6]> {
        let shown = default.map(|angle| angle.to_string()).join(" ");
        let angles = |text: &String| {
            let angles: Option<Vec<f64>> =
                text.split([' ', ',']).filter(|t| !t.is_empty()).map(|t| t.parse().ok()).collect();
            angles.and_then(|angles| <[f64; 6]>::try_from(angles).ok())
        };
        let text = self.value(question, shown, |text| angles(text).map(|_| ()).ok_or("six numbers are needed"))?;
        Ok(angles(&text).unwrap_or(default))
    }

    /// Asks until the answer is a value that passes the check.
    fn value<T: FromStr + Display>(
        &mut self,
        question: &str,
        default: T,
        check: impl Fn(&T) -> Result<(), &'static str>,
    ) -> Result<T> {
        loop {
            write!(self.out, "{question} [{default}]: ")?;
            self.out.flush()?;
            let mut answer = String::new();
            if self.answers.read_line(&mut answer)? == 0 {
                bail!("the answers end at \"{question}\"; nothing is written");
            }
            let answer = answer.trim();
            if answer.is_empty() {
                return Ok(default);
            }
            match answer.parse::<T>().map_err(|_| "it must be a number").and_then(|value| check(&value).map(|()| value))
            {
                Ok(value) => return Ok(value),
                Err(reason) => writeln!(self.out, "  {answer}: {reason}")?,
            }
        }
    }
}

/// A length to the millimetre.
fn millimetres(length: f64) -> f64 {
    (1e3 * length).round() / 1e3
}
