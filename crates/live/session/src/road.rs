//! The road as it is learned, and the preview by it.

use moris_laps::{Laps, Preview, Sample};
use moris_washout::Washout;

use crate::gliding_source::GlidingSource;
use crate::resampler::Stamped;

/// The road that a vehicle drives.
#[derive(Clone, Debug)]
pub struct Road {
    laps: Laps,
    /// The sample before.
    last: Option<Stamped>,
    /// The washout has a preview.
    is_given: bool,
}

impl Road {
    /// The road that is known so far.
    pub fn new(laps: Laps) -> Self {
        Road { laps, last: None, is_given: false }
    }

    /// What has been learned.
    pub fn laps(&self) -> &Laps {
        &self.laps
    }

    /// Place of the vehicle along x and y, if it is known \[m\].
    pub fn place(&self) -> Option<[f64; 2]> {
        let position = self.last?.position?;
        Some([position.x, position.y])
    }

    /// The next sample has nothing to do with those before.
    pub fn interrupt(&mut self) {
        self.laps.interrupt();
        self.last = None;
    }

    /// All times until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        if let Some(last) = &mut self.last {
            last.time -= time;
        }
    }

    /// Takes the next sample of the vehicle.
    pub fn take(&mut self, sample: &Stamped) {
        let last = self.last.replace(*sample);
        let Some(position) = sample.position else { return self.laps.interrupt() };
        let step = last.map_or(0.0, |last| sample.time - last.time);
        let speed = sample.motion.speed().abs();
        let force = sample.motion.force();
        self.laps.step(&Sample {
            step,
            position: position.into(),
            // A program without a speed sends zero.
            speed: (speed > 0.0).then_some(speed),
            force: [force.x, force.y],
        });
    }

    /// Gives the washout the preview as of the last sample, with what its glide will still add.
    pub fn give(&mut self, washout: &mut Washout, source: &GlidingSource) {
        let mut preview = self.laps.preview();
        for k in 0..preview.count.unsigned_abs() as usize {
            let ahead = source.difference((k + 1) as f64 * preview.step);
            preview.surge[k] += ahead[0];
            preview.sway[k] += ahead[1];
        }
        self.is_given = preview.count > 0;
        washout.preview(&preview);
    }

    /// Takes the preview back, where the washout does not follow the vehicle.
    pub fn take_back(&mut self, washout: &mut Washout) {
        if std::mem::take(&mut self.is_given) {
            washout.preview(&Preview::default());
        }
    }
}
