//! Linear interpolation between samples, of angles on the circle.

use std::f64::consts::{PI, TAU};

use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Rotation3, UnitQuaternion, Vector3};

/// The two samples around a time.
#[derive(Clone, Copy)]
pub struct Bracket {
    /// The first sample after it.
    pub after: usize,
    /// Fraction of the time from the sample before to it.
    fraction: f64,
}

/// The brackets of times among at least two samples. Both ascend; times beyond the samples' ends
/// are at the ends.
pub fn places(samples: &[f64], times: &[f64]) -> Vec<Bracket> {
    let mut after = 1;
    let place = |&time: &f64| {
        while after + 1 < samples.len() && samples[after] < time {
            after += 1;
        }
        let (before, next) = (samples[after - 1], samples[after]);
        Bracket { after, fraction: ((time - before) / (next - before)).clamp(0.0, 1.0) }
    };
    times.iter().map(place).collect()
}

/// The value at a fraction of the way between two. With a period, the shorter way round.
pub fn between(before: f64, next: f64, fraction: f64, period: Option<f64>) -> f64 {
    let step = next - before;
    let step = period.map_or(step, |period| step - period * (step / period).round());
    before + fraction * step
}

/// The values at places; `period` is that of angles.
pub fn values(places: &[Bracket], samples: &[f64], period: Option<f64>) -> Vec<f64> {
    let value = |place: &Bracket| between(samples[place.after - 1], samples[place.after], place.fraction, period);
    places.iter().map(value).collect()
}

/// Roll, pitch and yaw \[rad\] at places.
pub fn orientations(places: &[Bracket], angles: [&[f64]; 3]) -> [Vec<f64>; 3] {
    // Step of an angle above which an orientation is interpolated as a rotation [rad]: near the
    // vertical roll and yaw flip by half a turn.
    const FLIP: f64 = 0.5;
    let mut found = angles.map(|angle| values(places, angle, Some(TAU)));
    for (k, place) in places.iter().enumerate() {
        let at = |sample: usize| Vector3::from_fn(|axis, _| angles[axis][sample]);
        let (before, next) = (at(place.after - 1), at(place.after));
        let step = (next - before).map(|step| (step + PI).rem_euclid(TAU) - PI);
        if step.amax() > FLIP {
            let rotation = |angles: Vector3<f64>| {
                let rotation = Orientation::new(RollPitchYaw::from_vector(angles)).rotation;
                UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation))
            };
            // Opposite rotations have no way between them.
            let Some(turned) = rotation(before).try_slerp(&rotation(next), place.fraction, 1e-9) else { continue };
            let (roll, pitch, yaw) = turned.euler_angles();
            [roll, pitch, yaw].into_iter().zip(&mut found).for_each(|(angle, found)| found[k] = angle);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_take_the_shorter_way_round() {
        assert!((between(3.0, -3.0, 0.5, Some(TAU)).abs() - PI).abs() < 1e-12);
        assert!((between(350.0, 20.0, 0.5, Some(360.0)) - 365.0).abs() < 1e-12);
        assert_eq!(between(3.0, -3.0, 0.5, None), 0.0);
    }

    /// A loop: pitch turns at a constant rate, in angles that flip at the vertical.
    #[test]
    fn an_orientation_that_flips_turns_on() {
        let pitch = [1.4, 1.7];
        let flipped = (PI, PI - pitch[1], PI);
        let angles = [[0.0, flipped.0], [pitch[0], flipped.1], [0.0, flipped.2]];
        let places = [Bracket { after: 1, fraction: 0.25 }, Bracket { after: 1, fraction: 0.75 }];
        let [roll, pitch, yaw] = orientations(&places, [&angles[0], &angles[1], &angles[2]]);
        for (k, true_pitch) in [(0, 1.475f64), (1, 1.625)] {
            let found = Orientation::new(RollPitchYaw::new(roll[k], pitch[k], yaw[k])).rotation;
            let expected = Orientation::new(RollPitchYaw::new(0.0, true_pitch, 0.0)).rotation;
            assert!((found - expected).norm() < 1e-9, "{k}: {found}");
        }
    }
}
