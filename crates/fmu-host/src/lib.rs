//! A host for FMUs for co-simulation of FMI 2.0, and with [`Running`] of FMI 3.0. The host opens
//! them, sets and gets variables, and steps them, as a simulation tool does. Nothing of it depends
//! on the crates that make the FMUs.
//!
//! [`files`] reads what others wrote, FMUs and texts, up to a bound.
//!
//! ```no_run
//! # fn main() -> Result<(), moris_fmu_host::HostError> {
//! let fmu = moris_fmu_host::Fmu::open("MorisWashout.fmu".as_ref())?;
//! let mut washout = fmu.instantiate("washout")?;
//! washout.initialize(&[("tilt.angleLimit", 0.3)], None)?;
//! washout.set("vehicle.speed", 20.0)?;
//! washout.steps(1000, 1e-3)?;
//! println!("{}", washout.get("actuator[1].length")?);
//! # Ok(())
//! # }
//! ```

pub mod api;
mod archive;
mod description;
mod error;
mod example;
pub mod files;
pub mod fmi3;
mod fmu;
mod instance;
mod messages;
mod running;
mod state;

pub use api::{Api, Status};
pub use description::{Causality, Declaration, Variable, VariableKind, variables_of};
pub use error::HostError;
pub use example::example_library;
pub use fmu::Fmu;
pub use instance::Instance;
pub use messages::Message;
pub use running::{Running, Running2, Running3};
pub use state::State;
