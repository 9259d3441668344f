//! The washout beside a running vehicle.
//!
//! Telemetry and the commands of the operator go in, actuator lengths come out, a step a
//! millisecond. There is no clock, no socket, no file and no thread here. A [`Session`] that
//! receives the same events at the same steps computes the same bits.
//!
//! | module | contents |
//! |---|---|
//! | [`transitions`] | states, events and the table of transitions |
//! | [`session`] | the whole: events in, commands out, one step |
//! | [`source`] | health of the telemetry: pause, silence, bad samples, teleports |
//! | [`clock`] | time of a sample from its packet's clock or its arrival |
//! | [`clock_pace`] | how fast a packet's clock runs beside the arrivals |
//! | [`standing`] | pauses in which a source sends on |
//! | [`attitude`] | attitudes compared as rotations |
//! | [`spikes`] | samples that no vehicle causes |
//! | [`gaps`] | times between samples, from which the delay follows |
//! | [`resampler`] | linear interpolation of irregular samples, with a delay |
//! | [`road`] | the road as it is learned, and the preview by it |
//! | [`gliding_source`] | change of the washout's source without a jump |
//! | [`legs`] | where the legs are before they follow commands |
//! | [`travel`] | the way between the settled pose and neutral |
//! | [`tuning`] | parameters that are chosen in motion |
//! | [`signs`] | test of the telemetry's signs |
//! | [`table_check`] | test of its units, axes and gravity |
//! | [`relation`] | how two signals go together |
//! | [`format`](mod@format) | packets of telemetry, described by tables |
//! | [`moog`] | the motion base MOOG 6DOF2000E |
//! | [`frame`] | frames to actuators, described by templates |
//! | [`log`] | text of a recorded session |
//!
//! ```
//! use moris_live::{Event, Motion, Sample, Session, Settings, State};
//! use moris_washout::Parameters;
//!
//! let mut session = Session::new(&Parameters::default(), &Settings::default())?;
//! session.handle(Event::Start)?;
//! for step in 0..10_000 {
//!     if step % 10 == 0 {
//!         let sample = Sample { motion: Motion::at_rest(), ..Sample::default() };
//!         session.receive(session.time(), &sample);
//!     }
//!     session.step();
//! }
//! assert_eq!(session.state(), State::Neutral);
//! session.handle(Event::Engage)?;
//! assert_eq!(session.state(), State::Engaging);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

pub mod attitude;
pub mod clock;
pub mod clock_pace;
pub mod format;
pub mod frame;
pub mod gaps;
pub mod gliding_source;
pub mod legs;
pub mod log;
pub mod moog;
pub mod motion;
pub mod relation;
pub mod resampler;
pub mod road;
pub mod session;
pub mod signs;
pub mod source;
pub mod spikes;
pub mod standing;
pub mod table_check;
mod tables;
pub mod transitions;
pub mod travel;
pub mod tuning;

pub use legs::Legs;
pub use motion::{Motion, Sample};
pub use session::{Commands, Refusal, STEP, Session, Settings, TelemetryFault};
pub use tables::shipped;
pub use transitions::{Event, State};
