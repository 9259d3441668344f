//! The edges of a session: what it does when a plug is pulled, with computed clocks and states.

mod feed;
mod legs;
mod signs;
mod times;
mod tuning;
