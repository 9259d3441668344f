//! Time that parking takes: a copy of the session parks ahead of it.

use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use moris_live::{STEP, Session, State};
use rtrb::Consumer;

use super::Shared;

/// Says how long parking takes, for each copy of the session that begins to park.
pub fn forecast(mut parking: Consumer<Session>, shared: &Shared) {
    // Time between looks for a session that parks.
    const PARKING_POLL_INTERVAL: Duration = Duration::from_millis(20);
    while !parking.is_abandoned() {
        if let Ok(session) = parking.pop()
            && let Some(time) = time_of(session, shared)
        {
            // After the journal's line of the state.
            thread::sleep(2 * PARKING_POLL_INTERVAL);
            shared.say(&format!("parking takes {time:.0} s"));
        }
        thread::sleep(PARKING_POLL_INTERVAL);
    }
}

/// The time until it is settled \[s\]; none if that is far away, or if the session has ended.
fn time_of(mut session: Session, shared: &Shared) -> Option<f64> {
    // Longest time that is looked ahead [s].
    const MAX_PARKING_TIME: f64 = 120.0;
    let begin = session.time();
    while session.state() == State::Parking {
        session.step();
        if session.time() - begin > MAX_PARKING_TIME || shared.done.load(Ordering::Relaxed) {
            return None;
        }
    }
    Some((session.time() - begin).max(STEP))
}

#[cfg(test)]
mod tests {
    use moris_live::{Event, Settings};
    use moris_washout::Parameters;

    use super::*;

    #[test]
    fn the_forecast_is_the_time_that_parking_takes() {
        let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
        session.handle(Event::Start).unwrap();
        for _ in 0..2_500 {
            session.step();
        }
        session.handle(Event::Park).unwrap();
        let forecast = time_of(session.clone(), &Shared::default()).unwrap();
        let begin = session.time();
        while session.state() == State::Parking {
            session.step();
        }
        assert!((forecast - (session.time() - begin)).abs() < 1e-9 && forecast > 1.0);
    }
}
