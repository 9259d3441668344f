//! Previews by earlier passes, through the washout and alone.

mod felt;
mod memory;
mod motorcycle;
mod track;
mod trust;
mod wrong;
