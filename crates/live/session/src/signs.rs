//! Test of the telemetry's signs over the first minute of motion.
//!
//! Each check compares two quantities that must have the same sign: what the vehicle does, by two
//! different channels. Their correlation decides, once there is motion enough. What gravity
//! has in a force follows from the attitude. Without one, a contradiction must exceed what a slope
//! explains. A slow vehicle whose speed has no sign may be reversing.

use moris_washout::interface::STANDARD_GRAVITY;

use crate::motion::{Motion, Sample};
use crate::relation::{Relation, Sums, compared_sample};
use crate::table_check::sentence;
use crate::transitions::named;

named! {
    /// A check of one sign or axis of the telemetry. Its text is the statement that it tests.
    Check {
        /// braking is a backward force (ax against the change of speed)
        Braking "braking",
        /// ay is positive in a left turn (against speed times wz)
        LeftTurn "left turn",
        /// wx is the rate of roll
        Roll "roll",
        /// wy is the rate of pitch, positive nose down
        Pitch "pitch",
        /// wz is the rate of yaw, positive to the left
        Yaw "yaw",
    }
}

/// Result of a check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// Too little motion, or the channels are missing.
    #[default]
    Unknown,
    /// The signs agree.
    Agrees,
    /// The signs contradict each other.
    Contradicts,
}

impl Check {
    /// The contradiction, and the line of the table to change.
    pub fn remedy(self) -> &'static str {
        sentence(self.name())
    }

    /// Least mean square of both quantities with which it decides.
    fn least(self) -> [f64; 2] {
        match self {
            Check::Braking | Check::LeftTurn => [0.05; 2],
            _ => [4e-5; 2],
        }
    }
}

/// The sums of all checks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Signs {
    all: [Sums; 5],
    /// Sums of samples in which the two differ by more than a slope explains.
    apart: [Sums; 5],
    /// Sums of samples with a speed that may be a reversing vehicle's.
    slow: [Sums; 5],
    agrees: [bool; 5],
    last: Option<(f64, Sample)>,
    window: Window,
    /// The speed has been negative: it has a sign.
    has_sign: bool,
    time: f64,
}

/// Sums over a moment, so that a speed of few digits or samples has a slope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Window {
    time: f64,
    /// Surge, and what gravity has in it, times the time.
    surge: f64,
    gravity: f64,
    gained: f64,
    has_attitude: bool,
}

