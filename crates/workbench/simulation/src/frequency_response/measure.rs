//! Steps the washout through a sine until it has settled, and reads off what is felt of it.

use std::f64::consts::TAU;

use moris_washout::nalgebra::Complex;
use moris_washout::{Output, Washout};

use super::channel::{CHANNEL_COUNT, Channel, felt, unit_in_si};
use super::excitation::Sine;

/// Result of one test: one input channel at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    pub input: Channel,
    /// Angular frequency \[rad/s\].
    pub frequency: f64,
    /// Amplitude of the input \[m/s2 or rad/s\].
    pub amplitude: f64,
    /// Felt amplitude of each channel over the input's, in SI units.
    pub ratios: [Complex<f64>; CHANNEL_COUNT],
    /// Of each channel: what it holds beside the input's frequency and its mean, as a fraction of
    /// what it holds at that frequency (root mean squares). A linear filter has none.
    pub distortion: [f64; CHANNEL_COUNT],
    /// Fraction of time in which the tilt, a safety unit, the actuator guard limited.
    pub limited: [f64; 3],
    /// True if two successive windows agree within 1 %.
    pub settled: bool,
}

/// A filter at its limits need not repeat itself from period to period. Up to this fraction of the
/// input that is no matter.
pub const SETTLED_FRACTION: f64 = 1e-2;

/// Measures the response of a washout to a channel at a frequency, from where the washout is: at
/// rest at neutral. One washout serves all tests, so that its rig is surveyed once.
pub fn response(at_rest: &Washout, channel: Channel, frequency: f64, amplitude: f64, gravity_turns: bool) -> Response {
    response_on(|commanded, _| felt(commanded), at_rest, channel, frequency, amplitude, gravity_turns)
}

/// As [`response()`], on a platform that is at rest at neutral. `felt` moves it to the commands at
/// the end of a step \[s\], and has what is felt there in the order of the channels.
pub fn response_on(
    felt: impl FnMut(&Output, f64) -> [f64; CHANNEL_COUNT],
    at_rest: &Washout,
    channel: Channel,
    frequency: f64,
    amplitude: f64,
    gravity_turns: bool,
) -> Response {
    // Longest wait for blocks that agree [s], unless there are fewer than `FEWEST_BLOCKS`.
    const LONGEST_WAIT: f64 = 300.0;
    const FEWEST_BLOCKS: usize = 4;
    // A block of whole periods is at least so long [s].
    const SHORTEST_BLOCK: f64 = 10.0;
    // No further block is needed when the last two differ in what is felt by less than this
    // fraction of the input, 1 °/s counting as much as 1 m/s2.
    const BLOCK_AGREEMENT: f64 = 1e-4;
    let period = TAU / frequency;
    let periods = (SHORTEST_BLOCK / period).ceil();
    let fade = periods * period;
    let sine = Sine { channel, amplitude, frequency, fade, gravity_turns, parameters: at_rest.parameters() };
    let mut walk = SteadyStateRun::new(felt, at_rest, sine, periods);
    walk.block(); // It fades in.
    let mut last = walk.block();
    let blocks = ((LONGEST_WAIT / fade) as usize).max(FEWEST_BLOCKS);
    let mut change = f64::INFINITY;
    for _ in 0..blocks {
        let block = walk.block();
        change = block.difference(&last) / (amplitude / unit_in_si(channel));
        last = block;
        if change <= BLOCK_AGREEMENT {
            break;
        }
    }
    last.response(&sine, change <= SETTLED_FRACTION)
}

/// The washout on its way through the sine.
struct SteadyStateRun<'a, F> {
    felt: F,
    sine: Sine<'a>,
    washout: Washout,
    /// Samples in a block, and the time between them.
    samples: usize,
    step: f64,
    /// Steps made.
    made: usize,
}

impl<'a, F: FnMut(&Output, f64) -> [f64; CHANNEL_COUNT]> SteadyStateRun<'a, F> {
    fn new(felt: F, at_rest: &Washout, sine: Sine<'a>, periods: f64) -> Self {
        // Longest time between samples [s].
        const LONGEST_STEP: f64 = 0.001;
        let block = periods * TAU / sine.frequency;
        let samples = (block / LONGEST_STEP).ceil();
        let washout = at_rest.clone().starting_with(&sine.input(0.0));
        SteadyStateRun { felt, sine, washout, samples: samples as usize, step: block / samples, made: 0 }
    }

    /// Goes on for a block of whole periods.
    fn block(&mut self) -> Block {
        let mut block = Block::default();
        let mut before = self.sine.input(self.made as f64 * self.step);
        for _ in 0..self.samples {
            self.made += 1;
            let time = self.made as f64 * self.step;
            let input = self.sine.input(time);
            self.washout.step_between(&before, &input, self.step);
            before = input;
            let output = self.washout.output();
            let flags = [output.tilt_limited, output.safety_active, output.actuator_limited];
            let turn = Complex::from_polar(1.0, -self.sine.frequency * time);
            let felt = (self.felt)(&output, self.step);
            block.add(turn, self.sine.value(time), felt, flags);
        }
        block
    }
}

/// Sums over a block, from which its Fourier coefficients come.
#[derive(Clone, Debug, Default)]
struct Block {
    samples: f64,
    input: Complex<f64>,
    outputs: [Complex<f64>; CHANNEL_COUNT],
    sums: [f64; CHANNEL_COUNT],
    squares: [f64; CHANNEL_COUNT],
    limited: [f64; 3],
}

impl Block {
    fn add(&mut self, turn: Complex<f64>, input: f64, outputs: [f64; CHANNEL_COUNT], flags: [bool; 3]) {
        self.samples += 1.0;
        self.input += turn * input;
        for (i, value) in outputs.into_iter().enumerate() {
            self.outputs[i] += turn * value;
            self.sums[i] += value;
            self.squares[i] += value * value;
        }
        for (count, flag) in self.limited.iter_mut().zip(flags) {
            *count += f64::from(flag);
        }
    }

    /// The largest difference between an output's amplitude here and in another block, in
    /// the channel's own unit.
    fn difference(&self, other: &Block) -> f64 {
        let of = |&channel: &Channel| {
            let i = channel as usize;
            2.0 * (self.outputs[i] - other.outputs[i]).norm() / self.samples / unit_in_si(channel)
        };
        Channel::ALL.iter().map(of).fold(0.0, f64::max)
    }

    fn response(&self, sine: &Sine, settled: bool) -> Response {
        Response {
            input: sine.channel,
            frequency: sine.frequency,
            amplitude: sine.amplitude,
            ratios: self.outputs.map(|output| output / self.input),
            distortion: std::array::from_fn(|i| self.distortion(i)),
            limited: self.limited.map(|count| count / self.samples),
            settled,
        }
    }

    fn distortion(&self, i: usize) -> f64 {
        let mean = self.sums[i] / self.samples;
        let power = self.squares[i] / self.samples - mean * mean;
        let fundamental = 2.0 * (self.outputs[i] / self.samples).norm_sqr();
        ((power - fundamental).max(0.0) / fundamental).sqrt()
    }
}
