//! The washout's commands to the legs on a recording.

use moris_simulation::Replay;
use moris_washout::interface::StructureParameters;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Parameters, Rig, Washout};

use crate::error::Result;
use crate::message::Message;
use crate::recording::Recording;

/// Longest step from command to command \[s\]. The platform's queue of commands is exact for dead
/// times of less than 28 such steps.
pub const LONGEST_STEP: f64 = 0.002;

/// Commanded legs at equal steps. The washout gets no feedback, so that they are the same for every
/// machine.
#[derive(Clone, Debug)]
pub struct Commands {
    /// Time between commands \[s\].
    pub step: f64,
    /// Commands to a sample of the recording.
    pub divisions: usize,
    /// Lengths of the legs \[m\].
    pub lengths: Vec<[f64; 6]>,
    /// Lean of the rider \[rad\].
    pub leans: Vec<f64>,
    /// Specific force that is felt on the commanded motion \[m/s2\].
    pub felt: Vec<Vector3<f64>>,
    /// Rig of washout and platform.
    pub rig: Rig,
    /// Structure of the washout, with gravity and the point at which the rider feels.
    pub structure: StructureParameters,
}

impl Commands {
    /// Replays a recording in steps of at most `longest` \[s\], with the inputs' slopes.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn of(recording: &Recording, parameters: &Parameters, longest: f64) -> Result<Self> {
        let parameters = recording.parameters(parameters);
        let sample = recording.step();
        // Rounding must not make another step.
        let divisions = (sample / longest - 1e-6).ceil().max(1.0) as usize;
        let step = sample / divisions as f64;
        let replay = Replay::in_steps(&recording.manoeuvre, step, true)
            .ok_or_else(|| Message::from("the samples cannot be divided"))?;
        let inputs = recording.inputs();
        let mut washout = Washout::new(&parameters)?.starting_with(&inputs[0]);
        let (mut lengths, mut felt) = (Vec::new(), Vec::new());
        let mut keep = |washout: &Washout| {
            let output = washout.output();
            lengths.push(output.length);
            felt.push(output.felt_specific_force);
        };
        replay.run_part(0..usize::MAX, &mut washout, |washout, _| keep(washout), |_| (), |_, _| ());
        keep(&washout);
        let lean = |k: usize| {
            let (index, part) = (k / divisions, (k % divisions) as f64 / divisions as f64);
            let next = inputs[(index + 1).min(inputs.len() - 1)].lean;
            inputs[index].lean + part * (next - inputs[index].lean)
        };
        let leans = (0..lengths.len()).map(lean).collect();
        Ok(Commands { step, divisions, lengths, leans, felt, rig: parameters.rig, structure: parameters.structure })
    }
}
