//! Steps the washout on an emulated board through the drive in `drive.bin`.
//!
//! For each of several parameter sets it prints a hash of all outputs. `test_board.py` compares
//! them with the PC's.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
extern crate alloc;

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod ride;

#[cfg(not(target_os = "none"))]
fn main() {}
