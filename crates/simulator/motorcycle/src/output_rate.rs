//! The outputs' time derivatives, as hosts ask for them.

use moris_interface::{Group, Reader, Writer, slot_count};

use crate::interface::Output;

type Values = [f64; slot_count(Output::ROWS)];

/// The mean rate of the outputs while they went from one to another in `step` seconds; false for
/// those that are true or false, and zero for counts.
pub fn mean_rate(before: &Output, after: &Output, step: f64) -> Output {
    let (before, after) = (output_values(before), output_values(after));
    let rate: Values = std::array::from_fn(|k| (after[k] - before[k]) / step);
    without_flags(&rate)
}

/// The rate of outputs that stay.
pub fn rest_rate() -> Output {
    without_flags(&[0.0; slot_count(Output::ROWS)])
}

fn output_values(output: &Output) -> Values {
    let mut values = [0.0; slot_count(Output::ROWS)];
    output.write(&mut Writer::new(&mut values));
    values
}

fn without_flags(rate: &Values) -> Output {
    Output {
        friction_limited: false,
        wheel_lift_limited: false,
        grip_limited: false,
        off_path: false,
        fallen: false,
        preview_count: 0,
        ..Output::read(&mut Reader::new(rate))
    }
}
