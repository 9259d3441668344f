//! The candidates of a step whose demand is not certified: between following the stop plan
//! and pursuing the demand.

use nalgebra::{Vector3, Vector6};

use super::ActuatorGuard;
use crate::interface::SafetyParameters;
use crate::motion::Motion;
use crate::motion::braking_law::{CATCH_UP_FRACTION, Limits};
use crate::platform::stop_plan::StopPlan;
use crate::platform::{Legs, PlatformCoordinates, PlatformState, jacobian};

/// Number of bisections between the plan and the pursuit. Bisection finds the farthest certified
/// candidate to a part in 2^6.
const BISECTION_STEPS: usize = 6;

impl ActuatorGuard {
    /// The certified state nearest to a pursuit of the demand, with its plan, if there is one.
    /// `held_plan` is the stored plan at the step's end. With `homing_fraction`, neutral is pursued
    /// on the straight way there, with this fraction of the speed.
    pub(super) fn nearest(
        &self,
        demand: &PlatformState,
        held_plan: &StopPlan,
        homing_fraction: Option<f64>,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<(PlatformState, StopPlan)> {
        let now = &self.commanded.coordinates;
        let on_plan = held_plan.coordinates();
        let pursued = match homing_fraction {
            Some(fraction) => self.certifier.step_towards_neutral(now, safety, fraction, step),
            None => self.pursued(now, &demand.legs, safety, step),
        };
        farthest_certified(|fraction| {
            let trial = self.certifier.state(on_plan.towards(&pursued, fraction, now, step));
            let plan = match homing_fraction {
                // A part of a certified way home is certified.
                Some(_) => self.certified(&trial, held_plan, safety, step),
                None => self.certified_with_way_home(&trial, held_plan, safety, step),
            }?;
            Some((trial, plan))
        })
    }

    /// The next state on the stored plan; `held_plan` is that plan at the step's end.
    pub(super) fn state_on_plan(&self, held_plan: &StopPlan, step: f64) -> PlatformState {
        let (now, mut next) = (&self.commanded.coordinates, held_plan.coordinates());
        for (after, before) in [(&mut next.linear, &now.linear), (&mut next.angles, &now.angles)] {
            after.acceleration = (after.velocity - before.velocity) / step;
        }
        self.certifier.state(next)
    }

    /// The state that the platform reaches if each leg pursues its target under its own limits, and
    /// surge, sway and heave keep theirs. The state need not be certified.
    fn pursued(
        &self,
        now: &PlatformCoordinates,
        target: &Legs,
        safety: &SafetyParameters,
        step: f64,
    ) -> PlatformCoordinates {
        let rates = Vector6::from(self.each_leg_pursued(target, step));
        // The Jacobian where the platform will be: the legs have to arrive without a jump.
        let ahead = now.coasted(step).motion(self.certifier.neutral_height);
        // Velocity and angular velocity of the platform.
        let twist = jacobian(&self.certifier.geometry, &ahead.pose()).lu().solve(&rates).unwrap_or_else(Vector6::zeros);
        let velocity: Vector3<f64> = twist.fixed_rows::<3>(0).into();
        let rates = ahead.orientation.rates(twist.fixed_rows::<3>(3).into()).to_vector();
        let PlatformCoordinates { linear, angles } = now;
        // If one may not change so much, all change less: the legs would go elsewhere otherwise.
        let change = velocity - linear.velocity;
        let least = Vector3::repeat(f64::MIN_POSITIVE);
        let fraction = (step * safety.acceleration_limit).component_div(&change.abs().sup(&least)).min().min(1.0);
        let velocity = linear.velocity + fraction * change;
        let rates = angles.velocity.lerp(&rates, fraction);
        let max_step = self.pursuit.max_step;
        PlatformCoordinates {
            linear: Motion::from_axes(|k| {
                Limits::safety(safety, k, max_step).at_velocity(&linear.axis(k), velocity[k], step)
            }),
            angles: angles.at_velocity(rates, step),
        }
    }

    /// The rates of the legs if each pursues its target as far as its limits allow \[m/s\].
    fn each_leg_pursued(&self, target: &Legs, step: f64) -> [f64; 6] {
        let legs = &self.commanded.legs;
        core::array::from_fn(|i| {
            let leg = Motion { position: legs.position[i], velocity: legs.velocity[i], acceleration: 0.0 };
            let goal = Motion { position: target.position[i], velocity: target.velocity[i], acceleration: 0.0 };
            self.pursuit.follow(&leg, &goal, CATCH_UP_FRACTION * self.pursuit.acceleration, step).velocity
        })
    }
}

/// The result for the largest fraction of the way from the plan (0) to the pursuit (1)
/// for which there is one.
fn farthest_certified<T>(certified: impl Fn(f64) -> Option<T>) -> Option<T> {
    let mut found = certified(1.0);
    let (mut low, mut high) = (0.0, 1.0);
    if found.is_none() {
        for _ in 0..BISECTION_STEPS {
            let fraction = 0.5 * (low + high);
            match certified(fraction) {
                Some(result) => (low, found) = (fraction, Some(result)),
                None => high = fraction,
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::farthest_certified;

    #[test]
    fn the_farthest_is_found_to_a_part_in_sixty_four() {
        for edge in [0.01, 0.1, 0.33, 0.5, 0.7, 0.99] {
            let found = farthest_certified(|fraction| (fraction <= edge).then_some(fraction)).unwrap_or(0.0);
            assert!(found <= edge && edge - found <= 1.0 / 64.0, "{found}, not {edge}");
        }
        assert_eq!(farthest_certified(Some), Some(1.0));
        assert_eq!(farthest_certified(|_| None::<f64>), None);
    }
}
