//! Motion of the vehicle, as the washout takes it.

use std::f64::consts::TAU;

use moris_washout::Input;
use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use nalgebra::{SVector, Vector3};

/// Numbers in a [`Motion`].
pub const CHANNEL_COUNT: usize = 10;

/// All numbers of a [`Motion`], or their slopes.
pub type Channels = SVector<f64, CHANNEL_COUNT>;

/// Specific force \[m/s2\], angular velocity \[rad/s\], roll, pitch and yaw \[rad\] and speed
/// \[m/s\] of the vehicle. Force and angular velocity are in the vehicle's axes: x forward, y left,
/// z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion(pub Channels);

/// Places of the angles.
pub const ANGLE_CHANNELS: std::ops::Range<usize> = 6..9;

/// Size of each channel that is small, but felt.
pub const SMALLEST_FELT_SIZES: [f64; CHANNEL_COUNT] = [1.0, 1.0, 1.0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 1.0];

/// The whole turns in an angle \[rad\].
pub fn turns(angle: f64) -> f64 {
    TAU * (angle / TAU).round()
}

impl Motion {
    /// A motion from its parts.
    pub fn new(force: Vector3<f64>, rates: Vector3<f64>, angles: RollPitchYaw, speed: f64) -> Self {
        let mut all = Channels::zeros();
        all.fixed_rows_mut::<3>(0).copy_from(&force);
        all.fixed_rows_mut::<3>(3).copy_from(&rates);
        all.fixed_rows_mut::<3>(6).copy_from(&angles.to_vector());
        all[9] = speed;
        Motion(all)
    }

    /// Rest on a level road.
    pub fn at_rest() -> Self {
        Self::new(Vector3::z() * STANDARD_GRAVITY, Vector3::zeros(), RollPitchYaw::default(), 0.0)
    }

    /// The specific force \[m/s2\].
    pub fn force(&self) -> Vector3<f64> {
        self.0.fixed_rows::<3>(0).into()
    }

    /// The angular velocity \[rad/s\].
    pub fn rates(&self) -> Vector3<f64> {
        self.0.fixed_rows::<3>(3).into()
    }

    /// Roll, pitch and yaw \[rad\].
    pub fn angles(&self) -> RollPitchYaw {
        RollPitchYaw::new(self.0[6], self.0[7], self.0[8])
    }

    /// Changes roll, pitch and yaw \[rad\].
    pub fn set_angles(&mut self, angles: RollPitchYaw) {
        self.0.fixed_rows_mut::<3>(6).copy_from(&angles.to_vector());
    }

    /// The forward speed \[m/s\].
    pub fn speed(&self) -> f64 {
        self.0[9]
    }

    /// The washout's input.
    pub fn input(&self, engaged: bool) -> Input {
        Input {
            specific_force: self.force(),
            angular_velocity: self.rates(),
            orientation: self.angles(),
            speed: self.speed(),
            lean: 0.0,
            engaged,
        }
    }
}

impl Default for Motion {
    fn default() -> Self {
        Motion::at_rest()
    }
}

/// A sample of telemetry.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// The packet's clock \[s\].
    pub time: Option<f64>,
    /// The motion.
    pub motion: Motion,
    /// The place in the world, in any axes \[m\].
    pub position: Option<Vector3<f64>>,
    /// True if the packet says that the vehicle does not run.
    pub paused: bool,
    /// True if the packet has the vehicle's angles.
    pub has_angles: bool,
}

/// Names of the channels of a [`Motion`], as in tables.
const CHANNEL_NAMES: [&str; CHANNEL_COUNT] = ["ax", "ay", "az", "wx", "wy", "wz", "roll", "pitch", "yaw", "speed"];

/// Reason for which a sample is dropped.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Implausible {
    /// A channel, by its place, or the position or time is no finite number.
    #[error("{} is no number", .0.map_or("position or time", |place| CHANNEL_NAMES[place]))]
    NoNumber(Option<usize>),
    /// A channel, by its place, is beyond its largest plausible value.
    #[error("{name} is {1:.0}, more than {most:.0} in the washout's unit: check its unit in the table",
        name = CHANNEL_NAMES[*.0], most = Sample::LARGEST[*.0])]
    TooLarge(usize, f64),
}

impl Sample {
    /// Largest plausible values: 10 g, 2000 degrees a second as for recordings, and others.
    const LARGEST: [f64; CHANNEL_COUNT] = [98.0665, 98.0665, 98.0665, 35.0, 35.0, 35.0, 1e4, 1e4, 1e4, 1e4];

    /// The first reason for which the sample says nothing; none if all of it is finite and none of
    /// it absurd.
    pub fn implausible(&self) -> Option<Implausible> {
        let finite = |mut values: std::slice::Iter<f64>| values.all(|value| value.is_finite());
        let values = self.motion.0.iter().enumerate();
        if let Some((place, _)) = values.clone().find(|(_, value)| !value.is_finite()) {
            return Some(Implausible::NoNumber(Some(place)));
        }
        let is_whole = self.position.is_none_or(|position| finite(position.as_slice().iter()))
            && self.time.is_none_or(f64::is_finite);
        if !is_whole {
            return Some(Implausible::NoNumber(None));
        }
        let mut large = values.filter(|(place, value)| value.abs() > Self::LARGEST[*place]);
        large.next().map(|(place, value)| Implausible::TooLarge(place, *value))
    }

    /// True if all of it is finite and none of it absurd.
    pub fn is_plausible(&self) -> bool {
        self.implausible().is_none()
    }
}
