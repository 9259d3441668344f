//! Recorded rides: read from CSV, converted to the washout's frames and units, and looked at with suspicion.
//!
//! [`Ride::read`] does it all. What the columns are called, and in which units and axes they are, is said by
//! [`conventions`]; [`table`] reads the numbers, [`sampling`] makes sure that they come at equal steps, [`suspicion`]
//! recognises units and axes that are not what they are said to be.
//!
//! # Gravity without orientation
//!
//! What the washout cues is the difference between what the vehicle's rider feels and what a rider at rest on a level platform
//! feels, (0, 0, g). Where a recording has no orientation, it is taken as zero, and gravity removal then takes
//! away exactly that: g from z, nothing from x and y, be it `head_vertical` or `full`. That is not a makeshift. The specific force
//! at the head of a two-wheeler's rider already holds the lean: in a balanced turn it points along the rider's spine, and
//! there is no lateral force to cue, however far he leans; on a slope it holds the part of gravity that he feels pushing
//! him back, and that is cued as it should be. What remains of a lean is that z reads more than g, as he feels it, too.
//!
//! Where there are columns of orientation, they are used: gravity is removed as the parameter `gravityRemoval` says.

pub mod conventions;
mod convert;
mod error;
pub mod sampling;
pub mod suspicion;
pub mod table;

use std::path::Path;

use moris_batch::Manoeuvre;
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::{Input, Parameters};

pub use conventions::{ConventionOptions, Conventions};
pub use error::RideError;

/// A recorded ride.
#[derive(Clone, Debug)]
pub struct Ride {
    /// The file's name without directory and extension.
    pub name: String,
    /// Inputs of the washout, at equal steps.
    pub manoeuvre: Manoeuvre,
    /// Time of the first sample in the recording \[s\]; the manoeuvre's is 0.
    pub start: f64,
    /// The axes of the inputs' angular velocities.
    pub angular_velocity_frame: AngularVelocityFrame,
    /// True if the recording has the vehicle's orientation.
    pub has_orientation: bool,
    /// Warnings, in whole sentences.
    pub remarks: Vec<String>,
}

impl Ride {
    /// Reads a ride.
    ///
    /// # Errors
    /// The file cannot be read, a column is missing, a number is none, time does not go on in equal steps, or the
    /// numbers are not in the units or axes that they are said to be in.
    pub fn read(file: &Path, conventions: &Conventions) -> Result<Self, RideError> {
        let table = table::read(file, conventions)?;
        let (table, mut remarks) = sampling::at_equal_steps(table, conventions)?;
        let mut inputs = convert::inputs(&table, conventions);
        suspicion::look_at(file, &inputs, conventions)?;
        convert::fade_in(&mut inputs, table.step(), conventions.fade_in);
        remarks.extend(suspicion::remarks(&inputs));
        Ok(Ride {
            name: Ride::name_of(file),
            start: table.time[0],
            manoeuvre: Manoeuvre::new(table.step(), inputs),
            angular_velocity_frame: conventions.rate_frame.into(),
            has_orientation: table.has_orientation(),
            remarks,
        })
    }

    /// Name of the recording in a file: the file's, without directory and extension.
    pub fn name_of(file: &Path) -> String {
        file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
    }

    /// The parameters with which to ride it: those given, with the axes of the angular velocity that are the recording's.
    pub fn parameters(&self, parameters: &Parameters) -> Parameters {
        let mut parameters = *parameters;
        parameters.conditioning.angular_velocity_frame = self.angular_velocity_frame;
        parameters
    }

    /// The ride's samples.
    pub fn inputs(&self) -> &[Input] {
        self.manoeuvre.inputs()
    }

    /// Time between samples \[s\].
    pub fn step(&self) -> f64 {
        self.manoeuvre.step()
    }

    /// The time of each sample, the first at 0 \[s\].
    pub fn times(&self) -> impl Iterator<Item = f64> {
        (0..self.inputs().len()).map(|k| k as f64 * self.step())
    }
}
