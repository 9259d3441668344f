//! The washout through the crate.

use anyhow::{Context, Result};
use moris_interface::{Group, Reader, SlotModel};
use moris_washout::{Input, Output, Preview, Washout};

use super::{Inputs, Target};
use crate::hunter::episode::{SCOPES, Scope};
use crate::hunter::oracle::{Derivative, Sample};
use crate::hunter::variables::REAL_INPUTS;

/// A washout with what a host keeps beside it.
#[derive(Default)]
pub struct CrateTarget {
    fresh: Option<Washout>,
    washout: Option<Washout>,
    /// By scope.
    saved: [Option<Washout>; SCOPES],
}

impl CrateTarget {
    fn washout(&mut self) -> &mut Washout {
        self.washout.as_mut().expect("a machine is made before it is driven")
    }
}

impl Target for CrateTarget {
    fn make(&mut self, slots: &[f64]) -> Result<()> {
        self.fresh = Some(Washout::from_slots(slots)?);
        self.rewind();
        Ok(())
    }

    fn rewind(&mut self) {
        self.washout.clone_from(&self.fresh);
        self.saved = Default::default();
    }

    fn set(&mut self, slots: &[f64], _: &[usize]) -> bool {
        self.washout().retune_from(slots).is_ok()
    }

    fn preview(&mut self, preview: &Preview) {
        self.washout().preview(preview);
    }

    #[inline]
    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()> {
        let washout = self.washout();
        match end {
            None => washout.step(&input(start), step),
            Some(end) => washout.step_between(&input(start), &input(end), step),
        }
        Ok(())
    }

    #[inline]
    fn sample(&mut self, neutral_height: f64) -> Sample {
        let washout = self.washout();
        sample(&washout.output(), &washout.output_derivative(), neutral_height)
    }

    fn save(&mut self, scope: Scope) -> Result<()> {
        self.saved[scope as usize].clone_from(&self.washout);
        Ok(())
    }

    fn restore(&mut self, scope: Scope) -> Result<()> {
        let saved = &self.saved[scope as usize];
        saved.as_ref().context("no state has been saved")?;
        self.washout.clone_from(saved);
        Ok(())
    }
}

/// The inputs as the crate has them.
#[inline]
fn input(inputs: &Inputs) -> Input {
    let mut slots = [0.0; REAL_INPUTS + 1];
    slots[..REAL_INPUTS].copy_from_slice(&inputs.reals);
    slots[REAL_INPUTS] = f64::from(inputs.engaged);
    Input::read(&mut Reader::new(&slots))
}

/// The outputs that the oracle knows.
#[inline]
fn sample(output: &Output, derivative: &Output, neutral_height: f64) -> Sample {
    let mut position: [f64; 3] = output.position.into();
    position[2] -= neutral_height;
    Sample {
        position,
        velocity: output.velocity.into(),
        acceleration: output.acceleration.into(),
        angular_velocity: output.angular_velocity.into(),
        length: output.length,
        leg_velocity: output.leg_velocity,
        derivative: Derivative {
            position: derivative.position.into(),
            velocity: derivative.velocity.into(),
            orientation: derivative.orientation.to_vector().into(),
            length: derivative.length,
            leg_velocity: derivative.leg_velocity,
        },
        sum: sum(output) + sum(derivative),
    }
}

/// The sum of all real outputs.
#[inline]
fn sum(output: &Output) -> f64 {
    let vectors = [
        output.felt_specific_force,
        output.felt_angular_velocity,
        output.orientation.to_vector(),
        [output.tilt_roll, output.tilt_pitch, output.stroke_margin].into(),
        [output.tilt_roll_rate, output.tilt_pitch_rate, output.plan_age].into(),
        output.position,
        output.velocity,
        output.acceleration,
        output.angular_velocity,
    ];
    let legs = output.length.iter().chain(&output.leg_velocity);
    vectors.iter().flatten().chain(legs).sum()
}
