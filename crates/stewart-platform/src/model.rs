//! The platform as a model with variables, for whoever hosts it.

use moris_interface::{Group, Identity, Model, Reader, Refusal, Row, Slot, Writer};
use moris_interface::{concat_rows, row_count, slot_count, slot_table, with_tunable};

use crate::interface::{Clock, Input, Output, Parameters};
use crate::stewart_platform::{MOST_INTERNAL_STEPS, StewartPlatform};

const GROUPS: &[&[Row]] = &[Clock::ROWS, Input::ROWS, Output::ROWS, Parameters::ROWS];
/// The drives' limits are the rig's, and fixed for the washout, which plans by them.
static ROWS: [Row; row_count(GROUPS)] =
    with_tunable(concat_rows(GROUPS), &["actuator.velocityLimit", "actuator.accelerationLimit"]);
static SLOTS: [Slot; slot_count(&concat_rows::<{ row_count(GROUPS) }>(GROUPS))] =
    slot_table(&concat_rows::<{ row_count(GROUPS) }>(GROUPS));

/// Where the groups begin in the slots.
const INPUT: usize = slot_count(Clock::ROWS);
const OUTPUT: usize = INPUT + slot_count(Input::ROWS);
const PARAMETERS: usize = OUTPUT + slot_count(Output::ROWS);

/// The parameters' rows.
pub fn parameter_rows() -> &'static [Row] {
    &ROWS[ROWS.len() - Parameters::ROWS.len()..]
}

impl Model for StewartPlatform {
    const IDENTITY: Identity = Identity {
        name: "StewartPlatform",
        version: env!("CARGO_PKG_VERSION"),
        text: "Stewart platform with the dynamics of its actuators and of its body: from commanded actuator lengths to the real ones, the forces they carry, and what the rider feels on the real motion.",
        rows: &ROWS,
        slots: &SLOTS,
        main_parameters: &[
            "platform.mass",
            "rider.mass",
            "payload.mass",
            "actuator.bandwidth",
            "actuator.damping",
            "actuator.deadTime",
            "actuator.forceLimit",
            "actuator.velocityLimit",
            "actuator.accelerationLimit",
            "head.height",
        ],
        stop_time: 60.0,
        step_size: 0.001,
    };

    fn start(slots: &mut [f64]) {
        Clock::default().write(&mut Writer::new(slots));
        Input::default().write(&mut Writer::new(&mut slots[INPUT..]));
        Parameters::default().write(&mut Writer::new(&mut slots[PARAMETERS..]));
        if let Ok(platform) = Self::new(&Parameters::default()) {
            platform.outputs(slots);
        }
    }

    fn new(slots: &[f64]) -> Result<Self, Refusal> {
        let input: Input = read(slots, INPUT);
        Ok(StewartPlatform::new(&read(slots, PARAMETERS))?.starting_with(input.lean))
    }

    fn retune(&mut self, slots: &[f64]) -> Result<(), Refusal> {
        StewartPlatform::retune(self, &read(slots, PARAMETERS))
    }

    fn longest_step(&self) -> f64 {
        MOST_INTERNAL_STEPS * self.parameters().setting.max_step
    }

    /// Lengths go on at the slopes that the host gives; at the commanded rates where it gives none.
    fn step(&mut self, slots: &[f64], derivatives: Option<&[f64]>, step: f64) {
        let start: Input = read(slots, INPUT);
        let Some(derivatives) = derivatives else { return StewartPlatform::step(self, &start, step) };
        let slope: Input = read(derivatives, INPUT);
        let end = Input {
            length: std::array::from_fn(|i| {
                let rate = if slope.length[i] != 0.0 { slope.length[i] } else { start.velocity[i] };
                start.length[i] + step * rate
            }),
            velocity: start.velocity,
            lean: start.lean + step * slope.lean,
        };
        self.step_between(&start, &end, step);
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
