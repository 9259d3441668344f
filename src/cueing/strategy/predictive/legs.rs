//! The actuators' lengths along a plan, linearized about the plan before.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::horizon::{BLOCKS, Horizon};
use super::program::Nodes;
use crate::cueing::strategy::law::StepContext;
use crate::interface::{AngularParameters, Parameters, SplitterParameters};
use crate::motion::orientation::{Orientation, RollPitchYaw};
use crate::platform::reach::{neutral_lengths, short_stroke_factor};
use crate::platform::{Geometry, Pose, lengths_with_jacobian};

/// The rig, and the motion of the platform that is not planned.
#[derive(Clone, Copy, Debug)]
pub struct LegContext<'a> {
    pub geometry: &'a Geometry,
    /// Height of the platform's origin at neutral \[m\].
    pub neutral_height: f64,
    /// Shortest and longest length of an actuator \[m\].
    pub stroke: [f64; 2],
    /// Margin of a plan at either end of the stroke \[m\].
    pub margin: f64,
    /// Heave from neutral \[m\] and its velocity \[m/s\].
    pub heave: f64,
    pub heave_velocity: f64,
    /// Bound on heave \[m\].
    pub heave_bound: f64,
    /// Break frequency of heave's high-pass \[rad/s\].
    pub heave_frequency: f64,
    /// Roll, pitch and yaw beside the tilt \[rad\] and their rates \[rad/s\].
    pub angles: Vector3<f64>,
    pub angle_rates: Vector3<f64>,
    /// Break frequencies of the angular channel \[rad/s\].
    pub frequencies: Vector3<f64>,
}

/// A leg's length near a pose, and how it changes with position and tilt of surge and sway.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LegRow {
    /// The length less what the nominal positions and tilts contribute by the slopes \[m\].
    pub offset: f64,
    /// By position, of surge and sway.
    pub by_position: [f64; 2],
    /// By tilt, of surge and sway \[m/rad\].
    pub by_tilt: [f64; 2],
}

impl LegRow {
    /// The length less its offset, at these positions and tilts of surge and sway.
    #[inline(always)]
    pub fn change(&self, position: [f64; 2], tilt: [f64; 2]) -> f64 {
        let LegRow { by_position, by_tilt, .. } = self;
        (by_position[0] * position[0] + by_tilt[0] * tilt[0]) + (by_position[1] * position[1] + by_tilt[1] * tilt[1])
    }

    /// The length in another unit.
    pub fn scaled(&self, scale: f64) -> Self {
        let LegRow { offset, by_position, by_tilt } = *self;
        let [by_position, by_tilt] = [by_position, by_tilt].map(|pair| pair.map(|value| scale * value));
        LegRow { offset: scale * offset, by_position, by_tilt }
    }
}

/// Frequency at which heave returns to neutral, relative to its high-pass's break frequency: it
/// returns more slowly than by itself, since what moves it lasts for a time.
const HEAVE_RETURN: f64 = 0.4;

/// Largest heave beside a plan \[m\]. More would take the legs' stroke from surge and sway.
pub const LARGEST_HEAVE: f64 = 0.1;

impl<'a> LegContext<'a> {
    /// The rig and motion at a step.
    pub fn of(context: &StepContext<'a>) -> Self {
        let StepContext { parameters, guard, angles, .. } = *context;
        let Parameters { rig, predictive, angular, splitter, .. } = parameters;
        let SplitterParameters { omega1, zeta1: _, omega2: _, zeta2: _, low_pass_omega: _, low_pass_zeta: _ } =
            splitter;
        let AngularParameters { omega1: frequencies, zeta1: _, omega2: _, zeta2: _ } = angular;
        let linear = &guard.commanded().coordinates.linear;
        LegContext {
            geometry: guard.geometry(),
            neutral_height: rig.neutral_height,
            stroke: rig.stroke(),
            margin: predictive.leg_margin * short_stroke_factor(rig),
            heave: linear.position.z,
            heave_velocity: linear.velocity.z,
            heave_bound: LARGEST_HEAVE,
            heave_frequency: omega1.z,
            angles: angles.position,
            angle_rates: angles.velocity,
            frequencies: frequencies.to_vector(),
        }
    }

    /// Shortest and longest length of an actuator in a plan \[m\].
    ///
    /// The margin at an end takes at most half the clearance there at neutral.
    /// So neutral is always within these lengths.
    pub fn planned_stroke(&self) -> [f64; 2] {
        let [shortest, longest] = neutral_lengths(self.geometry, self.neutral_height);
        let [min, max] = self.stroke;
        [min + self.margin.min(0.5 * (shortest - min).max(0.0)), max - self.margin.min(0.5 * (max - longest).max(0.0))]
    }

    /// Heave after `time` seconds: it returns to neutral critically damped.
    fn heave_after(&self, time: f64) -> f64 {
        let frequency = HEAVE_RETURN * self.heave_frequency;
        let heave = free_response(self.heave, self.heave_velocity, frequency, time);
        heave.clamp(-self.heave_bound, self.heave_bound)
    }

