//! Wrong units, signs and frames of a foreign motion.

use crate::measures::delay::{LONGEST_DELAY, delay_within};
use crate::measures::statistics::median;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::{Geometry, Pose, leg_lengths};
use moris_washout::{Output, Parameters};

use super::differences::rounding_error;
use crate::{Refusal, Simulation, refuse, sentence};

/// Checks that poses and legs can be meant on this rig.
///
/// # Errors
/// The values are in other units or relative to another frame.
pub fn check(
    pose: &Option<Vec<[f64; 6]>>,
    legs: &Option<Vec<[f64; 6]>>,
    parameters: &Parameters,
) -> Result<(), Refusal> {
    // Largest pitch, roll or yaw that a platform on six legs can have [rad].
    const LARGEST_ANGLE: f64 = 1.6;
    // Lengths and heights beyond this multiple of the rig's cannot be meant.
    const MAX_SIZE_RATIO: f64 = 5.0;
    let rig = &parameters.rig;
    if let Some(pose) = pose {
        let neutral = rig.neutral_height;
        let height = median(pose.iter().map(|pose| pose[2]));
        if height.abs() > MAX_SIZE_RATIO * neutral {
            refuse!(sentence!["pose-in-mm", height]);
        }
        if height < 0.3 * neutral {
            refuse!(sentence!["pose-from-neutral", height, neutral, exact = neutral]);
        }
        for (k, name) in ["roll", "pitch", "yaw"].into_iter().enumerate() {
            let largest = pose.iter().map(|pose| pose[3 + k].abs()).fold(0.0, f64::max);
            if largest > LARGEST_ANGLE && largest < std::f64::consts::TAU - LARGEST_ANGLE || largest > 7.0 {
                refuse!(sentence!["pose-in-degrees", name, largest]);
            }
        }
    }
    if legs.is_some() && rig.has_cranks() {
        refuse!(sentence!["legs-of-cranks"]);
    }
    if let Some(legs) = legs {
        let all = || legs.iter().flatten().copied();
        let [least, greatest] = [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)];
        let (shortest, longest) = (rig.min_length, rig.max_length);
        let length = median(all());
        let remedy = if greatest < shortest && greatest - least <= longest - shortest {
            let neutral = leg_lengths(&Geometry::from(rig), &Pose::neutral(rig)).iter().sum::<f64>() / 6.0;
            let (zero, length) = if least < 0.0 { ("neutral", neutral) } else { ("the retracted leg", shortest) };
            format!("these may be strokes from {zero}: add {length:.3} m to each")
        } else if !(shortest / MAX_SIZE_RATIO..longest * MAX_SIZE_RATIO).contains(&length) {
            "check the unit (m), and add the shortest length to strokes".to_owned()
        } else {
            return Ok(());
        };
        refuse!(sentence!["legs-out-of-range", least, greatest, length, shortest, longest, remedy]);
    }
    Ok(())
}

/// Decimals of poses, and the RMS error of force that their rounding causes \[m/s2\]; none where
/// they are not rounded.
fn rounded_decimals(poses: &[[f64; 6]], samples: usize, step: f64) -> Option<(i32, f64)> {
    // Decimals that are looked for in poses.
    const POSE_DECIMALS: std::ops::RangeInclusive<i32> = 2..=9;
    let is_multiple = |value: f64, decimals: i32| {
        let scaled = value * 10f64.powi(decimals);
        (scaled - scaled.round()).abs() < 1e-4
    };
    let all = |decimals: &i32| poses.iter().all(|pose| pose[..3].iter().all(|value| is_multiple(*value, *decimals)));
    let moves = poses.iter().any(|pose| pose[..3] != poses[0][..3]);
    let decimals = POSE_DECIMALS.into_iter().find(all).filter(|_| moves)?;
    let parts = (poses.len() - 1) / (samples - 1);
    Some((decimals, rounding_error(10f64.powi(-decimals), step / parts as f64)))
}

/// The error of forces that rounded poses cause, where it is worth a sentence.
pub fn rounding(poses: &[[f64; 6]], samples: usize, step: f64) -> Option<String> {
    // Error by rounding that is worth a sentence [m/s2].
    const LEAST_ROUNDING: f64 = 0.02;
    let (decimals, error) = rounded_decimals(poses, samples, step)?;
    let rate = ((poses.len() - 1) / (samples - 1)) as f64 / step;
    (error >= LEAST_ROUNDING).then(|| sentence!["poses-rounded", decimals, rate, error])
}

/// Legs that are not those of the poses.
pub fn other_legs(legs: &[[f64; 6]], of_poses: &[[f64; 6]]) -> Option<String> {
    // Difference of legs from those of the poses that is worth a sentence [m].
    const DIFFERENT_LEGS: f64 = 1e-3;
    let pairs = legs.iter().flatten().zip(of_poses.iter().flatten());
    let difference = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let is_other = legs.len() == of_poses.len() && difference > DIFFERENT_LEGS;
    is_other.then(|| sentence!["legs-of-others", difference = 1000.0 * difference])
}

