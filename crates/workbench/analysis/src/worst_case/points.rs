//! The machines that are tried: the nominal one, and others with a different load and other
//! actuators.

use moris_stewart_platform::Parameters;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::error::{Result, ensure};
use crate::random::unit;

/// Least and largest load, as multiples of the nominal one.
pub const LOADS: [f64; 2] = [0.5, 1.5];
/// Least and largest bandwidth of the actuators, as multiples of the nominal one.
pub const BANDWIDTHS: [f64; 2] = [0.7, 1.3];
/// Least and largest dead time \[s\].
pub const DEAD_TIMES: [f64; 2] = [0.0, 0.05];

/// A machine, relative to the nominal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Moving masses and their inertias, as multiples of the nominal ones.
    pub load: f64,
    /// Bandwidth of the actuators, as a multiple of the nominal one.
    pub bandwidth: f64,
    /// Dead time \[s\].
    pub dead_time: f64,
}

impl Point {
    /// The nominal machine.
    pub fn nominal(platform: &Parameters) -> Self {
        Point { load: 1.0, bandwidth: 1.0, dead_time: platform.actuators.dead_time }
    }

    /// The platform's parameters at this point.
    pub fn parameters(&self, nominal: &Parameters) -> Parameters {
        let mut parameters = *nominal;
        let masses = &mut parameters.masses;
        for mass in [&mut masses.platform_mass, &mut masses.rider_mass, &mut masses.payload_mass] {
            *mass *= self.load;
        }
        for inertia in [&mut masses.platform_inertia, &mut masses.rider_inertia] {
            let elements =
                [&mut inertia.xx, &mut inertia.yy, &mut inertia.zz, &mut inertia.xy, &mut inertia.xz, &mut inertia.yz];
            elements.into_iter().for_each(|element| *element *= self.load);
        }
        parameters.actuators.bandwidth *= self.bandwidth;
        parameters.actuators.dead_time = self.dead_time;
        parameters
    }
}

/// The points: nominal, least and largest value of each quantity in every combination, then so
/// many of a generator with this seed. The nominal machine is the first.
///
/// # Errors
/// The nominal dead time is longer than the largest.
pub fn points(platform: &Parameters, random: usize, seed: u64) -> Result<Vec<Point>> {
    let nominal = platform.actuators.dead_time;
    let longest = DEAD_TIMES[1];
    ensure!(nominal <= longest, "actuator.deadTime is {nominal} s; give a platform with at most {longest} s");
    let mut points = Vec::new();
    for load in with_nominal(1.0, LOADS) {
        for bandwidth in with_nominal(1.0, BANDWIDTHS) {
            points.extend(with_nominal(nominal, DEAD_TIMES).map(|dead_time| Point { load, bandwidth, dead_time }));
        }
    }
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut within = |[least, most]: [f64; 2]| least + unit(&mut generator) * (most - least);
    points.extend((0..random).map(|_| Point {
        load: within(LOADS),
        bandwidth: within(BANDWIDTHS),
        dead_time: within(DEAD_TIMES),
    }));
    Ok(points)
}

fn with_nominal(nominal: f64, [least, most]: [f64; 2]) -> [f64; 3] {
    [nominal, least, most]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_the_combinations_and_then_random_ones_of_the_seed() {
        let nominal = Parameters::default();
        let some = points(&nominal, 50, 1).unwrap();
        assert_eq!(some.len(), 77);
        assert_eq!(some[0], Point::nominal(&nominal));
        for (index, point) in some.iter().enumerate() {
            assert!((0.5..=1.5).contains(&point.load), "{point:?}");
            assert!((0.7..=1.3).contains(&point.bandwidth), "{point:?}");
            assert!((0.0..=0.05).contains(&point.dead_time), "{point:?}");
            assert!(!some[..index].contains(point), "twice: {point:?}");
        }
        assert!(some.contains(&Point { load: 1.5, bandwidth: 0.7, dead_time: 0.05 }));
        assert_eq!(some, points(&nominal, 50, 1).unwrap());
        let other = points(&nominal, 50, 2).unwrap();
        assert!(some[..27] == other[..27] && some[27..].iter().zip(&other[27..]).all(|(a, b)| a != b));
    }

    #[test]
    fn a_load_scales_the_body_and_leaves_its_centre() {
        let mut nominal = Parameters::default();
        nominal.masses.payload_mass = 30.0;
        nominal.masses.payload_centre.x = 0.4;
        nominal.masses.rider_inertia.xy = 0.2;
        let body = |load: f64| {
            let point = Point { load, ..Point::nominal(&nominal) };
            moris_stewart_platform::body::Body::new(&point.parameters(&nominal).masses)
        };
        let (one, heavy) = (body(1.0), body(1.5));
        assert!((heavy.mass - 1.5 * one.mass).abs() < 1e-9);
        assert!((heavy.centre - one.centre).norm() < 1e-12);
        assert!((heavy.inertia - 1.5 * one.inertia).norm() < 1e-9);
    }
}