    /// Roll, pitch and yaw beside the tilt after `time` seconds, if the vehicle goes
    /// on turning as it does.
    ///
    /// The angles are the free response of a second-order high-pass with damping 1, which stands
    /// for the angular channel's other filters too.
    fn angles_after(&self, time: f64) -> Vector3<f64> {
        Vector3::from_fn(|k, _| free_response(self.angles[k], self.angle_rates[k], self.frequencies[k], time))
    }
}

/// Value after `time` seconds of a critically damped return to zero.
fn free_response(value: f64, rate: f64, frequency: f64, time: f64) -> f64 {
    (value + (rate + frequency * value) * time) * libm::exp(-frequency * time)
}

/// The legs at each node of a plan for surge and sway, near the poses of the plan before.
pub fn leg_rows(leg_context: &LegContext, plan: &[Nodes; 2], horizon: Horizon) -> [[LegRow; 6]; BLOCKS] {
    let ends = horizon.ends();
    core::array::from_fn(|node| {
        let heave = leg_context.heave_after(ends[node]);
        let states = plan.each_ref().map(|axis| axis.at(node));
        let (position, tilt) = (states.map(|axis| axis.position), states.map(|axis| axis.tilt));
        legs_near(leg_context, &leg_context.angles_after(ends[node]), position, tilt, heave)
    })
}

fn legs_near(
    leg_context: &LegContext,
    angles: &Vector3<f64>,
    position: [f64; 2],
    tilt: [f64; 2],
    heave: f64,
) -> [LegRow; 6] {
    let LegContext { geometry, neutral_height, .. } = *leg_context;
    let orientation = Orientation::new(RollPitchYaw::new(angles.x + tilt[1], angles.y - tilt[0], angles.z));
    let pose = Pose { position: Vector3::new(position[0], position[1], neutral_height + heave), orientation };
    let (lengths, jacobian) = lengths_with_jacobian(geometry, &pose);
    // A surge's tilt is a pitch nose up.
    let about = [RollPitchYaw::new(0.0, -1.0, 0.0), RollPitchYaw::new(1.0, 0.0, 0.0)]
        .map(|rates| orientation.angular_velocity(rates));
    core::array::from_fn(|leg| {
        let turning = Vector3::new(jacobian[(leg, 3)], jacobian[(leg, 4)], jacobian[(leg, 5)]);
        let by_position = [jacobian[(leg, 0)], jacobian[(leg, 1)]];
        let by_tilt = about.map(|axis| turning.dot(&axis));
        let nominal: f64 = (0..2).map(|k| by_position[k] * position[k] + by_tilt[k] * tilt[k]).sum();
        LegRow { offset: lengths[leg] - nominal, by_position, by_tilt }
    })
}

#[cfg(test)]
pub(super) mod tests {
    use nalgebra::SVector;

    use super::*;
    use crate::interface::Rig;
    use crate::platform::leg_lengths;

