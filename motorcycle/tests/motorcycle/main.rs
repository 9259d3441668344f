//! The motorcycle against what others published, closed forms, differences and balances.

mod common;
mod lateral;
mod rider;
mod whipple;
