//! Vehicles that this program steps, in real time, with the controls of the page.

mod fmu;
mod motorcycle;

use std::sync::atomic::Ordering;
use std::time::Duration;

use anyhow::Result;
use moris_live::Sample;
use moris_pages::report::Vehicle as Shape;
use moris_pages::ride::{RiderCommand, RoadMap, RoadPlace};
use rtrb::Producer;

use super::controls::{Controls, Handling};
use super::telemetry::{BEFORE, Received, engages};
use super::{Shared, console, pace};
pub use fmu::Fmu;
pub use motorcycle::Motorcycle;

/// A vehicle that stands at its beginning.
pub trait Vehicle: Send {
    /// Time of a step \[s\].
    fn step(&self) -> f64;

    /// Kind of the vehicle's controls; none if it drives by itself.
    fn handling(&self) -> Option<Handling>;

    /// True if its samples have its place.
    fn has_position(&self) -> bool;

    /// Shape in which it is drawn; none for one that the parameters name.
    fn shape(&self) -> Option<Shape> {
        None
    }

    /// The road on which it is ridden.
    fn road(&self) -> Option<RoadMap> {
        None
    }

    /// Its place on the road.
    fn place(&self) -> Option<RoadPlace> {
        None
    }

    /// Makes a step with what is held.
    ///
    /// # Errors
    /// It has ended.
    fn advance(&mut self, command: &RiderCommand) -> Result<()>;

    /// The motion now, without a time.
    ///
    /// # Errors
    /// It has ended.
    fn sample(&mut self) -> Result<Sample>;

    /// Stands at its beginning again, if it can.
    fn begin_again(&mut self) {}
}

/// Steps a vehicle in real time once the platform engages; until then it stands at its beginning.
pub fn drive(
    mut vehicle: Box<dyn Vehicle>,
    controls: Option<&Controls>,
    mut samples: Producer<Received>,
    shared: &Shared,
) {
    let step = Duration::from_secs_f64(vehicle.step());
    let begin = pace::now();
    let mut drives = false;
    for sent in 0.. {
        let time = step * sent;
        pace::wait_until(begin + time);
        if shared.done.load(Ordering::Relaxed) {
            return;
        }
        drives |= engages(shared);
        if controls.is_some_and(Controls::begins_again) {
            vehicle.begin_again();
        }
        let command = controls.map(|controls| controls.at(pace::now())).unwrap_or_default();
        let advanced = if drives { vehicle.advance(&command) } else { Ok(()) };
        let sample = advanced.and_then(|()| vehicle.sample());
        let Ok(sample) = sample.inspect_err(|error| console::line(&format!("the vehicle has ended: {error:#}"))) else {
            shared.played.store(true, Ordering::Relaxed);
            return;
        };
        controls.inspect(|controls| controls.show(vehicle.place()));
        let sample = Sample { time: Some(time.as_secs_f64()), ..sample };
        let _ = samples.push(Received { arrival: begin + time + step + BEFORE, sample });
    }
}
