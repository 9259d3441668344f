//! The types that a field of an interface may have, and how each lies in slots.

use nalgebra::{RowSVector, Vector3};

use crate::{Kind, units};

/// A type that is one or several scalar variables.
pub trait Field: Copy {
    /// Elements of the array; 1 where it is none.
    const COUNT: usize = 1;
    /// Names of an element's components.
    const COMPONENTS: &'static [&'static str] = &[""];
    const KIND: Kind = Kind::Real(&units::ONE);
    fn read(slots: &[f64]) -> Self;
    fn write(self, slots: &mut [f64]);

    /// True if every scalar is within `range`, ends included.
    #[inline]
    fn is_within(self, (min, max): (f64, f64)) -> bool {
        let mut buffer = [0.0; LARGEST_FIELD];
        let slots = &mut buffer[..Self::COUNT * Self::COMPONENTS.len()];
        self.write(slots);
        slots.iter().fold(true, |all, &value| all & (min <= value) & (value <= max))
    }

    /// Every scalar moved to the nearest end of `range` if it is outside, or to `rest`
    /// if it is not a number.
    fn sanitized(self, rest: Self, (min, max): (f64, f64)) -> Self {
        let mut buffer = [[0.0; LARGEST_FIELD]; 2];
        let [slots, rests] = buffer.each_mut().map(|buffer| &mut buffer[..Self::COUNT * Self::COMPONENTS.len()]);
        self.write(slots);
        rest.write(rests);
        for (slot, rest) in slots.iter_mut().zip(rests) {
            *slot = if slot.is_nan() { *rest } else { slot.clamp(min, max) };
        }
        Self::read(slots)
    }
}

/// Slots of the largest field, row vectors aside.
const LARGEST_FIELD: usize = 20;

impl Field for f64 {
    fn read(slots: &[f64]) -> Self {
        slots[0]
    }
    fn write(self, slots: &mut [f64]) {
        slots[0] = self;
    }
}

impl Field for bool {
    const KIND: Kind = Kind::Boolean;
    fn read(slots: &[f64]) -> Self {
        // A host that knows only reals may round; 0 and 1 are exact.
        slots[0] >= 0.5
    }
    fn write(self, slots: &mut [f64]) {
        slots[0] = f64::from(self);
    }
}

impl Field for i32 {
    const KIND: Kind = Kind::Integer;
    fn read(slots: &[f64]) -> Self {
        libm::round(slots[0]) as i32
    }
    fn write(self, slots: &mut [f64]) {
        slots[0] = f64::from(self);
    }
}

impl Field for Vector3<f64> {
    const COMPONENTS: &'static [&'static str] = &["x", "y", "z"];
    fn read(slots: &[f64]) -> Self {
        Vector3::new(slots[0], slots[1], slots[2])
    }
    fn write(self, slots: &mut [f64]) {
        slots.copy_from_slice(self.as_slice());
    }
}

impl<const N: usize> Field for [f64; N] {
    const COUNT: usize = N;
    fn read(slots: &[f64]) -> Self {
        core::array::from_fn(|i| slots[i])
    }
    fn write(self, slots: &mut [f64]) {
        slots.copy_from_slice(&self);
    }
}

/// For more numbers than the other fields have, and serde's arrays.
impl<const N: usize> Field for RowSVector<f64, N> {
    const COUNT: usize = N;
    fn read(slots: &[f64]) -> Self {
        RowSVector::from_fn(|_, i| slots[i])
    }
    fn write(self, slots: &mut [f64]) {
        slots.copy_from_slice(self.as_slice());
    }

    fn is_within(self, (min, max): (f64, f64)) -> bool {
        self.iter().all(|&value| (min..=max).contains(&value))
    }

    fn sanitized(self, rest: Self, (min, max): (f64, f64)) -> Self {
        self.zip_map(&rest, |value, rest| if value.is_nan() { rest } else { value.clamp(min, max) })
    }
}

impl Field for [Vector3<f64>; 6] {
    const COUNT: usize = 6;
    const COMPONENTS: &'static [&'static str] = &["x", "y", "z"];
    fn read(slots: &[f64]) -> Self {
        core::array::from_fn(|i| Vector3::new(slots[3 * i], slots[3 * i + 1], slots[3 * i + 2]))
    }
    fn write(self, slots: &mut [f64]) {
        for (element, slot) in self.iter().zip(slots.chunks_exact_mut(3)) {
            slot.copy_from_slice(element.as_slice());
        }
    }
}