impl Signs {
    /// Takes a sample of this time.
    pub fn take(&mut self, time: f64, sample: &Sample) {
        // Time for which samples are taken [s].
        const SAMPLING_TIME: f64 = 60.0;
        // Part of a turn's acceleration that gravity makes up for in a vehicle that leans into it.
        const LEANING_FRACTION: f64 = 0.5;
        // Angles up to which a body's rates are those of its angles, about [rad].
        const MAX_LEVEL_ANGLE: f64 = 0.3;
        // Largest part of a force that a slope may cause [m/s2], without an attitude and with one.
        const MAX_SLOPE_FORCES: [f64; 2] = [2.5, 0.5];
        // Time over which a change of speed is compared with the force [s].
        const SPEED_CHANGE_WINDOW: f64 = 0.1;
        // Speed below which a vehicle may be reversing, if its speed has no sign [m/s].
        const MAX_REVERSING_SPEED: f64 = 8.0;
        // Speed from which on a negative one is a sign [m/s].
        const MIN_SIGNED_SPEED: f64 = 0.3;
        if self.time >= SAMPLING_TIME {
            return;
        }
        let Some((interval, before)) = compared_sample(&mut self.last, time, sample) else {
            self.window = Window::default();
            return;
        };
        self.time += interval;
        let (now, then) = (&sample.motion, &before.motion);
        let mean = Motion(0.5 * (now.0 + then.0));
        let slope = Motion((now.0 - then.0) / interval);
        let (force, rates, angles) = (mean.force(), mean.rates(), mean.angles());
        let angle_slopes = slope.angles();
        self.has_sign |= now.speed() < -MIN_SIGNED_SPEED;
        let is_slow = !self.has_sign && mean.speed().abs() < MAX_REVERSING_SPEED;
        // Columns of zeros are no attitude.
        let has_attitude = sample.has_angles && (angles.roll != 0.0 || angles.pitch != 0.0);
        let gravity = if has_attitude { STANDARD_GRAVITY } else { 0.0 };
        let window = &mut self.window;
        window.has_attitude = has_attitude && (window.time == 0.0 || window.has_attitude);
        window.time += interval;
        window.surge += force.x * interval;
        // Nose up, gravity's reaction is forward.
        window.gravity -= gravity * libm::sin(angles.pitch) * interval;
        window.gained += now.speed() - then.speed();
        if window.time >= SPEED_CHANGE_WINDOW {
            let Window { time, surge, gravity, gained, has_attitude } = std::mem::take(window);
            let [most, gravity] =
                if has_attitude { [MAX_SLOPE_FORCES[1], gravity] } else { [MAX_SLOPE_FORCES[0], 0.0] };
            self.add(Check::Braking, surge / time, (gained + gravity) / time, most, is_slow);
        }
        let turn = mean.speed() * rates.z;
        // A motorcycle leans until nothing pushes; what is left says nothing of the turn.
        let leans =
            sample.has_angles && STANDARD_GRAVITY * libm::sin(angles.roll).abs() > LEANING_FRACTION * turn.abs();
        if !leans {
            let banked = gravity * libm::sin(angles.roll) * libm::cos(angles.pitch);
            let most = if has_attitude { MAX_SLOPE_FORCES[1] } else { MAX_SLOPE_FORCES[0] };
            self.add(Check::LeftTurn, force.y, turn + banked, most, is_slow);
        }
        let level = angles.roll.abs() < MAX_LEVEL_ANGLE && angles.pitch.abs() < MAX_LEVEL_ANGLE;
        if sample.has_angles && level {
            self.add(Check::Roll, rates.x, angle_slopes.roll, 0.0, false);
            self.add(Check::Pitch, rates.y, angle_slopes.pitch, 0.0, false);
            // At half a turn the yaw jumps.
            if angle_slopes.yaw.abs() * interval < 1.0 {
                self.add(Check::Yaw, rates.z, angle_slopes.yaw, 0.0, false);
            }
        }
        for &check in Check::ALL {
            self.agrees[check as usize] |= self.decided(check) == Verdict::Agrees;
        }
    }

    fn add(&mut self, check: Check, x: f64, y: f64, slope: f64, is_slow: bool) {
        let place = check as usize;
        if is_slow {
            self.slow[place].add(x, y);
            return;
        }
        self.all[place].add(x, y);
        if (x - y).abs() > slope {
            self.apart[place].add(x, y);
        }
    }

    /// The result of a check so far. Once it agrees, it does so.
    pub fn verdict(&self, check: Check) -> Verdict {
        if self.agrees[check as usize] { Verdict::Agrees } else { self.decided(check) }
    }

