//! Block (3), direct linear motion: the high-frequency specific force, integrated twice, moves the
//! platform. The safety units keep it inside its limits.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::cueing::safety::SafetyUnits;
use crate::cueing::splitter::high_pass_denominators;
use crate::filter::bumpless::GlidingOffset;
use crate::filter::crossfade::CrossfadedChains;
use crate::interface::{SafetyParameters, SplitterParameters};
use crate::motion::Motion;

/// The linear channel with its state: surge, sway and heave, along x, y and z of the base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectLinearMotion {
    chains: CrossfadedChains,
    /// Correction to the input.
    offset: GlidingOffset<3>,
    safety: SafetyUnits,
}

impl DirectLinearMotion {
    /// At rest at neutral; no step will be longer than `max_step` \[s\].
    pub fn new(parameters: &SplitterParameters, order: i32, max_step: f64) -> Self {
        let chains = CrossfadedChains::of_position(high_pass_denominators(parameters, order), max_step);
        DirectLinearMotion { chains, offset: GlidingOffset::default(), safety: SafetyUnits::new(max_step) }
    }

    /// Changes the filter parameters. Position, velocity and acceleration fade to those of the new
    /// filters.
    ///
    /// The input becomes less by `jump` at the same instant, because of other new parameters.
    pub fn retune(&mut self, parameters: &SplitterParameters, order: i32, jump: Vector3<f64>) {
        self.chains.retune(high_pass_denominators(parameters, order));
        if jump != Vector3::zeros() {
            self.offset.add(&jump);
        }
    }

    /// Advances the filters by `step` seconds while the input goes linearly from `start` to `end`.
    /// Returns the surge, sway and heave from neutral that they demand.
    ///
    /// The input is a force in the base frame.
    pub fn advance_filters(&mut self, [start, end]: [Vector3<f64>; 2], step: f64) -> Motion<Vector3<f64>> {
        let (start, end) = if self.offset.is_over() { (start, end) } else { self.corrected(start, end, step) };
        self.chains.advance(start, end, step);
        self.chains.motion()
    }

    #[cold]
    fn corrected(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) -> (Vector3<f64>, Vector3<f64>) {
        let before = self.offset.values();
        self.offset.advance(step);
        (start + before, end + self.offset.values())
    }

    /// Continues the filters from a motion that is not the one they demanded. What made the
    /// difference acts like an input, and is washed out like one.
    #[cold]
    pub fn continue_filters_from(&mut self, motion: &Motion<Vector3<f64>>) {
        self.chains.set_motion(&motion.position, &motion.velocity);
    }

    /// Surge, sway and heave `step` seconds later that keep the safety limits and come
    /// nearest to the demand.
    pub fn advance_within_limits(
        &mut self,
        demand: &Motion<Vector3<f64>>,
        limits: &SafetyParameters,
        step: f64,
    ) -> &Motion<Vector3<f64>> {
        self.safety.advance(demand, limits, step);
        self.motion()
    }

    /// Continues from the platform's real motion.
    pub fn continue_from(&mut self, real: &Motion<Vector3<f64>>) {
        self.safety.continue_from(real);
    }

    /// Surge, sway and heave now.
    pub fn motion(&self) -> &Motion<Vector3<f64>> {
        self.safety.motion()
    }

    /// True if a safety unit's motion is not the demanded one.
    pub fn deviates(&self) -> bool {
        self.safety.deviates()
    }

    /// Continues from the platform's real motion if the safety units' own is beyond limits
    /// that have become tighter.
    pub fn stay_within(&mut self, limits: &SafetyParameters, real: &Motion<Vector3<f64>>) {
        if self.safety.beyond_limits(limits) {
            self.safety.continue_from(real);
        }
    }

    /// True if a safety unit limited the motion in the last step.
    pub fn limited(&self) -> bool {
        self.safety.limited()
    }
}