/// A difference of felt forces from those of the poses.
pub fn contradiction(
    force: &[[f64; 3]],
    poses: &[[f64; 6]],
    of_poses: &[[f64; 3]],
    samples: usize,
    step: f64,
) -> Option<String> {
    // RMS of the difference of given forces from those of the poses that is worth a sentence, as a
    // fraction of the latter, and at least [m/s2].
    const MIN_DIFFERENCE_FRACTION: f64 = 0.1;
    const LEAST_DIFFERENT: f64 = 0.1;
    // Error by rounding, as a multiple of its RMS, that is no difference.
    const MOST_ROUNDING: f64 = 3.0;
    let parts = |series: &[[f64; 3]]| (series.len() - 1) / (samples - 1);
    let rest = [0.0, 0.0, STANDARD_GRAVITY];
    let [mut difference, mut size] = [0.0; 2];
    for (given, evaluated) in force.iter().step_by(parts(force)).zip(of_poses.iter().step_by(parts(of_poses))) {
        for axis in 0..3 {
            difference += (given[axis] - evaluated[axis]).powi(2);
            size += (evaluated[axis] - rest[axis]).powi(2);
        }
    }
    let [difference, size] = [difference, size].map(|sum: f64| (sum / samples as f64).sqrt());
    let rounding = rounded_decimals(poses, samples, step).map_or(0.0, |(_, error)| error);
    let allowed = LEAST_DIFFERENT.max(MIN_DIFFERENCE_FRACTION * size) + MOST_ROUNDING * rounding;
    (difference > allowed).then(|| sentence!["force-of-others", difference])
}

/// Suspicions about units and signs of what is felt, against what is desired.
pub fn suspicions(simulation: &Simulation, has_rate: bool) -> Vec<String> {
    // Correlation below which a sign is suspected, and above which a size is.
    const OPPOSED_CORRELATION: f64 = -0.5;
    const ALIKE_CORRELATION: f64 = 0.9;
    // Relative tolerance of a size that is suspected to be in another unit.
    const SIZE_TOLERANCE: f64 = 0.15;
    // The axis that no tilt coordination turns about.
    const YAW_AXIS: usize = 2;
    // RMS of a signal that is enough for a suspicion, of forces [m/s2] and of rates [rad/s].
    const MIN_SUSPECTED_FORCE: f64 = 0.05;
    const MIN_SUSPECTED_RATE: f64 = 0.01;
    let gravity = simulation.parameters.structure.gravity;
    let scale = &simulation.parameters.conditioning.force_scale;
    let vertical = median(simulation.outputs.iter().map(|output| output.felt_specific_force.z));
    if let Some(sentence) = of_vertical(vertical, gravity) {
        return vec![sentence];
    }
    if let Some(sentence) = exchanged_axes(simulation, MIN_SUSPECTED_FORCE) {
        return vec![sentence];
    }
    let mut found = Vec::new();
    for (axis, name) in ["Surge", "Sway"].into_iter().enumerate() {
        let samples = || simulation.inputs.iter().zip(&simulation.outputs);
        let pairs =
            || samples().map(move |(input, output)| [input.specific_force[axis], output.felt_specific_force[axis]]);
        let Some(Likeness { correlation, size }) = signal_likeness(pairs, MIN_SUSPECTED_FORCE) else { continue };
        let may_be_late = correlation.abs() < -OPPOSED_CORRELATION;
        if let Some(sentence) = may_be_late.then(|| late_force(simulation, axis, name)).flatten() {
            found.push(sentence);
        } else if correlation < OPPOSED_CORRELATION {
            found.push(sentence!["force-opposite", name, correlation, axis = ["x", "y"][axis]]);
        } else if correlation > ALIKE_CORRELATION
            && (size / scale[axis] * STANDARD_GRAVITY - 1.0).abs() < SIZE_TOLERANCE
        {
            found.push(sentence!["force-in-g", name]);
        }
    }
    let rates = if has_rate { simulation.desired_rates() } else { Vec::new() };
    for (axis, name) in ["Roll rate", "Pitch rate", "Yaw rate"].into_iter().enumerate() {
        let samples = || rates.iter().zip(&simulation.outputs);
        let pairs = || samples().map(move |(rate, output)| [rate[axis], output.felt_angular_velocity[axis]]);
        let Some(Likeness { correlation, size }) = signal_likeness(pairs, MIN_SUSPECTED_RATE) else { continue };
        if correlation > -OPPOSED_CORRELATION && size > 10.0 {
            found.push(sentence!["rate-in-degrees", name, size]);
        } else if axis == YAW_AXIS && correlation < -ALIKE_CORRELATION {
            found.push(sentence!["rate-opposite", name, correlation]);
        }
    }
    found
}

