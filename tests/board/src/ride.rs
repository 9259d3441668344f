//! The drive, and the sets that make it.

use alloc::format;

use moris_interface::{Group, Writer, slot_count};
use moris_washout::motion::orientation::RollPitchYaw;
use moris_washout::nalgebra::Vector3;
use moris_washout::presets::{self, ADAPTIVE, CLASSICAL, OPTIMAL, PAPER, PREDICTIVE, PREVIEW, ROBUST};
use moris_washout::{Input, Output, Preview, Washout};

use crate::board;

/// Numbers of a row.
pub const COLUMNS: usize = 11;
/// Elements of a preview, and seconds between them.
const PREVIEWED: (usize, f64) = (20, 0.2);
const SETS: [(&str, &str); 7] = [
    ("classical", CLASSICAL),
    ("adaptive", ADAPTIVE),
    ("optimal", OPTIMAL),
    ("robust", ROBUST),
    ("predictive", PREDICTIVE),
    ("preview", PREVIEW),
    ("paper", PAPER),
];

/// A drive, in memory that lasts. A row is specific force, angular velocity, orientation, speed and
/// lean.
pub struct Drive {
    pub step: f64,
    pub rows: &'static [[f64; COLUMNS]],
}

impl Drive {
    fn input(&self, row: usize) -> Input {
        let [fx, fy, fz, wx, wy, wz, roll, pitch, yaw, speed, lean] = self.rows[row];
        Input {
            specific_force: Vector3::new(fx, fy, fz),
            angular_velocity: Vector3::new(wx, wy, wz),
            orientation: RollPitchYaw::new(roll, pitch, yaw),
            speed,
            lean,
            engaged: true,
        }
    }

    /// The force of surge and sway to come.
    fn preview(&self, row: usize) -> Preview {
        let apart = (PREVIEWED.1 / self.step + 0.5) as usize;
        let mut preview = Preview { step: PREVIEWED.1, ..Preview::default() };
        for k in 0..PREVIEWED.0 {
            let Some(ahead) = self.rows.get(row + (k + 1) * apart) else { break };
            (preview.surge[k], preview.sway[k]) = (ahead[0], ahead[1]);
            preview.count = k as i32 + 1;
        }
        preview
    }
}

/// The whole drive with each set.
pub fn ride_all(drive: &Drive) {
    for (name, set) in SETS {
        board::begin();
        let parameters = presets::parameters(set);
        match Washout::new(&parameters) {
            Ok(washout) => ride(name, &mut washout.starting_with(&drive.input(0)), drive),
            Err(error) => board::print(&format!("{name} {error}\n")),
        }
    }
}

fn ride(name: &str, washout: &mut Washout, drive: &Drive) {
    board::made();
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut slots = [0.0; slot_count(Output::ROWS)];
    for row in 0..drive.rows.len() {
        let (input, preview) = (drive.input(row), drive.preview(row));
        board::measured(|| {
            washout.preview(&preview);
            washout.step(&input, drive.step);
        });
        washout.output().write(&mut Writer::new(&mut slots));
        for slot in slots {
            hash = (hash ^ slot.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    board::print(&format!("{name} {hash:016x}\n"));
    board::report(name);
}
