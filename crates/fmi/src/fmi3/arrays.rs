//! A variable as FMI 3.0 has it: a row of the interface, which is a scalar or an array.

use std::mem::{MaybeUninit, take};

use super::types::fmi3ValueReference;
use crate::{VariableInfo, Variables};

/// Variables by their value references, all of which are there.
#[derive(Clone, Copy)]
pub struct Arrays<'a> {
    pub infos: &'a [VariableInfo],
    pub references: &'a [fmi3ValueReference],
}

impl Variables for Arrays<'_> {
    #[inline]
    fn slots(self) -> impl Iterator<Item = u32> {
        self.references.iter().copied()
    }

    #[inline]
    fn with_values<S>(self, values: &[S]) -> impl Iterator<Item = (u32, &[S])> {
        let mut rest = values;
        self.slots().map(move |reference| {
            let (mine, others) = rest.split_at(self.infos[reference as usize].row_slots as usize);
            rest = others;
            (reference, mine)
        })
    }

    #[inline]
    fn with_buffer<S>(self, buffer: &mut [MaybeUninit<S>]) -> impl Iterator<Item = (u32, &mut [MaybeUninit<S>])> {
        let mut rest = buffer;
        self.slots().map(move |reference| {
            let (mine, others) = take(&mut rest).split_at_mut(self.infos[reference as usize].row_slots as usize);
            rest = others;
            (reference, mine)
        })
    }
}
