//! The classical strategy: the paper's splitter and gravitational strategy, whose
//! high-pass moves the platform.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::cueing::gravitational::GravitationalStrategy;
use crate::cueing::splitter::LowPass;
use crate::interface::Parameters;
use crate::platform::LocationFrame;

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
            low_pass: LowPass::new(splitter, structure.splitter_order, structure.low_pass, structure.max_step),
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
    /// `start` to `end`. `rotation` is the platform's, as predicted for the step's end, `head` that
    /// at the end, and `lean` what the platform makes up for.
    ///
    /// The tilt's own part in it is taken as it was the longest step before that. Where the
    /// low-frequency force has a vertical part, a tilt predicted from its present rate would follow
    /// its own motion, from one step to the next in opposite directions.
    pub fn advance_tilt(
        &mut self,
        [start, end]: [Vector3<f64>; 2],
        rotation: &Matrix3<f64>,
        head: &LocationFrame,
        lean: f64,
        parameters: &Parameters,
        step: f64,
    ) {
        let Parameters { tilt, structure, .. } = parameters;
        let low_frequency = self.low_pass.advance(start, end, step);
        let mut force = rotation.tr_mul(&low_frequency);
        // Turned back by the tilt's change. Only the vertical part couples the tilt to itself.
        let [roll, pitch] = self.change_over(structure.max_step, step);
        force.x += pitch * force.z;
        force.y -= roll * force.z;
        let force = head.to_location_axes(force);
        self.gravitational.advance(force, structure.gravity, lean, tilt, structure.max_step, step);
    }

    /// Change of roll and pitch over `time` seconds, of which the last `step` are to come and the
    /// others have passed.
    fn change_over(&self, time: f64, step: f64) -> [f64; 2] {
        let bend = step * (step - 0.5 * time);
        [self.gravitational.roll, self.gravitational.pitch].map(|tilt| time * tilt.velocity + bend * tilt.acceleration)
    }
}
