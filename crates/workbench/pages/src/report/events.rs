//! When and why something was limited, read off the flags and the motion around them.

use serde::Serialize;

use crate::report::data::{Cranks, LimitHistory, Rig, Run};
use moris_simulation::TiltLimit;

/// A stretch of time in which something was limited.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Event {
    pub kind: Kind,
    /// Begin \[s\].
    pub from: f64,
    /// End \[s\].
    pub to: f64,
    /// Which limit, on which axis or leg, as well as the motion shows it.
    pub why: String,
}

/// The limit that acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    Tilt,
    Soft,
    Safety,
    Actuator,
}

/// A quantity's largest fraction of its limit, and the limit in words.
#[derive(Clone)]
struct Utilisation {
    fraction: f64,
    /// The axis or leg.
    who: String,
    /// Which limit it is at.
    limit: String,
}

impl Utilisation {
    /// A limit of 0 is one that is not known: nothing has a fraction of it.
    fn new(who: impl Into<String>, value: f64, limit: f64, text: String) -> Self {
        Utilisation { fraction: if limit > 0.0 { value / limit } else { f64::NAN }, who: who.into(), limit: text }
    }

    /// Used fraction of the limit.
    fn share(&self) -> String {
        format!("{} at {:.0} % of the {}", self.who, 100.0 * self.fraction, self.limit)
    }
}

/// Everything that was limited in a run, in the order of time.
pub fn events(run: &Run, rig: &Rig) -> Vec<Event> {
    let LimitHistory { soft, safety, actuator, .. } = &run.limited;
    let flags = [(Kind::Soft, soft), (Kind::Safety, safety), (Kind::Actuator, actuator)];
    let mut events: Vec<Event> = flags
        .iter()
        .flat_map(|(kind, flags)| raised_stretches(&run.times, flags).map(|at| limit_event(*kind, run, rig, at)))
        .chain(tilt_events(run))
        .collect();
    events.sort_by(|a, b| a.from.total_cmp(&b.from));
    events
}

/// The stretches in which a limit of tilt coordination acted, limit by limit.
fn tilt_events(run: &Run) -> Vec<Event> {
    let of_axis = |(axis, by_limit): (&str, &[Vec<bool>; 3])| -> Vec<Event> {
        let of_limit = |(limit, flags): (TiltLimit, &Vec<bool>)| -> Vec<Event> {
            let why = format!("{axis} at the {}", limit.text(&run.limits));
            let event = |(first, last): (usize, usize)| Event {
                kind: Kind::Tilt,
                from: run.times[first],
                to: run.times[last],
                why: why.clone(),
            };
            raised_stretches(&run.times, flags).map(event).collect()
        };
        TiltLimit::ALL.into_iter().zip(by_limit).flat_map(of_limit).collect()
    };
    ["roll", "pitch"].into_iter().zip(&run.limited.tilt_by).flat_map(of_axis).collect()
}

/// First and last index of each stretch of raised flags. A flag speaks of the step before it.
fn raised_stretches(times: &[f64], flags: &[bool]) -> impl Iterator<Item = (usize, usize)> {
    // Stretches closer to each other than this are one [s].
    const MERGE_GAP: f64 = 0.1;
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    for (index, _) in flags.iter().enumerate().filter(|(_, raised)| **raised) {
        let start = index.saturating_sub(1);
        match stretches.last_mut() {
            Some(last) if times[start] - times[last.1] <= MERGE_GAP => last.1 = index,
            _ => stretches.push((start, index)),
        }
    }
    stretches.into_iter()
}

fn limit_event(kind: Kind, run: &Run, rig: &Rig, (first, last): (usize, usize)) -> Event {
    let at = Stretch { times: &run.times[first..=last], first, last };
    let why = match kind {
        Kind::Actuator => limit_reason(of_actuators(run, rig, &at)),
        Kind::Soft => soft_reason(run, rig, &at),
        _ => limit_reason(of_safety(run, rig, &at)),
    };
    Event { kind, from: run.times[first], to: run.times[last], why }
}