    /// The default rig's, with a platform that only the plan moves.
    pub fn leg_context(geometry: &Geometry) -> LegContext<'_> {
        let rig = Rig::default();
        LegContext {
            geometry,
            neutral_height: rig.neutral_height,
            stroke: [rig.min_length, rig.max_length],
            margin: 0.0,
            heave: 0.0,
            heave_velocity: 0.0,
            heave_bound: LARGEST_HEAVE,
            heave_frequency: 5.0,
            angles: Vector3::zeros(),
            angle_rates: Vector3::zeros(),
            frequencies: Vector3::repeat(1.0),
        }
    }

    /// A leg's length by its row \[m\].
    pub fn length(row: &LegRow, position: [f64; 2], tilt: [f64; 2]) -> f64 {
        row.offset + (0..2).map(|k| row.by_position[k] * position[k] + row.by_tilt[k] * tilt[k]).sum::<f64>()
    }

    #[test]
    fn angles_go_on_as_the_high_pass_lets_them_while_the_vehicle_turns_steadily() {
        let geometry = Geometry::from(&Rig::default());
        let leg_context = LegContext {
            angles: Vector3::new(0.05, -0.04, 0.1),
            angle_rates: Vector3::new(0.2, 0.0, -0.3),
            frequencies: Vector3::new(0.9, 0.6, 1.0),
            ..leg_context(&geometry)
        };
        // y'' + 2 w y' + w^2 y = 0, by small steps of the midpoint rule.
        let (mut angles, mut rates) = (leg_context.angles, leg_context.angle_rates);
        let w = leg_context.frequencies;
        let acceleration = |angles: &Vector3<f64>, rates: &Vector3<f64>| {
            -(2.0 * w.component_mul(rates) + w.component_mul(&w).component_mul(angles))
        };
        let (steps, time) = (20_000, 2.0);
        let step = time / f64::from(steps);
        for _ in 0..steps {
            let middle_rates = rates + 0.5 * step * acceleration(&angles, &rates);
            let middle_angles = angles + 0.5 * step * rates;
            angles += step * middle_rates;
            rates += step * acceleration(&middle_angles, &middle_rates);
        }
        assert!((leg_context.angles_after(time) - angles).amax() < 1e-8);
    }

    #[test]
    fn slopes_are_those_of_finite_differences() {
        let geometry = Geometry::from(&Rig::default());
        let leg_context = LegContext { heave: 0.03, angles: Vector3::new(0.05, -0.04, 0.1), ..leg_context(&geometry) };
        let (position, tilt) = ([0.1, -0.2], [0.15, -0.1]);
        let length = |position: [f64; 2], tilt: [f64; 2], leg: usize| {
            length(&legs_near(&leg_context, &leg_context.angles, position, tilt, 0.03)[leg], position, tilt)
        };
        let step = 1e-5;
        for (leg, row) in legs_near(&leg_context, &leg_context.angles, position, tilt, 0.03).iter().enumerate() {
            for axis in 0..2 {
                let moved = |values: [f64; 2], by: f64| {
                    let mut moved = values;
                    moved[axis] += by;
                    moved
                };
                let by_position = (length(moved(position, step), tilt, leg)
                    - length(moved(position, -step), tilt, leg))
                    / (2.0 * step);
                let by_tilt = (length(position, moved(tilt, step), leg) - length(position, moved(tilt, -step), leg))
                    / (2.0 * step);
                assert!((by_position - row.by_position[axis]).abs() < 1e-8);
                assert!((by_tilt - row.by_tilt[axis]).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn rows_are_about_the_plan_before_while_heave_and_turns_fade() {
        let rig = Rig::default();
        let geometry = Geometry::from(&rig);
        let leg_context = LegContext {
            heave: 0.05,
            heave_velocity: -0.2,
            angles: Vector3::new(0.05, -0.04, 0.1),
            angle_rates: Vector3::new(0.2, 0.1, -0.3),
            frequencies: Vector3::new(0.9, 0.6, 1.0),
            ..leg_context(&geometry)
        };
        let plan = [0.1, -0.07].map(|start| Nodes(SVector::from_fn(|k, _| start * (1.0 + 0.1 * k as f64))));
        for horizon in [Horizon::Near, Horizon::Far] {
            let rows = leg_rows(&leg_context, &plan, horizon);
            for (node, end) in horizon.ends().into_iter().enumerate() {
                // Critically damped at 0.4 times 5 rad/s.
                let heave = (0.05 + (-0.2 + 2.0 * 0.05) * end) * (-2.0 * end).exp();
                let angles = leg_context.angles_after(end);
                let states = plan.map(|axis| axis.at(node));
                let (position, tilt) = (states.map(|axis| axis.position), states.map(|axis| axis.tilt));
                let pose = Pose {
                    position: Vector3::new(position[0], position[1], rig.neutral_height + heave),
                    orientation: Orientation::new(RollPitchYaw::new(angles.x + tilt[1], angles.y - tilt[0], angles.z)),
                };
                for (row, length) in rows[node].iter().zip(leg_lengths(&geometry, &pose)) {
                    let slopes: f64 = (0..2).map(|k| row.by_position[k] * position[k] + row.by_tilt[k] * tilt[k]).sum();
                    assert!((row.offset + slopes - length).abs() < 1e-12, "node {node}");
                }
            }
        }
    }

    #[test]
    fn heave_is_expected_within_its_bound() {
        let geometry = Geometry::from(&Rig::default());
        for sign in [1.0, -1.0] {
            let fast = LegContext { heave_velocity: sign * 2.0, ..leg_context(&geometry) };
            assert_eq!(fast.heave_after(0.4), sign * 0.1);
        }
    }

    #[test]
    fn a_margin_leaves_half_the_clearance_at_neutral() {
        let rig = Rig::default();
        let geometry = Geometry::from(&rig);
        let neutral = leg_context(&geometry);
        let rest = length(&legs_near(&neutral, &Vector3::zeros(), [0.0; 2], [0.0; 2], 0.0)[0], [0.0; 2], [0.0; 2]);
        for (below, above, margin, kept) in
            [(0.2, 0.3, 0.015, [0.015, 0.015]), (0.01, 0.3, 0.015, [0.005, 0.015]), (0.2, 0.0, 0.5, [0.1, 0.0])]
        {
            let leg_context = LegContext { stroke: [rest - below, rest + above], margin, ..neutral };
            let [min, max] = leg_context.planned_stroke();
            assert!((min - (rest - below + kept[0])).abs() < 1e-9 && (max - (rest + above - kept[1])).abs() < 1e-9);
            assert!((min..=max).contains(&rest) || (rest - max).abs() < 1e-9);
        }
    }
}
