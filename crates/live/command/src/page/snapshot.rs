//! Values that the loop passes to the page, and the messages made of them.

use std::collections::VecDeque;

use moris_live::frame::Values;
use moris_live::road::Road;
use moris_live::source::Health;
use moris_live::{Session, State};
use moris_pages::ride::lamps;
use serde::Serialize;

use crate::lateness::{Classes, Lateness};

/// Steps between what is shown.
pub const SNAPSHOT_INTERVAL_STEPS: u64 = 10;

/// Names of the numbers in a row, in order.
pub const ROW_NAMES: &str = "time desired_x desired_y desired_z wx wy wz roll pitch yaw speed felt_x felt_y felt_z \
    platform_x platform_y platform_z platform_roll platform_pitch platform_yaw leg1 leg2 leg3 leg4 leg5 leg6 \
    tilt soft safety stroke leg_speed leg_acceleration scale";
const ROW_LENGTH: usize = 33;

/// A moment of the session.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    numbers: [f64; ROW_LENGTH],
    pub state: State,
    health: Health,
    delay: f64,
    late: Classes,
    /// The controller does not follow any more.
    is_lost: bool,
    /// The legs are where they are commanded to be.
    is_located: bool,
    road: Option<Driven>,
}

/// The vehicle on a road that is learned.
#[derive(Clone, Copy, Debug, Serialize)]
struct Driven {
    /// The vehicle's place along x and y, if it is known \[m\].
    place: Option<[f64; 2]>,
    /// Trust in the preview, from 0 to 1.
    trust: f64,
    /// Earlier passes of the place that are followed.
    passes: usize,
}

impl Driven {
    fn on(road: &Road) -> Self {
        Driven { place: road.place(), trust: road.laps().trust(), passes: road.laps().passes() }
    }
}

impl Snapshot {
    /// The session now.
    pub fn of(session: &Session, lateness: &Lateness, is_lost: bool) -> Self {
        let Values { time, length, pose, force, .. } = Values::from(session.commands());
        let lamps = lamps::lit(session.washout()).map(f64::from);
        let scale = session.washout().output().scale_factor;
        let mut parts = [time].into_iter().chain(session.passed().0.iter().copied());
        let mut rest = force.into_iter().chain(pose).chain(length).chain(lamps).chain([scale]);
        Snapshot {
            numbers: std::array::from_fn(|_| parts.next().or_else(|| rest.next()).unwrap_or_default()),
            state: session.state(),
            health: session.source().health(),
            delay: session.delay(),
            late: lateness.classes(),
            is_lost,
            is_located: session.is_located(),
            road: session.road().map(Driven::on),
        }
    }
}

/// The message of some moments, as JSON in one line. `told` has further members of the object.
pub fn message(moments: &[Snapshot], lines: &VecDeque<String>, told: &str) -> Option<String> {
    let last = moments.last()?;
    // A number that is none is not JSON's.
    let number = |number: &f64| if number.is_finite() { format!("{number:.5}") } else { "0".to_owned() };
    let row = |moment: &Snapshot| format!("[{}]", moment.numbers.each_ref().map(number).join(","));
    let rows = moments.iter().map(row).collect::<Vec<_>>().join(",");
    let lines = serde_json::to_string(lines).unwrap_or_default();
    let (state, health, delay) = (last.state.name(), last.health.name(), last.delay);
    let (is_lost, is_located) = (last.is_lost, last.is_located);
    let late = serde_json::to_string(&last.late).unwrap_or_default();
    let road = serde_json::to_string(&last.road).unwrap_or_default();
    Some(format!(
        "{{\"rows\":[{rows}],\"state\":\"{state}\",\"health\":\"{health}\",\"delay\":{delay},\"late\":{late},\"is_lost\":{is_lost},\
         \"is_located\":{is_located},\"road\":{road},\"lines\":{lines},{told}}}"
    ))
}

#[cfg(test)]
mod tests {
    use moris_live::Settings;
    use moris_washout::Parameters;

    use super::*;

    #[test]
    fn a_message_is_json_with_a_number_for_each_name() {
        let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
        session.step();
        let moment = Snapshot::of(&session, &Lateness::default(), true);
        let lines = VecDeque::from(["said \"so\"\n".to_owned()]);
        let text = message(&[moment, moment], &lines, "\"changed\":{\"tilt.angleLimit\":0.3}").unwrap();
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        let row: Vec<f64> = serde_json::from_value(value["rows"][1].clone()).unwrap();
        let of = |name: &str| row[ROW_NAMES.split(' ').position(|known| known == name).unwrap()];
        assert_eq!((row.len(), ROW_NAMES.split(' ').count()), (ROW_LENGTH, ROW_LENGTH));
        let commands = session.commands();
        assert_eq!((of("time"), of("desired_z")), (0.001, 9.80665));
        for (name, expected) in [
            ("felt_z", commands.washout.felt_specific_force.z),
            ("platform_z", commands.pose.position.z),
            ("leg6", commands.length[5]),
            ("leg_acceleration", 0.0),
            ("scale", 1.0),
        ] {
            assert!((of(name) - expected).abs() <= 5e-6, "{name}");
        }
        assert_eq!(value["lines"][0], "said \"so\"\n");
        assert_eq!((&value["is_lost"], &value["is_located"]), (&true.into(), &true.into()));
        assert_eq!((&value["state"], &value["health"]), (&"off".into(), &"waiting".into()));
        assert!(!text.contains('\n'));
        assert!(message(&[], &lines, "\"changed\":{}").is_none());
    }
}