/// Part of a run.
struct Stretch<'a> {
    times: &'a [f64],
    first: usize,
    last: usize,
}

impl Stretch<'_> {
    fn of<'a>(&self, series: &'a [f64]) -> &'a [f64] {
        &series[self.first..=self.last]
    }

    /// The largest rate of change between samples.
    fn peak_rate(&self, series: &[f64]) -> f64 {
        self.rates(series).into_iter().fold(0.0, |peak, rate| f64::max(peak, rate.abs()))
    }

    /// The largest rate of change of the rate of change.
    fn peak_second_rate(&self, series: &[f64]) -> f64 {
        let rates = self.rates(series);
        let changes = rates.windows(2).zip(self.times.windows(3));
        changes.fold(0.0, |peak, (rate, t)| f64::max(peak, ((rate[1] - rate[0]) / (0.5 * (t[2] - t[0]))).abs()))
    }

    fn rates(&self, series: &[f64]) -> Vec<f64> {
        let values = self.of(series).windows(2);
        values.zip(self.times.windows(2)).map(|(x, t)| (x[1] - x[0]) / (t[1] - t[0])).collect()
    }
}

/// The limit that came closest, which the soft limits act ahead of.
fn soft_reason(run: &Run, rig: &Rig, at: &Stretch) -> String {
    let utilisations = of_safety(run, rig, at).into_iter().chain(of_actuators(run, rig, at)).flatten();
    closest_to_limit(utilisations)
        .map_or_else(|| UNKNOWN_LIMIT.into(), |one| format!("ahead of a limit; {}", one.share()))
}

/// Of the limits of the safety units: of position, velocity and acceleration.
fn of_safety(run: &Run, rig: &Rig, at: &Stretch) -> [Vec<Utilisation>; 3] {
    let limits = &run.limits;
    let axes = [(0, "surge", 0.0), (1, "sway", 0.0), (2, "heave", rig.neutral_height)];
    let positions = axes.map(|(i, axis, neutral)| {
        let limit = limits.safety_position[i];
        let farthest = at.of(&run.position[i]).iter().fold(0.0, |peak, x| f64::max(peak, (x - neutral).abs()));
        Utilisation::new(axis, farthest, limit, format!("travel limit of {limit:.2} m"))
    });
    let velocities = axes.map(|(i, axis, _)| {
        let limit = limits.safety_velocity[i];
        Utilisation::new(axis, at.peak_rate(&run.position[i]), limit, format!("velocity limit of {limit:.2} m/s"))
    });
    let accelerations = axes.map(|(i, axis, _)| {
        let limit = limits.safety_acceleration[i];
        let text = format!("acceleration limit of {limit:.1} m/s²");
        Utilisation::new(axis, at.peak_second_rate(&run.position[i]), limit, text)
    });
    [positions.into(), velocities.into(), accelerations.into()]
}

/// Of the limits of the legs: of length, speed and acceleration.
fn of_actuators(run: &Run, rig: &Rig, at: &Stretch) -> [Vec<Utilisation>; 3] {
    let limits = &run.limits;
    let [shortest, longest] = rig.stroke;
    let (middle, half) = (0.5 * (shortest + longest), 0.5 * (longest - shortest));
    let farthest = |leg: &[f64], side: f64| at.of(leg).iter().fold(0.0, |far, x| f64::max(far, side * (x - middle)));
    let name = if rig.cranks.is_some() { "crank" } else { "leg" };
    let of_legs = |value: &dyn Fn(&[f64]) -> f64, limit: f64, text: &str| -> Vec<Utilisation> {
        let of_leg =
            |(leg, i): (&Vec<f64>, i32)| Utilisation::new(format!("{name} {i}"), value(leg), limit, text.to_owned());
        run.legs.iter().zip(1..).map(of_leg).collect()
    };
    let (speed, acceleration) = (limits.actuator_velocity, limits.actuator_acceleration);
    let texts = match rig.cranks {
        None => [
            format!("shortest length of {shortest:.3} m"),
            format!("greatest length of {longest:.3} m"),
            format!("speed limit of {speed:.2} m/s"),
            format!("acceleration limit of {acceleration:.1} m/s²"),
        ],
        Some(Cranks { arm, .. }) => [
            format!("lowest angle of {:.1}°", (shortest / arm).to_degrees()),
            format!("highest angle of {:.1}°", (longest / arm).to_degrees()),
            format!("speed limit of {:.2} rad/s", speed / arm),
            format!("acceleration limit of {:.0} rad/s²", acceleration / arm),
        ],
    };
    let short = of_legs(&|leg| farthest(leg, -1.0), half, &texts[0]);
    let long = of_legs(&|leg| farthest(leg, 1.0), half, &texts[1]);
    [
        [short, long].concat(),
        of_legs(&|leg| at.peak_rate(leg), speed, &texts[2]),
        of_legs(&|leg| at.peak_second_rate(leg), acceleration, &texts[3]),
    ]
}

