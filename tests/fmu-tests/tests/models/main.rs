//! Every model through the C functions of both versions of FMI.

#[cfg(target_arch = "x86_64")]
mod arithmetic;
mod hostile;
mod library;
mod ranges;
