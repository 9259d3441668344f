//! The square root, of which `core` has none.

/// The square root: with `std` the processor's instruction, otherwise that of `libm`. Both round
/// correctly, so that their bits are equal.
#[inline(always)]
pub fn square_root(value: f64) -> f64 {
    #[cfg(feature = "std")]
    return value.sqrt();
    #[cfg(not(feature = "std"))]
    libm::sqrt(value)
}
