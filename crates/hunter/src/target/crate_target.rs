//! The washout through the crate.

use anyhow::{Context, Result};
use moris_interface::{Group, Reader, SlotModel};
use moris_washout::{Input, Output, Preview, Washout};

use super::{Inputs, Target};
use crate::episode::Scope;
use crate::oracle::Sample;
use crate::variables::REAL_INPUTS;

/// A washout with what a host keeps beside it.
#[derive(Default)]
pub struct CrateTarget {
    fresh: Option<Washout>,
    washout: Option<Washout>,
    /// By scope.
    saved: [Option<Washout>; 2],
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
        self.saved = [None, None];
    }

    fn set(&mut self, slots: &[f64], _: &[usize]) -> bool {
        self.washout().retune_from(slots).is_ok()
    }

    #[inline]
    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()> {
        let washout = self.washout();
        washout.preview(&preview(start));
        match end {
            None => washout.step(&input(start), step),
            Some(end) => washout.step_between(&input(start), &input(end), step),
        }
        Ok(())
    }

    #[inline]
    fn sample(&mut self, neutral_height: f64) -> Sample {
        sample(&self.washout().output(), neutral_height)
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

/// A preview that has nothing to do with what comes: the inputs in another order, now and then.
#[inline]
fn preview(inputs: &Inputs) -> Preview {
    let reals = &inputs.reals;
    let element = |k: usize| reals[k % REAL_INPUTS] * reals[(k / 3) % REAL_INPUTS];
    Preview {
        count: reals[0].to_bits() as i32 % 30,
        step: reals[1],
        surge: std::array::from_fn(element),
        sway: std::array::from_fn(|k| element(k + 5)),
    }
}

/// The outputs that the oracle knows.
#[inline]
fn sample(output: &Output, neutral_height: f64) -> Sample {
    let mut position: [f64; 3] = output.position.into();
    position[2] -= neutral_height;
    let rest = [
        output.felt_specific_force,
        output.felt_angular_velocity,
        output.orientation.to_vector(),
        [output.tilt_roll, output.tilt_pitch, output.stroke_margin].into(),
        [output.tilt_roll_rate, output.tilt_pitch_rate, 0.0].into(),
        output.position,
        output.velocity,
        output.acceleration,
        output.angular_velocity,
    ];
    let legs = output.length.iter().chain(&output.leg_velocity);
    Sample {
        position,
        velocity: output.velocity.into(),
        acceleration: output.acceleration.into(),
        angular_velocity: output.angular_velocity.into(),
        length: output.length,
        leg_velocity: output.leg_velocity,
        sum: rest.iter().flatten().chain(legs).sum(),
    }
}