/// The first kind that reached its limit, in order of kinds; otherwise the one that came closest.
fn limit_reason(kinds: [Vec<Utilisation>; 3]) -> String {
    // A limit counts as reached at this fraction of it.
    const REACHED_FRACTION: f64 = 0.98;
    for utilisations in &kinds {
        let reached: Vec<&Utilisation> = utilisations.iter().filter(|one| one.fraction >= REACHED_FRACTION).collect();
        if !reached.is_empty() {
            return limits_reached(&reached);
        }
    }
    closest_to_limit(kinds.into_iter().flatten())
        .map_or_else(|| UNKNOWN_LIMIT.into(), |one| format!("braking or catching up; {}", one.share()))
}

const UNKNOWN_LIMIT: &str = "no limit is known";

/// The one closest to its limit; none if no limit is known.
fn closest_to_limit(utilisations: impl Iterator<Item = Utilisation>) -> Option<Utilisation> {
    let known = utilisations.filter(|one| one.fraction.is_finite());
    known.max_by(|a, b| a.fraction.total_cmp(&b.fraction))
}

/// Axes and legs by the limit that they reach: those at the same one together.
fn limits_reached(reached: &[&Utilisation]) -> String {
    let same_limit = reached.chunk_by(|a, b| a.limit == b.limit);
    let parts = same_limit.map(|utilisations| {
        let who: Vec<&str> = utilisations.iter().map(|one| one.who.as_str()).collect();
        format!("{} at the {}", who.join(", "), utilisations[0].limit)
    });
    parts.collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use moris_simulation::Limits;

    const RIG: Rig = Rig {
        base: [[0.0; 3]; 6],
        platform: [[0.0; 3]; 6],
        neutral_height: 1.1,
        stroke: [1.0, 1.6],
        cranks: None,
        head_height: 1.2,
        torso_length: 0.75,
    };

    /// A run of 2 s at 100 Hz in which nothing happens.
    fn still() -> Run {
        let times: Vec<f64> = (0..=200).map(|k| f64::from(k) * 0.01).collect();
        let all = |value: f64| vec![value; times.len()];
        Run {
            position: [all(0.0), all(0.0), all(1.1)],
            legs: std::array::from_fn(|_| all(1.3)),
            tilt: [all(0.0), all(0.0)],
            tilt_rate: [all(0.0), all(0.0)],
            limited: LimitHistory {
                soft: vec![false; 201],
                safety: vec![false; 201],
                actuator: vec![false; 201],
                ..LimitHistory::default()
            },
            limits: Limits {
                tilt_angle: 0.38,
                tilt_rate: 3_f64.to_radians(),
                tilt_acceleration: 0.2,
                safety_position: [0.45, 0.45, 0.33],
                safety_velocity: [1.0; 3],
                safety_acceleration: [10.0; 3],
                actuator_velocity: 1.0,
                actuator_acceleration: 15.0,
            },
            times,
            ..Run::default()
        }
    }

    #[test]
    fn a_run_without_flags_has_no_events() {
        assert_eq!(events(&still(), &RIG), []);
    }

    #[test]
    fn a_flag_speaks_of_the_step_before_it_and_short_gaps_close() {
        let mut run = still();
        for k in [50, 51, 52, 60, 100] {
            run.limited.safety[k] = true;
        }
        let spans: Vec<(f64, f64)> = events(&run, &RIG).iter().map(|event| (event.from, event.to)).collect();
        assert_eq!(spans, [(0.49, 0.6), (0.99, 1.0)]);
    }

    #[test]
    fn the_reason_is_the_limit_that_is_reached() {
        let mut run = still();
        run.limited.tilt_by[1] = [100, 120, 140].map(|at| (0..201).map(|k| k == at).collect());
        run.limited.safety[100] = true;
        run.limited.actuator[100] = true;
        run.position[2][100] = 1.1 - 0.33;
        run.legs[3][100] = 1.0;
        run.legs[4][100] = 1.6;
        run.legs[5][100] = 1.6;
        let events = events(&run, &RIG);
        let reason = |kind| events.iter().find(|event| event.kind == kind).map(|event| event.why.as_str());
        let tilt: Vec<&str> =
            events.iter().filter(|event| event.kind == Kind::Tilt).map(|event| event.why.as_str()).collect();
        assert_eq!(
            tilt,
            [
                "pitch at the rate limit of 3.0°/s",
                "pitch at the acceleration limit of 11.5°/s²",
                "pitch at the angle limit of 21.8°"
            ]
        );
        assert_eq!(reason(Kind::Safety), Some("heave at the travel limit of 0.33 m"));
        assert_eq!(
            reason(Kind::Actuator),
            Some("leg 4 at the shortest length of 1.000 m; leg 5, leg 6 at the greatest length of 1.600 m")
        );
    }

    #[test]
    fn soft_limits_name_the_limit_that_is_closest() {
        let mut run = still();
        run.limited.soft = (0..201).map(|k| (90..=100).contains(&k)).collect();
        run.position[0].fill(0.36);
        run.legs[2].fill(1.57);
        let [event] = &events(&run, &RIG)[..] else { panic!("one event") };
        assert_eq!((event.kind, event.from, event.to), (Kind::Soft, 0.89, 1.0));
        assert_eq!(event.why, "ahead of a limit; leg 3 at 90 % of the greatest length of 1.600 m");
    }

    #[test]
    fn a_crank_is_named_with_its_angle() {
        // Arms of 0.5 m: 1 and 1.6 m are 2 and 3.2 rad.
        let rig = Rig { cranks: Some(Cranks { arm: 0.5, ..Cranks::default() }), ..RIG };
        let mut run = still();
        run.limited.actuator[100] = true;
        run.legs[3][100] = 1.0;
        run.legs[4][100] = 1.6;
        assert_eq!(
            events(&run, &rig)[0].why,
            "crank 4 at the lowest angle of 114.6°; crank 5 at the highest angle of 183.3°"
        );
    }

    #[test]
    fn a_leg_that_is_too_fast_is_said_to_be() {
        let mut run = still();
        run.limited.actuator[100] = true;
        run.limited.actuator[101] = true;
        run.legs[0][100..].fill(1.31); // 0.01 m in 0.01 s.
        assert_eq!(events(&run, &RIG)[0].why, "leg 1 at the speed limit of 1.00 m/s");
    }

    #[test]
    fn without_a_limit_reached_the_closest_is_named() {
        let mut run = still();
        run.limited.safety[100] = true;
        run.position[0].fill(0.36);
        let why = &events(&run, &RIG)[0].why;
        assert_eq!(why, "braking or catching up; surge at 80 % of the travel limit of 0.45 m");
    }

    #[test]
    fn limits_that_are_not_given_are_not_guessed_at() {
        let mut run = Run { limits: Limits::default(), ..still() };
        run.limited.safety[100] = true;
        assert_eq!(events(&run, &RIG)[0].why, "no limit is known");
    }
}
