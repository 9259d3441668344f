//! The calling sequence as data.

use crate::Modes;

/// A function and where it is allowed.
pub struct Function {
    pub name: &'static str,
    pub allowed: Modes,
}

/// Declares a constant [`Function`] a line: the constant's name, the function's, and the modes
/// in which it is allowed. The functions that are always allowed stand first, by name only.
macro_rules! calling_sequence {
    ($($always:ident)+; $($constant:ident $name:ident [$($mode:ident)*];)+) => {
        /// Names of all functions of the version's header, which a library exports.
        pub const NAMES: &[&str] = &[$(stringify!($always),)+ $(stringify!($name)),+];

        $(
            #[doc = concat!("`", stringify!($name), "`")]
            pub const $constant: $crate::abi::Function = $crate::abi::Function {
                name: stringify!($name),
                allowed: $crate::Modes::of(&[$($mode as $crate::Mode),*]),
            };
        )+
    };
}
pub(crate) use calling_sequence;
