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
    /// `start` to `end`. `rotation` and `head` are those at the step's end, and `lean` is what the
    /// platform makes up for.
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
        let low_frequency = head.to_location_axes(rotation.tr_mul(&low_frequency));
        self.gravitational.advance(low_frequency, structure.gravity, lean, tilt, structure.max_step, step);
    }
}
