//! A ride as a recording: its measures, and the file that the workbench reads.

use std::fmt::Write as _;

use moris_simulation::measures::comfort::comfort;
use moris_simulation::measures::fidelity::rms_error;
use moris_washout::Input;
use serde::Serialize;

/// Steps of the ride to a sample.
pub const STEPS_PER_SAMPLE: usize = 10;

/// Inputs of the washout, and the motion that the rider felt.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Time between samples \[s\].
    step: f64,
    inputs: Vec<Input>,
    /// Felt force in surge and sway, [`STEPS_PER_SAMPLE`] to a sample \[m/s2\].
    felt: [Vec<f64>; 2],
}

/// Measures of one axis \[m/s2\], as `docs/measures.md` defines them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rating {
    pub rms_error: f64,
    pub shake: f64,
    pub jolt: f64,
    pub peak: f64,
}

impl Recording {
    /// A recording with steps of so many seconds, that begins with this input and felt force.
    pub fn new(step: f64, input: Input, felt: [f64; 2]) -> Self {
        Recording { step: step * STEPS_PER_SAMPLE as f64, inputs: vec![input], felt: felt.map(|felt| vec![felt]) }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.inputs.len()
    }

    /// Adds a step of the ride.
    pub fn push(&mut self, input: &Input, felt: [f64; 2]) {
        // Longest recording [samples]: 20 minutes.
        const MAX_SAMPLES: usize = 120_000;
        if self.inputs.len() == MAX_SAMPLES {
            return;
        }
        for (series, value) in self.felt.iter_mut().zip(felt) {
            series.push(value);
        }
        if self.felt[0].len() % STEPS_PER_SAMPLE == 1 {
            self.inputs.push(*input);
        }
    }

    /// Measures of surge and sway from one sample to another; none for a shorter part than a
    /// second.
    pub fn ratings(&self, from: usize, to: usize) -> Option<[Rating; 2]> {
        let to = to.min(self.inputs.len());
        if ((to.saturating_sub(from)) as f64) * self.step < 1.0 {
            return None;
        }
        let rating = |axis: usize| {
            let desired: Vec<f64> = self.inputs[from..to].iter().map(|input| input.specific_force[axis]).collect();
            let felt = &self.felt[axis][from * STEPS_PER_SAMPLE..=(to - 1) * STEPS_PER_SAMPLE];
            let sampled: Vec<f64> = felt.iter().step_by(STEPS_PER_SAMPLE).copied().collect();
            let [shake, jolt, peak] = comfort(&desired, felt, 0.0, self.step).values();
            Rating { rms_error: rms_error(&desired, &sampled), shake, jolt, peak }
        };
        Some([rating(0), rating(1)])
    }

    /// The recording as a CSV file, with the columns' usual names and units.
    pub fn csv(&self) -> String {
        let mut text = String::from("time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed,lean\n");
        for (k, input) in self.inputs.iter().enumerate() {
            let [force, rate] = [input.specific_force, input.angular_velocity];
            let turn = input.orientation;
            let _ = write!(text, "{:.2}", k as f64 * self.step);
            for value in [force.x, force.y, force.z, rate.x, rate.y, rate.z, turn.roll, turn.pitch, turn.yaw] {
                let _ = write!(text, ",{value:.6}");
            }
            let _ = writeln!(text, ",{:.4},{:.6}", input.speed, input.lean);
        }
        text
    }
}
