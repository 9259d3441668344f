//! Rig files and parameter files: one binary for both, which is linked once.

mod parameter_files;
mod rig_files;
mod rigs_of_all_sizes;