/// Surge and sway that are felt for each other, or travelled for each other in poses whose angles
/// are right.
fn exchanged_axes(simulation: &Simulation, least_force: f64) -> Option<String> {
    // Least correlation of exchanged axes, and largest of the right ones as a fraction of it.
    const MIN_EXCHANGED_CORRELATION: f64 = 0.3;
    const MAX_RIGHT_FRACTION: f64 = 0.5;
    let exchanged = |(name, of): (&str, fn(&Output) -> Vector3<f64>)| {
        let correlation = |desired: usize, felt: usize| {
            let samples = || simulation.inputs.iter().zip(&simulation.outputs);
            let pairs = || samples().map(move |(input, output)| [input.specific_force[desired], of(output)[felt]]);
            signal_likeness(pairs, least_force).map(|likeness| likeness.correlation)
        };
        let [of_x, of_y] = [correlation(0, 1)?, correlation(1, 0)?];
        let largest = correlation(0, 0)?.abs().max(correlation(1, 1)?.abs());
        let least = of_x.abs().min(of_y.abs());
        let is_exchanged = least >= MIN_EXCHANGED_CORRELATION && largest <= MAX_RIGHT_FRACTION * least;
        is_exchanged.then(|| sentence!["axes-exchanged", name, of_x, of_y])
    };
    let felt: fn(&Output) -> Vector3<f64> = |output| output.felt_specific_force;
    [("felt force", felt), ("platform's acceleration", |output| output.acceleration)].into_iter().find_map(exchanged)
}

/// A force that is felt later or earlier than delays are searched for.
fn late_force(simulation: &Simulation, axis: usize, name: &str) -> Option<String> {
    // Longest shift that is found here [s], and as a fraction of the motion: rides repeat themselves.
    const LONGEST_SHIFT: f64 = 20.0;
    const MAX_SHIFTED_FRACTION: f64 = 0.25;
    let desired: Vec<f64> = simulation.inputs.iter().map(|input| input.specific_force[axis]).collect();
    let felt: Vec<f64> = simulation.outputs.iter().map(|output| output.felt_specific_force[axis]).collect();
    let found = |longest: f64| delay_within(longest, &desired, &felt, simulation.step);
    let longest = LONGEST_SHIFT.min(MAX_SHIFTED_FRACTION * simulation.step * desired.len() as f64);
    let delay = found(longest).filter(|delay| delay.abs() >= LONGEST_DELAY && found(LONGEST_DELAY).is_none())?;
    let later = if delay > 0.0 { "later" } else { "earlier" };
    Some(sentence!["force-late", name, delay = delay.abs(), later, longest = LONGEST_DELAY])
}

/// A wrong vertical force \[m/s2\] at the median.
fn of_vertical(vertical: f64, gravity: f64) -> Option<String> {
    // Ranges of a ratio to gravity: near it, and in units of it.
    const GRAVITY_RATIO_RANGE: std::ops::Range<f64> = 0.7..1.3;
    // Magnitude of z without gravity's reaction [m/s2].
    const WITHOUT_GRAVITY: f64 = 0.5;
    let rest = format!("a rider at rest feels (0, 0, {gravity:.2})");
    if GRAVITY_RATIO_RANGE.contains(&(vertical / gravity)) {
        None
    } else if GRAVITY_RATIO_RANGE.contains(&vertical) {
        Some(sentence!["vertical-in-g", vertical, rest])
    } else if vertical.abs() < WITHOUT_GRAVITY {
        Some(sentence!["vertical-without-gravity", vertical, rest, gravity])
    } else if GRAVITY_RATIO_RANGE.contains(&(-vertical / gravity)) || GRAVITY_RATIO_RANGE.contains(&-vertical) {
        Some(sentence!["vertical-opposite", vertical, rest])
    } else {
        Some(sentence!["vertical-unknown", vertical, rest])
    }
}

/// Correlation of two signals, and the size of the second relative to the first.
struct Likeness {
    correlation: f64,
    size: f64,
}

/// Of pairs whose first signal is at least so large (RMS about its mean).
fn signal_likeness<I: Iterator<Item = [f64; 2]>>(pairs: impl Fn() -> I, least: f64) -> Option<Likeness> {
    let count = pairs().count() as f64;
    let mean = |k: usize| pairs().map(|pair| pair[k]).sum::<f64>() / count;
    let means = [mean(0), mean(1)];
    let product = |i: usize, j: usize| pairs().map(|pair| (pair[i] - means[i]) * (pair[j] - means[j])).sum::<f64>();
    let [desired, felt, both] = [product(0, 0), product(1, 1), product(0, 1)];
    let is_enough = count > 1.0 && (desired / count).sqrt() >= least && felt > 0.0;
    is_enough.then(|| Likeness { correlation: both / (desired * felt).sqrt(), size: both / desired })
}
