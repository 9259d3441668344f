//! Recordings: read from CSV, converted to the washout's frames and units, and
//! checked for plausibility.
//!
//! [`Recording::read`] reads a recording in these steps, each a folder:
//!
//! - `read` reads a file's text and its lines, as numbers.
//! - `columns` finds the columns of the quantities in the header, and their units.
//! - [`table`] collects the numbers in SI units, joins those of several files, chooses one of
//!   several laps, and makes the time steps equal.
//! - `axes` rotates the vectors by the sensor's mounting, to the washout's inputs.
//! - `rules` finds wrong units and axes, and channels that contradict each other: a row each.
//!
//! [`felt`] reads the motion that another washout computed for a recording.
//!
//! [`conventions`] are the names, units and axes given by options, or by one of the
//! [`formats`]. Errors and warnings name these options as remedies of a [`Message`], and `signal`
//! has the statistics of all steps.
//!
//! # Gravity without orientation
//!
//! The washout cues the difference between the specific force on the vehicle's rider and that on a
//! rider at rest on a level platform, (0, 0, g). A recording without orientation is taken as
//! level. Gravity removal then subtracts g from z and nothing from x and y, with `head_vertical`
//! and with `full`. The specific force at the head of a two-wheeler's rider already includes the
//! lean. In a balanced turn it points along the rider's spine, so there is no lateral force to
//! cue. Its z is then above g, as the rider feels. On a slope it includes the part of gravity
//! along x, and that part is cued.
//!
//! Orientation columns are used if the recording has them. Gravity is then removed as the parameter
//! `gravityRemoval` specifies.

mod axes;
mod columns;
pub mod conventions;
mod dialects;
pub mod felt;
mod message;
mod read;
mod road;
mod rules;
mod signal;
pub mod table;

use std::path::Path;

use moris_laps::Laps;
pub use moris_simulation::preview;
use moris_simulation::preview::Previewer;
use moris_simulation::{Manoeuvre, Replay};
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::{Input, Parameters};

use crate::message::Message;
pub(crate) use columns::{Quantity, units};
use conventions::Frame;
pub use conventions::{ConventionOptions, Conventions, FADE_IN, formats};
pub use message::RecordingError;
pub use read::source;
pub use read::source::files_in;
pub use road::Road;
use rules::Channels;
use table::{Table, interleaved, laps, outliers, sampling};

/// A recording as inputs of the washout at a fixed rate.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The file's name without directory and extension.
    pub name: String,
    /// The washout's inputs, at equal steps.
    pub manoeuvre: Manoeuvre,
    /// Time of the first sample in the recording \[s\]; the manoeuvre's is 0.
    pub start: f64,
    /// The axes of the inputs' angular velocities.
    pub angular_velocity_frame: AngularVelocityFrame,
    /// True where the recording holds the vehicle's orientation.
    pub has_orientation: bool,
    /// Position and speed along the road, if the conventions ask for them.
    pub road: Option<Road>,
    /// Warnings, in whole sentences.
    pub warnings: Vec<Message>,
}

impl Recording {
    /// Reads a recording from a file, or from standard input if the file is `-`. Files compressed
    /// with gzip are unpacked. Several files whose names are separated by `+`, or the CSV files of
    /// a directory, are joined by time.
    ///
    /// # Errors
    /// - The file cannot be read or is not CSV.
    /// - A column is missing or occurs twice, or a field is not a number.
    /// - The time steps are unequal.
    /// - There are a logger's error values, and they are not to be repaired.
    /// - A unit in the header contradicts an option.
    /// - The units or axes are implausible.
    pub fn read(file: &Path, conventions: &Conventions) -> Result<Self, RecordingError> {
        Self::of_table(source::name(file), table::read(file, conventions)?, conventions)
    }

