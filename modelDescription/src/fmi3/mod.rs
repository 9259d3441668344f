//! The description of a model by FMI 3.0.
//!
//! A row of the interface with several values is as many scalars or one array: see [`Layout`].

mod describe;
mod variables_html;

pub use describe::{describe, describe_with};
pub use moris_interface::Layout;
pub use variables_html::variables_html;
