//! Every model through the C functions of both versions of FMI.

#[cfg(target_arch = "x86_64")]
mod arithmetic;
#[path = "../../../../tests/cases/mod.rs"]
mod cases;
mod hostile;
mod library;
mod ranges;