    /// A recording of columns in memory, each a name and its values, read as the columns of a file.
    ///
    /// # Errors
    /// As [`Recording::read`], or columns differ in length.
    pub fn of_columns(
        name: &str,
        columns: &[(String, Vec<f64>)],
        conventions: &Conventions,
    ) -> Result<Self, RecordingError> {
        Self::of_table(name.to_owned(), table::of_columns(name, columns, conventions)?, conventions)
    }

    /// A computed drive, without orientation and position.
    pub fn computed(name: &str, manoeuvre: Manoeuvre, angular_velocity_frame: AngularVelocityFrame) -> Self {
        Recording {
            name: name.to_owned(),
            manoeuvre,
            start: 0.0,
            angular_velocity_frame,
            has_orientation: false,
            road: None,
            warnings: Vec::new(),
        }
    }

    fn of_table(name: String, mut table: Table, conventions: &Conventions) -> Result<Self, RecordingError> {
        if let Some(reason) = interleaved::refusal(&table) {
            return Err(table.refused(reason));
        }
        laps::choose(&mut table, conventions)?;
        let outliers = outliers::check(&mut table, conventions.repair)?;
        let (table, mut warnings) = sampling::at_equal_steps(table, conventions)?;
        warnings.extend(outliers);
        warnings.extend(table.warnings.iter().cloned());
        let (mut inputs, mounting) = axes::inputs(&table, conventions)?;
        warnings.extend(mounting);
        let (checked, part) = table.complete();
        if rules::has_horizontal_gravity(&Channels::new([&table, &checked], &inputs[part.clone()], conventions, 0)) {
            axes::keep_horizontal_gravity(&mut inputs);
            warnings.push(rules::horizontal_gravity());
        }
        let channels = Channels::new([&table, &checked], &inputs[part.clone()], conventions, part.start);
        warnings.extend(rules::warnings(&channels)?);
        axes::fade_in(&mut inputs, table.step(), conventions.fade_in);
        warnings.extend(rules::warnings_of_motion(&Channels::new([&table; 2], &inputs, conventions, 0))?);
        Ok(Recording {
            name,
            start: table.time[0],
            manoeuvre: Manoeuvre::new(table.step(), inputs),
            angular_velocity_frame: match conventions.rate_frame {
                Frame::Body => AngularVelocityFrame::Body,
                Frame::World => AngularVelocityFrame::World,
            },
            has_orientation: table.has_orientation(),
            road: Road::of(&table),
            warnings,
        })
    }

    /// The parameters for its simulation: the given ones, with the frame of the
    /// recording's angular velocity.
    pub fn parameters(&self, parameters: &Parameters) -> Parameters {
        let mut parameters = *parameters;
        parameters.conditioning.angular_velocity_frame = self.angular_velocity_frame;
        parameters
    }

    /// The preview that is learned by its position, with these laps known, which learn it too.
    ///
    /// # Errors
    /// The recording has no position, or one that never changes.
    pub fn learned(&self, laps: &mut Laps) -> Result<Previewer, RecordingError> {
        let refused = |reason| RecordingError::whole(Path::new(&self.name), reason);
        let road = self.road.as_ref().ok_or_else(|| {
            refused("has no position to learn by; read it with its columns x and y, or latitude and longitude")
        })?;
        if !road.leads_anywhere() {
            return Err(refused("the position never changes: there is no road to learn"));
        }
        Ok(Previewer::given(road.learned(self.inputs(), self.step(), laps), self.step()))
    }

    /// Inputs of the washout, sample by sample.
    pub fn inputs(&self) -> &[Input] {
        self.manoeuvre.inputs()
    }

    /// Time between samples \[s\].
    pub fn step(&self) -> f64 {
        self.manoeuvre.step()
    }

    /// Replay of the recording with one communication step per sample.
    pub fn replay(&self) -> Replay<'_> {
        Replay::new(&self.manoeuvre)
    }

    /// The time of each sample, the first at 0 \[s\].
    pub fn times(&self) -> impl Iterator<Item = f64> {
        (0..self.inputs().len()).map(|k| k as f64 * self.step())
    }
}