    fn decided(&self, check: Check) -> Verdict {
        // Samples from which on a check decides, and the time of motion after which signs may agree
        // [s]. Within less, two channels that have nothing to do with each other may go together.
        const MIN_SAMPLES: f64 = 40.0;
        const AGREEING_TIME: f64 = 2.0;
        // Correlation from which on a check decides.
        const DECISIVE_CORRELATION: f64 = 0.5;
        // Largest factor between the sizes of two channels that agree.
        const AGREEING_FACTOR: f64 = 3.0;
        // Part of `MIN_SAMPLES` from which on the change of speed decides.
        const BRAKING_SAMPLE_FRACTION: f64 = 0.5;
        let [all, apart, slow] = [&self.all, &self.apart, &self.slow].map(|sums| sums[check as usize]);
        let least = check.least();
        let enough = if check == Check::Braking { MIN_SAMPLES * BRAKING_SAMPLE_FRACTION } else { MIN_SAMPLES };
        let known = |sums: &Sums, enough: f64| {
            let relation = sums.relation();
            let is_known = relation.count >= enough && (0..2).all(|k| relation.sizes[k].powi(2) >= least[k]);
            is_known.then_some(relation)
        };
        let agrees = |sums: &Sums| {
            let is_near = |relation: Relation| relation.is_near(1.0, AGREEING_FACTOR, DECISIVE_CORRELATION);
            self.time >= AGREEING_TIME && known(sums, enough).is_some_and(is_near)
        };
        let contradicts = |sums: &Sums, enough: f64| {
            known(sums, enough).is_some_and(|found| found.correlation < -DECISIVE_CORRELATION)
        };
        if agrees(&all) || agrees(&slow) && !contradicts(&all, enough) {
            Verdict::Agrees
        } else if contradicts(&all, enough) && contradicts(&apart, enough) {
            Verdict::Contradicts
        } else {
            Verdict::Unknown
        }
    }

    /// The first check whose signs contradict each other.
    pub fn contradiction(&self) -> Option<Check> {
        Check::ALL.iter().copied().find(|check| self.verdict(*check) == Verdict::Contradicts)
    }
}

#[cfg(test)]
mod tests {
    use moris_washout::interface::RollPitchYaw;
    use nalgebra::Vector3;

    use super::*;

    /// A car that brakes, accelerates and turns for a minute, level but for small angles.
    fn drive(t: f64) -> Sample {
        let speed = 15.0 + 5.0 * (0.4 * t).sin();
        let rate = 0.3 * (0.7 * t).sin();
        let angles = RollPitchYaw::new(0.05 * t.sin(), 0.04 * (1.3 * t).sin(), -0.3 / 0.7 * (0.7 * t).cos());
        let rates = Vector3::new(0.05 * t.cos(), 0.04 * 1.3 * (1.3 * t).cos(), rate);
        let force = Vector3::new(5.0 * 0.4 * (0.4 * t).cos(), speed * rate, 9.8);
        Sample { motion: Motion::new(force, rates, angles, speed), has_angles: true, ..Sample::default() }
    }

    fn tested(change: impl Fn(&mut Sample)) -> Signs {
        let mut signs = Signs::default();
        for k in 0..3600 {
            let mut sample = drive(f64::from(k) / 60.0);
            change(&mut sample);
            signs.take(f64::from(k) / 60.0, &sample);
        }
        signs
    }

    #[test]
    fn right_signs_agree_and_each_wrong_one_is_found() {
        let right = tested(|_| ());
        for &check in Check::ALL {
            assert_eq!(right.verdict(check), Verdict::Agrees, "{check:?}");
        }
        for (channel, check) in
            [(0, Check::Braking), (1, Check::LeftTurn), (6, Check::Roll), (7, Check::Pitch), (8, Check::Yaw)]
        {
            let wrong = tested(|sample| sample.motion.0[channel] *= -1.0);
            assert_eq!(wrong.contradiction(), Some(check));
        }
    }

    #[test]
    fn a_motorcycle_that_leans_into_its_turns_is_left_out() {
        let leaning = tested(|sample| {
            let turn = sample.motion.0[9] * sample.motion.0[5];
            sample.motion.0[6] = -(turn / STANDARD_GRAVITY).atan();
            // What is left of the lateral force at its head has the other sign.
            sample.motion.0[1] = -0.5 * turn;
        });
        assert_eq!(leaning.verdict(Check::LeftTurn), Verdict::Unknown);
    }

    #[test]
    fn a_vehicle_at_rest_says_nothing() {
        let still = tested(|sample| sample.motion = Motion::at_rest());
        assert!(Check::ALL.iter().all(|check| still.verdict(*check) == Verdict::Unknown));
    }
}
