//! The motorcycle that is ridden with the page's controls.

use anyhow::Result;
use moris_interface::Model;
use moris_live::{Motion, Sample};
use moris_pages::report::Vehicle as Shape;
use moris_pages::ride::{Ridden, RiderCommand, RoadPlace, STEP};

use super::{Features, Handling, Vehicle};

/// Steps of the motorcycle to a sample.
const STEPS_PER_SAMPLE: u32 = 5;

/// The motorcycle of `moris ride`.
pub struct Motorcycle {
    ridden: Ridden,
    /// True once the motorcycle has been put back, until a sample has said so.
    is_put_back: bool,
}

impl Motorcycle {
    /// At rest at the beginning of the lap.
    ///
    /// # Errors
    /// Never, because the default parameters can be used.
    pub fn new() -> Result<Self> {
        Ok(Motorcycle { ridden: Ridden::new()?, is_put_back: false })
    }
}

impl Vehicle for Motorcycle {
    fn step(&self) -> f64 {
        STEP * f64::from(STEPS_PER_SAMPLE)
    }

    fn features(&self) -> Features {
        Features {
            is_inside: true,
            has_position: true,
            handling: Some(Handling::Rider),
            shape: Some(Shape::Motorcycle),
            road: Some(self.ridden.road()),
        }
    }

    fn place(&self) -> Option<RoadPlace> {
        Some(self.ridden.road_place())
    }

    fn advance(&mut self, command: &RiderCommand) -> Result<()> {
        (0..STEPS_PER_SAMPLE).for_each(|_| self.ridden.step(command));
        Ok(())
    }

    /// A fall, the end of the road and a new ride are pauses: the cue goes to rest, and comes in
    /// again.
    fn sample(&mut self) -> Result<Sample> {
        let now = self.ridden.input(true);
        let is_put_back = std::mem::take(&mut self.is_put_back);
        Ok(Sample {
            time: None,
            motion: Motion::new(now.specific_force, now.angular_velocity, now.orientation, now.speed),
            position: Some(self.ridden.motorcycle().output().position),
            paused: self.ridden.has_ended() || is_put_back,
            has_angles: true,
        })
    }

    fn begin_again(&mut self) {
        if let Ok(ridden) = self.ridden.restarted() {
            *self = Motorcycle { ridden, is_put_back: true };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The samples of a ride from a stand with these controls.
    fn ride(motorcycle: &mut Motorcycle, command: &RiderCommand, seconds: f64) -> Vec<Sample> {
        let count = (seconds / motorcycle.step()) as u32;
        let sample = |_| {
            motorcycle.advance(command).unwrap();
            motorcycle.sample().unwrap()
        };
        (0..count).map(sample).collect()
    }

    #[test]
    fn the_end_of_the_road_is_a_pause_until_a_new_ride() {
        let mut motorcycle = Motorcycle::new().unwrap();
        let full = RiderCommand { throttle: 1.0, is_helped: false, ..RiderCommand::default() };
        let samples = ride(&mut motorcycle, &full, 60.0);
        let ridden = samples.iter().position(|sample| sample.paused).expect("the road has bends");
        assert!(samples[ridden..].iter().all(|sample| sample.paused));
        // The speed is the integral of the felt surge, but for what the pitch adds.
        let surge: f64 = samples[..200].iter().map(|sample| sample.motion.0[0] * motorcycle.step()).sum();
        assert!((surge - samples[199].motion.speed()).abs() < 0.1 * surge && surge > 2.0, "{surge} m/s");
        motorcycle.begin_again();
        let stands = [motorcycle.sample().unwrap(), motorcycle.sample().unwrap()];
        assert_eq!(stands.map(|sample| sample.paused), [true, false]);
        assert_eq!(stands[1].motion.speed(), 0.0);
    }
}
