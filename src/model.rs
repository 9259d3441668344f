//! The washout as a model with variables, for whoever hosts it.

use moris_interface::{Group, Identity, Model, Reader, Refusal, Row, Slot, Writer};
use moris_interface::{concat_rows, row_count, slot_count, slot_table};

use crate::interface::{Clock, Input, Output, Parameters};
use crate::washout::{MOST_INTERNAL_STEPS, Washout};

const GROUPS: &[&[Row]] = &[Clock::ROWS, Input::ROWS, Output::ROWS, Parameters::ROWS];
static ROWS: [Row; row_count(GROUPS)] = concat_rows(GROUPS);
static SLOTS: [Slot; slot_count(&concat_rows::<{ row_count(GROUPS) }>(GROUPS))] =
    slot_table(&concat_rows::<{ row_count(GROUPS) }>(GROUPS));

/// Where the groups begin in the slots.
const INPUT: usize = slot_count(Clock::ROWS);
const OUTPUT: usize = INPUT + slot_count(Input::ROWS);
const PARAMETERS: usize = OUTPUT + slot_count(Output::ROWS);

impl Model for Washout {
    const IDENTITY: Identity = Identity {
        name: "MorisWashout",
        version: env!("CARGO_PKG_VERSION"),
        text: "Washout filter of the MORIS motorcycle simulator with the kinematics of its Stewart platform: from the specific force and angular velocity of a vehicle's rider to the motion of a platform and its six actuators.",
        rows: &ROWS,
        slots: &SLOTS,
        main_parameters: &[
            "scale.specificForce.@",
            "scale.angularVelocity.@",
            "splitter.@.omega1",
            "splitter.@.omega2",
            "angular.@.omega1",
            "angular.@.omega2",
            "tilt.rateLimit",
            "tilt.angleLimit",
            "safety.@.positionLimit",
            "head.height",
        ],
        stop_time: 60.0,
        step_size: 0.001,
    };

    fn start(slots: &mut [f64]) {
        Clock::default().write(&mut Writer::new(slots));
        Input::default().write(&mut Writer::new(&mut slots[INPUT..]));
        Parameters::default().write(&mut Writer::new(&mut slots[PARAMETERS..]));
        if let Ok(washout) = Self::new(&Parameters::default()) {
            washout.outputs(slots);
        }
    }

    fn new(slots: &[f64]) -> Result<Self, Refusal> {
        let washout = Washout::new(&parameters_in(slots))?;
        Ok(washout.starting_with(&read(slots, INPUT)))
    }

    fn retune(&mut self, slots: &[f64]) -> Result<(), Refusal> {
        Washout::retune(self, &parameters_in(slots))
    }

    fn longest_step(&self) -> f64 {
        MOST_INTERNAL_STEPS * self.parameters().structure.max_step
    }

    fn step(&mut self, slots: &[f64], derivatives: Option<&[f64]>, step: f64) {
        let start: Input = read(slots, INPUT);
        let Some(derivatives) = derivatives else { return Washout::step(self, &start, step) };
        let mut at_end = [0.0; OUTPUT - INPUT];
        for (k, value) in at_end.iter_mut().enumerate() {
            *value = slots[INPUT + k] + step * derivatives[INPUT + k];
        }
        self.step_between(&start, &read(&at_end, 0), step);
    }

    fn outputs(&self, slots: &mut [f64]) {
        self.output().write(&mut Writer::new(&mut slots[OUTPUT..]));
    }

    fn output_derivatives(&self, slots: &mut [f64]) {
        self.output_derivative().write(&mut Writer::new(&mut slots[OUTPUT..]));
    }
}

/// The group that begins at this slot.
fn read<G: Group>(slots: &[f64], begin: usize) -> G {
    G::read(&mut Reader::new(&slots[begin..]))
}

/// The parameters in a model's slots.
pub(crate) fn parameters_in(slots: &[f64]) -> Parameters {
    read(slots, PARAMETERS)
}
