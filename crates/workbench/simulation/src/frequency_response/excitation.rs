//! Excitation in the tests: one channel at a time, a sine.

use std::f64::consts::PI;

use moris_washout::interface::{GravityRemoval, RollPitchYaw};
use moris_washout::motion::orientation::Orientation;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Input, Parameters};

use super::channel::Channel;

/// The test's frequencies: twelve, five to a decade, 0.1 to 15.85 rad/s.
pub fn frequencies() -> [f64; 12] {
    std::array::from_fn(|k| 0.1 * 10_f64.powf(0.2 * k as f64))
}

/// Amplitudes of the sines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitudes {
    /// Specific force \[m/s2\].
    pub force: f64,
    /// Angular velocity, where the two below allow it \[rad/s\].
    pub rate: f64,
    /// Largest angle, which bounds slow turning \[rad\].
    pub angle: f64,
    /// Largest angular acceleration, which bounds quick turning \[rad/s2\].
    pub angular_acceleration: f64,
}

impl Default for Amplitudes {
    fn default() -> Self {
        Amplitudes {
            force: 1.0,
            rate: 1_f64.to_radians(),
            angle: 6_f64.to_radians(),
            angular_acceleration: 10_f64.to_radians(),
        }
    }
}

impl Amplitudes {
    /// All amplitudes times a factor.
    pub fn scaled(self, factor: f64) -> Self {
        Amplitudes {
            force: factor * self.force,
            rate: factor * self.rate,
            angle: factor * self.angle,
            angular_acceleration: factor * self.angular_acceleration,
        }
    }

    /// A channel's amplitude at a frequency \[m/s2 or rad/s\].
    pub fn of(&self, channel: Channel, frequency: f64) -> f64 {
        if channel.is_rotation() {
            self.rate.min(self.angle * frequency).min(self.angular_acceleration / frequency)
        } else {
            self.force
        }
    }
}

/// A sine on one channel that fades in over whole periods, without a jump.
#[derive(Clone, Copy, Debug)]
pub struct Sine<'a> {
    pub channel: Channel,
    /// Amplitude \[m/s2 or rad/s\].
    pub amplitude: f64,
    /// Angular frequency \[rad/s\].
    pub frequency: f64,
    /// Time over which it fades in, whole periods \[s\].
    pub fade: f64,
    /// True if the vehicle's orientation follows its roll and pitch rates, and the
    /// specific force with it.
    pub gravity_turns: bool,
    pub parameters: &'a Parameters,
}

impl Sine<'_> {
    /// The washout's input at a time.
    pub fn input(&self, time: f64) -> Input {
        let mut force = Vector3::zeros();
        let mut input = Input::default();
        let axis = self.channel as usize % 3;
        if self.channel.is_rotation() {
            let (angle, rate) = self.turning(time);
            input.angular_velocity[axis] = rate;
            if self.gravity_turns {
                let mut angles = Vector3::zeros();
                angles[axis] = angle;
                input.orientation = RollPitchYaw::new(angles.x, angles.y, angles.z);
            }
        } else {
            force[axis] = self.force(time);
        }
        input.specific_force = force + self.gravity(input.orientation);
        input
    }

    /// The channel's value at a time, in SI units.
    pub fn value(&self, time: f64) -> f64 {
        if self.channel.is_rotation() { self.turning(time).1 } else { self.force(time) }
    }

    fn force(&self, time: f64) -> f64 {
        self.amplitude * self.faded(time).0 * (self.frequency * time).sin()
    }

    /// Angle and rate: the angle sways about 0, and the rate is its derivative, fading included.
    fn turning(&self, time: f64) -> (f64, f64) {
        let (fraction, fraction_rate) = self.faded(time);
        let (sin, cos) = (self.frequency * time).sin_cos();
        let swing = self.amplitude / self.frequency;
        (-swing * fraction * cos, self.amplitude * fraction * sin - swing * fraction_rate * cos)
    }

    /// Part of gravity in the specific force of a vehicle in this orientation.
    fn gravity(&self, orientation: RollPitchYaw) -> Vector3<f64> {
        let Parameters { conditioning, structure, .. } = self.parameters;
        if conditioning.gravity_removal == GravityRemoval::None {
            return Vector3::zeros();
        }
        let upright = Vector3::new(0.0, 0.0, structure.gravity);
        // Most vehicles of this test stay level: nothing is to be turned at each of a million steps.
        if orientation == RollPitchYaw::default() {
            upright
        } else {
            Orientation::new(orientation).rotation.tr_mul(&upright)
        }
    }

    /// Fade-in factor, a raised cosine from 0 to 1, and its time derivative.
    fn faded(&self, time: f64) -> (f64, f64) {
        if time >= self.fade {
            return (1.0, 0.0);
        }
        let (sin, cos) = (PI * time / self.fade).sin_cos();
        (0.5 - 0.5 * cos, 0.5 * PI / self.fade * sin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SINE: fn(&Parameters, Channel) -> Sine = |parameters, channel| Sine {
        channel,
        amplitude: 0.1,
        frequency: 2.0,
        fade: 3.0 * PI,
        gravity_turns: true,
        parameters,
    };

    #[test]
    fn the_frequencies_go_from_a_tenth_to_nearly_sixteen() {
        let all = frequencies();
        assert_eq!(all[0], 0.1);
        assert!((all[5] - 1.0).abs() < 1e-15);
        assert!((all[11] - 15.848_931_924_611_133).abs() < 1e-12);
    }

    #[test]
    fn slow_turning_is_bounded_by_its_angle_and_quick_turning_by_its_acceleration() {
        let amplitudes = Amplitudes::default();
        let degrees = |frequency| amplitudes.of(Channel::Pitch, frequency).to_degrees();
        assert!((degrees(0.1) - 0.6).abs() < 1e-12);
        assert!((degrees(1.0) - 1.0).abs() < 1e-12);
        assert!((degrees(20.0) - 0.5).abs() < 1e-12);
        assert_eq!(amplitudes.of(Channel::Heave, 0.1), 1.0);
    }

    #[test]
    fn the_rate_is_the_angle_s_derivative_while_it_fades_in_and_after() {
        let parameters = Parameters::default();
        let sine = SINE(&parameters, Channel::Roll);
        for k in 0..2000 {
            let time = 0.01 * f64::from(k) + 0.005;
            let difference =
                (sine.input(time + 1e-5).orientation.roll - sine.input(time - 1e-5).orientation.roll) / 2e-5;
            assert!((difference - sine.value(time)).abs() < 1e-8, "at {time}");
        }
        assert!((sine.value(3.0 * PI + 0.6) - 0.1 * 1.2_f64.sin()).abs() < 1e-15);
    }

    #[test]
    fn a_tilted_vehicle_feels_gravity_and_a_level_one_none_of_it() {
        let parameters = Parameters::default();
        let tilted = SINE(&parameters, Channel::Pitch).input(3.0 * PI);
        // Nose up by 0.05 rad.
        assert!((tilted.orientation.pitch + 0.05).abs() < 1e-12);
        assert!((tilted.specific_force.x - 9.80665 * 0.05_f64.sin()).abs() < 1e-12);
        let level = Sine { gravity_turns: false, ..SINE(&parameters, Channel::Pitch) }.input(3.0 * PI);
        assert_eq!(level.specific_force, Vector3::new(0.0, 0.0, 9.80665));
    }
}
