//! The classical strategy: the paper's splitter and gravitational strategy, whose
//! high-pass moves the platform.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::coordinated::Circumstances;
use crate::cueing::gravitational::GravitationalStrategy;
use crate::cueing::splitter::LowPass;
use crate::interface::Parameters;
use crate::motion::orientation::RollPitchYaw;

/// The strategy with its state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Classical {
    low_pass: LowPass,
    gravitational: GravitationalStrategy,
}

impl Classical {
    /// At rest at neutral.
    pub fn new(parameters: &Parameters) -> Self {
        let Parameters { splitter, structure, .. } = parameters;
        Classical {
            low_pass: LowPass::new(splitter, structure.splitter_order, structure.low_pass),
            gravitational: GravitationalStrategy::default(),
        }
    }

    /// Takes other parameters.
    pub fn retune(&mut self, parameters: &Parameters) {
        self.low_pass.retune(&parameters.splitter, parameters.structure.splitter_order);
    }

    /// The tilt now.
    pub fn tilt(&self) -> &GravitationalStrategy {
        &self.gravitational
    }

    /// Advances the tilt by `step` seconds, in which the force in the base frame goes linearly from
    /// `start` to `end`. `rotation` is the platform's, as predicted for the step's end.
    ///
    /// The tilt's own part in it is taken as it was the longest step before that. Where the
    /// low-frequency force has a vertical part, a tilt predicted from its present rate would follow
    /// its own motion, from one step to the next in opposite directions.
    pub fn advance_tilt(
        &mut self,
        [start, end]: [Vector3<f64>; 2],
        rotation: &Matrix3<f64>,
        circumstances: &Circumstances,
        step: f64,
    ) {
        let Circumstances { parameters, guard, head, lean, .. } = *circumstances;
        let Parameters { tilt, structure, .. } = parameters;
        let low_frequency = self.low_pass.advance(start, end, step);
        let own_turn = guard.motion().orientation.angular_velocity(self.change_over(structure.max_step, step));
        let force = head.to_location_axes(rotation.tr_mul(&(low_frequency + own_turn.cross(&low_frequency))));
        self.gravitational.advance(force, structure.gravity, lean, tilt, structure.max_step, step);
    }

    /// Change of the tilt over `time` seconds, of which the last `step` are to come and the others
    /// have passed.
    fn change_over(&self, time: f64, step: f64) -> RollPitchYaw {
        let [roll, pitch] = [self.gravitational.roll, self.gravitational.pitch].map(|tilt| {
            let bend = 0.5 * step * tilt.acceleration;
            step * (tilt.velocity + bend) + (time - step) * (tilt.velocity - bend)
        });
        RollPitchYaw::new(roll, pitch, 0.0)
    }
}
