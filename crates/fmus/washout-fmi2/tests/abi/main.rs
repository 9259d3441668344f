//! The washout's shared library, tested as a host sees it.

#[cfg(target_arch = "x86_64")]
mod arithmetic;
#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod derivatives;
mod fixture;
mod forged_states;
mod hunter;
#[cfg(target_os = "linux")]
mod process;
mod real_time;
mod resources;
#[cfg(all(target_os = "linux", target_env = "gnu"))]
mod rounds;
mod steps;
mod threads;
mod values;
mod washout;
