//! The page: shows the session in a browser, and takes commands and parameters from it.
//!
//! - `http` reads requests, bounded, and checks where they come from.
//! - `snapshot` is what the loop passes on, and the messages made of it.
//! - `control_broker` knows who controls, and checks what is asked.
//! - `track` has the road that is known at first.
//! - `server` answers requests, each on a thread of its own.
//!
//! A browser gets messages as server-sent events, and sends orders by POST. A browser that reads
//! slowly misses messages. The loop waits for nobody: its ring drops what the page does not take.

mod control_broker;
mod http;
mod server;
mod snapshot;
mod track;

pub use control_broker::{ControlBroker, Order};
pub use server::{Server, Start};
pub use snapshot::{SNAPSHOT_INTERVAL_STEPS, Snapshot};
pub use track::track;
