//! The calling sequence as data.

use crate::Modes;

/// A function and where it is allowed.
pub struct Function {
    pub name: &'static str,
    pub allowed: Modes,
}

/// Declares a constant [`Function`] a line: the constant's name, the function's, and the modes
/// in which it is allowed.
macro_rules! calling_sequence {
    ($($constant:ident $name:ident [$($mode:ident)*];)+) => {
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
