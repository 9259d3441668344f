//! The reason why something cannot be computed.

/// The reason why something cannot be computed: the value, what is wrong with it, and the remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub(crate) String);

/// Returns a [`Refusal`] with a sentence, or with this text.
macro_rules! refuse {
    (sentence![$($sentence:tt)*]) => { return Err($crate::Refusal($crate::sentence![$($sentence)*])) };
    ($($text:tt)*) => { return Err($crate::Refusal(format!($($text)*))) };
}
pub(crate) use refuse;
