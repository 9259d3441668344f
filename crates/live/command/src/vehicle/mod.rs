//! Vehicles that this program steps, in real time, with the controls of the page.

mod fmu;
mod motorcycle;

use std::sync::atomic::Ordering;
use std::time::Duration;

use anyhow::Result;
use moris_live::Sample;
use moris_pages::ride::{RiderCommand, RoadPlace};
use rtrb::Producer;

use super::controls::{Controls, Handling};
use super::telemetry::{Features, Received, SAMPLE_LEAD_TIME, engages, shape};
use super::{Shared, console, loop_clock};
pub use fmu::Fmu;
pub use motorcycle::Motorcycle;

/// A vehicle that stands at its beginning.
pub trait Vehicle: Send {
    /// Time of a step \[s\].
    fn step(&self) -> f64;

    /// What is known of it before it runs.
    fn features(&self) -> Features;

    /// The place on the road.
    fn place(&self) -> Option<RoadPlace> {
        None
    }

    /// Makes a step with what is held.
    ///
    /// # Errors
    /// The vehicle has ended.
    fn advance(&mut self, command: &RiderCommand) -> Result<()>;

    /// The motion now, without a time.
    ///
    /// # Errors
    /// The vehicle has ended.
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
    let begin = loop_clock::now();
    let mut drives = false;
    for sent in 0.. {
        let time = step * sent;
        loop_clock::wait_until(begin + time);
        if shared.done.load(Ordering::Relaxed) {
            return;
        }
        drives |= engages(shared);
        if controls.is_some_and(Controls::begins_again) {
            vehicle.begin_again();
        }
        let command = controls.map(|controls| controls.at(loop_clock::now())).unwrap_or_default();
        let advanced = if drives { vehicle.advance(&command) } else { Ok(()) };
        let sample = advanced.and_then(|()| vehicle.sample());
        let Ok(sample) = sample.inspect_err(|error| console::line(&format!("the vehicle has ended: {error:#}"))) else {
            shared.played.store(true, Ordering::Relaxed);
            return;
        };
        controls.inspect(|controls| controls.show(vehicle.place()));
        let sample = Sample { time: Some(time.as_secs_f64()), ..sample };
        let _ = samples.push(Received { arrival: begin + time + step + SAMPLE_LEAD_TIME, sample });
    }
}
