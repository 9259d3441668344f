//! The variables that a call gets or sets, in any version of FMI.

use std::mem::MaybeUninit;
use std::slice::{from_mut, from_ref};

/// The variables that a call gets or sets. Each is identified by its first slot and has a part of
/// the call's values. In FMI 2.0 a variable is a slot and has one value. In FMI 3.0 it is a row and
/// has as many values as the row has slots.
pub trait Variables: Copy {
    /// The variables' first slots.
    fn slots(self) -> impl Iterator<Item = u32>;
    /// The variables, each with its part of the values.
    fn with_values<S>(self, values: &[S]) -> impl Iterator<Item = (u32, &[S])>;
    /// The variables, each with a buffer for its part of the values.
    fn with_buffer<S>(self, buffer: &mut [MaybeUninit<S>]) -> impl Iterator<Item = (u32, &mut [MaybeUninit<S>])>;
}

/// Variables of one slot each.
#[derive(Clone, Copy)]
pub struct Scalars<'a>(pub &'a [u32]);

impl Variables for Scalars<'_> {
    #[inline]
    fn slots(self) -> impl Iterator<Item = u32> {
        self.0.iter().copied()
    }

    #[inline]
    fn with_values<S>(self, values: &[S]) -> impl Iterator<Item = (u32, &[S])> {
        self.slots().zip(values.iter().map(from_ref))
    }

    #[inline]
    fn with_buffer<S>(self, buffer: &mut [MaybeUninit<S>]) -> impl Iterator<Item = (u32, &mut [MaybeUninit<S>])> {
        self.slots().zip(buffer.iter_mut().map(from_mut))
    }
}
