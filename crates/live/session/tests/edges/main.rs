//! The edges of a session, where a plug is pulled. Clocks and states are computed.

mod feed;
mod legs;
mod signs;
mod table_check;
mod times;
mod tuning;
