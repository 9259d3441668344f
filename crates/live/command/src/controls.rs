//! The controls of a vehicle: what the page holds, until it falls silent.

use std::ops::RangeInclusive;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use moris_pages::ride::{RiderCommand, RoadPlace};
use serde::Serialize;

/// Kind of a vehicle's controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Handling {
    /// The controls of a rider who can be helped, and who begins again after a fall.
    Rider,
    /// Some of throttle, brake and stick.
    Inputs,
}

/// The controls, as the page holds them.
#[derive(Debug)]
pub struct Controls {
    pub handling: Handling,
    held: Mutex<Held>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Held {
    command: RiderCommand,
    /// Time of [`super::loop_clock::now`] until which it counts.
    until: Duration,
    begins_again: bool,
    /// Place of the vehicle, if it is on a road.
    place: Option<RoadPlace>,
}

impl Controls {
    /// Controls that nobody holds.
    pub fn new(handling: Handling) -> Self {
        Controls { handling, held: Mutex::default() }
    }

    fn lock(&self) -> MutexGuard<'_, Held> {
        // Nothing is left half done that matters.
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Holds them from now on.
    ///
    /// # Errors
    /// A value is out of range.
    pub fn hold(&self, command: &RiderCommand, now: Duration) -> Result<(), String> {
        // Time without word from the page after which the controls are released.
        const CONTROLS_TIMEOUT: Duration = Duration::from_millis(500);
        let check = |name: &str, value: f64, range: RangeInclusive<f64>| match range.contains(&value) {
            true => Ok(()),
            false => Err(format!("{name} must be from {} to {}", range.start(), range.end())),
        };
        check("throttle", command.throttle, 0.0..=1.0)?;
        check("brake", command.brake, 0.0..=1.0)?;
        check("stick", command.stick, -1.0..=1.0)?;
        let mut held = self.lock();
        (held.command, held.until) = (*command, now + CONTROLS_TIMEOUT);
        Ok(())
    }

    /// Shows where the vehicle is.
    pub fn show(&self, place: Option<RoadPlace>) {
        self.lock().place = place;
    }

    /// Place of the vehicle, if it is on a road.
    pub fn place(&self) -> Option<RoadPlace> {
        self.lock().place
    }

    /// Releases them. A rider who is helped stays so.
    pub fn release(&self) {
        self.lock().until = Duration::ZERO;
    }

    /// The command in force at this time: the one that is held, or none.
    pub fn at(&self, now: Duration) -> RiderCommand {
        let Held { command, until, .. } = *self.lock();
        if now < until { command } else { RiderCommand { is_helped: command.is_helped, ..RiderCommand::default() } }
    }

    /// Asks for a new ride.
    ///
    /// # Errors
    /// The vehicle has none.
    pub fn begin_again(&self) -> Result<(), String> {
        if self.handling == Handling::Inputs {
            return Err("this vehicle cannot begin again".to_owned());
        }
        self.lock().begins_again = true;
        Ok(())
    }

    /// True once after a new ride was asked for.
    pub fn begins_again(&self) -> bool {
        std::mem::take(&mut self.lock().begins_again)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HELD: RiderCommand = RiderCommand { throttle: 0.7, brake: 0.1, stick: -0.4, is_helped: true };

    #[test]
    fn what_is_held_is_released_after_half_a_second_of_silence() {
        let controls = Controls::new(Handling::Rider);
        let at = Duration::from_millis;
        let released = RiderCommand { is_helped: true, ..RiderCommand::default() };
        assert_eq!(controls.at(at(0)), RiderCommand::default());
        controls.hold(&HELD, at(1000)).unwrap();
        assert_eq!(controls.at(at(1499)), HELD);
        assert_eq!(controls.at(at(1500)), released);
        controls.hold(&HELD, at(1600)).unwrap();
        assert_eq!(controls.at(at(1601)), HELD);
        controls.release();
        assert_eq!(controls.at(at(1602)), released);
    }

    #[test]
    fn values_out_of_range_change_nothing() {
        let controls = Controls::new(Handling::Inputs);
        let at = Duration::from_millis(1000);
        controls.hold(&HELD, at).unwrap();
        for wrong in [
            RiderCommand { throttle: 1.1, ..HELD },
            RiderCommand { brake: -0.1, ..HELD },
            RiderCommand { stick: f64::NAN, ..HELD },
            RiderCommand { throttle: f64::INFINITY, ..HELD },
        ] {
            assert!(controls.hold(&wrong, at).is_err(), "{wrong:?}");
        }
        assert_eq!(controls.at(at), HELD);
        assert!(controls.begin_again().is_err() && !controls.begins_again());
    }
}
