//! The drive, and the sets that make it.

use alloc::format;
use core::ffi::{CStr, c_char};

use moris_board::{OUTPUT_COUNT, moris_create, moris_preview, moris_read, moris_step};
use moris_interface::slots_of;
use moris_washout::motion::orientation::RollPitchYaw;
use moris_washout::nalgebra::Vector3;
use moris_washout::presets::{self, ADAPTIVE, CLASSICAL, OPTIMAL, PAPER, PREVIEW, ROBUST};
use moris_washout::{Input, Preview, Washout};

use crate::board;

/// Numbers of a row.
pub const COLUMNS: usize = 11;
/// Elements of a preview, and seconds between them: the end of the drive is previewed alone.
const PREVIEWED: (usize, f64) = (20, 0.2);
/// Rows that are driven once more, from a state that was saved.
const REPEATED_ROWS: usize = 50;
/// The set that is given previews.
const PREVIEWED_SET: &str = "preview";
const SETS: [(&str, &str); 7] = [
    ("classical", CLASSICAL),
    ("adaptive", ADAPTIVE),
    ("optimal", OPTIMAL),
    ("robust", ROBUST),
    ("default", ""),
    (PREVIEWED_SET, PREVIEW),
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

    /// Rows from one element of a preview to the next.
    fn rows_apart(&self) -> usize {
        (PREVIEWED.1 / self.step + 0.5) as usize
    }

    /// The force of surge and sway to come.
    fn preview(&self, row: usize) -> Preview {
        let apart = self.rows_apart();
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
        board::open_heap();
        let parameters = slots_of(&presets::parameters(set));
        let mut message = [0; 160];
        let (text, size) = (message.as_mut_ptr(), message.len());
        let washout = board::create(|buffer, buffer_size| {
            // SAFETY: the pointers are those of the buffer, the vector and the array.
            unsafe { moris_create(buffer, buffer_size, parameters.as_ptr(), parameters.len(), text, size) }
        });
        board::open_heap();
        if washout.is_null() {
            board::print(&format!("# {name}: {}\n", text_of(&message)));
        } else {
            ride(name, washout, drive);
        }
    }
}

fn text_of(message: &[c_char]) -> &str {
    // SAFETY: it is as long as the slice.
    let bytes = unsafe { core::slice::from_raw_parts(message.as_ptr().cast(), message.len()) };
    CStr::from_bytes_until_nul(bytes).ok().and_then(|text| text.to_str().ok()).unwrap_or_default()
}

fn ride(name: &str, washout: *mut Washout, drive: &Drive) {
    // SAFETY: the washout has just been made, and is moved within its place.
    unsafe { washout.write(washout.read().starting_with(&drive.input(0))) };
    board::fill_stack();
    let until = drive.rows.len() - PREVIEWED.0 * drive.rows_apart();
    let saved_at = until - REPEATED_ROWS;
    let hash_of_rows = |rows, hash| hash_of_rows(washout, drive, name == PREVIEWED_SET, rows, hash);
    let before = hash_of_rows(0..saved_at, 0xcbf2_9ce4_8422_2325);
    let saved = board::saved_buffer();
    let hash = hash_of_rows(saved_at..until, before);
    board::print(&format!("{name} {hash:016x}\n"));
    board::report(name);
    board::restore_buffer(&saved);
    if hash_of_rows(saved_at..until, before) != hash {
        board::print("restored differently\n");
    }
}

/// Continues a hash with all outputs at these rows.
fn hash_of_rows(
    washout: *mut Washout,
    drive: &Drive,
    is_previewed: bool,
    rows: core::ops::Range<usize>,
    mut hash: u64,
) -> u64 {
    let mut output = [0.0; OUTPUT_COUNT];
    for row in rows {
        let preview = if is_previewed { drive.preview(row) } else { Preview::default() };
        let (input, preview) = (slots_of(&drive.input(row)), slots_of(&preview));
        board::measured(|| {
            // SAFETY: the washout is there, and the arrays are as long as their groups.
            unsafe {
                moris_preview(washout, preview.as_ptr());
                moris_step(washout, input.as_ptr(), drive.step);
            }
        });
        // SAFETY: as above.
        unsafe { moris_read(washout, output.as_mut_ptr()) };
        for value in output {
            hash = (hash ^ value.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    hash
}
