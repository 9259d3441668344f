//! Motion with limited drive forces, or with legs at the ends of their strokes.
//!
//! All legs carry one body, so that a force of one accelerates all: v = v0 + h A F, with A the
//! legs' mobility. Each drive has the force that brings its leg to the demanded velocity, or its
//! largest force. A stop at an end of a stroke has the force that keeps its leg inside. These
//! conditions have exactly one solution, since A is positive definite. In the body's kinetic energy
//! it is the motion nearest to the demand (Gauss's principle of least constraint).

use nalgebra::{Matrix6, Vector6};

/// Demand on a leg over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Velocity demanded by the drive at the step's end \[m/s\].
    pub demand: f64,
    /// Least and largest velocity at which the leg stays inside its stroke \[m/s\].
    pub slowest: f64,
    pub fastest: f64,
}

/// Resulting motion of the legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Velocities at the step's end \[m/s\].
    pub velocity: Vector6<f64>,
    /// Forces on the body over the step, drives and stops together \[N\].
    pub force: Vector6<f64>,
}

/// Solves the conditions leg by leg, over and over (Gauss and Seidel's method, which converges for
/// them).
///
/// `free` are the velocities at the step's end without any force, `gain` is h A, and no drive has
/// more force than `limit`.
pub fn solve(free: &Vector6<f64>, gain: &Matrix6<f64>, legs: &[Leg; 6], limit: f64) -> Outcome {
    // Largest number of sweeps over the six legs; some tens suffice.
    const MOST_SWEEPS: usize = 500;
    // Convergence: largest change of a force as a fraction of the largest force.
    const FORCE_TOLERANCE: f64 = 1e-12;
    let mut force = Vector6::zeros();
    for _ in 0..MOST_SWEEPS {
        let mut change: f64 = 0.0;
        for (i, leg) in legs.iter().enumerate() {
            // The leg's velocity under the other legs' forces alone, and the force that makes it another.
            let without = free[i] + gain.row(i).dot(&force.transpose()) - gain[(i, i)] * force[i];
            let force_for = |velocity: f64| (velocity - without) / gain[(i, i)];
            let drive = force_for(leg.demand).clamp(-limit, limit);
            let next = drive.max(force_for(leg.slowest)).min(force_for(leg.fastest));
            change = change.max((next - force[i]).abs());
            force[i] = next;
        }
        if change <= FORCE_TOLERANCE * force.amax() {
            break;
        }
    }
    Outcome { velocity: free + gain * force, force }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mobility from numbers that look like chance.
    fn mobility(seed: u32) -> Matrix6<f64> {
        let mut state = seed;
        let root = Matrix6::from_fn(|_, _| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        });
        root * root.transpose() + 0.1 * Matrix6::identity()
    }

    #[test]
    fn every_leg_has_what_it_wants_or_what_it_can() {
        let limit = 1.0;
        let (mut free_legs, mut saturated, mut stopped) = (0, 0, 0);
        for seed in 0..200 {
            let gain = mobility(seed);
            let free = gain * Vector6::from_fn(|i, _| if i % 2 == 0 { 1.5 } else { -2.0 });
            let legs: [Leg; 6] = std::array::from_fn(|i| {
                let demand = gain[(i, (i + 1) % 6)];
                Leg { demand, slowest: demand - 0.4, fastest: demand + 0.4 }
            });
            let Outcome { velocity, force } = solve(&free, &gain, &legs, limit);
            assert!((free + gain * force - velocity).amax() < 1e-12);
            for (i, leg) in legs.iter().enumerate() {
                let near = |value: f64| (velocity[i] - value).abs() < 1e-9;
                let (v, f) = (velocity[i], force[i]);
                if near(leg.demand) {
                    assert!(f.abs() <= limit + 1e-9);
                    free_legs += 1;
                } else if near(leg.fastest) {
                    assert!(f <= -limit + 1e-9);
                    stopped += 1;
                } else if near(leg.slowest) {
                    assert!(f >= limit - 1e-9);
                    stopped += 1;
                } else {
                    // Too fast: the drive brakes as hard as it can; too slow: it pushes so.
                    assert!((f + limit * (v - leg.demand).signum()).abs() < 1e-9, "{seed} {i}: {f} at {v}");
                    assert!((leg.slowest..=leg.fastest).contains(&v));
                    saturated += 1;
                }
            }
        }
        assert!(free_legs > 100 && saturated > 100 && stopped > 100, "{free_legs} {saturated} {stopped}");
    }
}
