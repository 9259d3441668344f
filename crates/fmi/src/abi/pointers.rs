//! A host's pointers as slices and strings, and our strings for the host.

use std::ffi::{CStr, CString, c_char};
use std::mem::MaybeUninit;

use crate::CallError;

/// A pointer that does not lead to as many values as the host says. The error is made out of the
/// way of the calls that have nothing to complain about.
#[derive(Debug)]
pub struct NotAnArray {
    length: usize,
}

/// `length` elements from `pointer` on; null will do for none.
///
/// # Safety
/// Unless null, `pointer` leads to `length` elements that nothing else changes during `'a`.
///
/// # Errors
/// A pointer that is null or misaligned where it must not be, or a length beyond the address space.
#[inline]
pub unsafe fn slice<'a, T>(pointer: *const T, length: usize) -> Result<&'a [T], NotAnArray> {
    if length == 0 {
        return Ok(&[]);
    }
    check_array(pointer, length)?;
    // SAFETY: not null, aligned, not longer than memory can be; for the rest the caller vouches.
    Ok(unsafe { std::slice::from_raw_parts(pointer, length) })
}

/// Room for `length` elements from `pointer` on; null will do for none.
///
/// # Safety
/// Unless null, `pointer` points to memory for `length` elements that nothing
/// else uses during `'a`.
///
/// # Errors
/// A pointer that is null or misaligned where it must not be, or a length beyond the address space.
#[inline]
pub unsafe fn buffer<'a, T>(pointer: *mut T, length: usize) -> Result<&'a mut [MaybeUninit<T>], NotAnArray> {
    if length == 0 {
        return Ok(&mut []);
    }
    check_array(pointer, length)?;
    // SAFETY: as in `slice`; the elements need not be initialized.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer.cast(), length) })
}

/// The value that `pointer` leads to.
///
/// # Safety
/// Unless null, `pointer` leads to a `T` that nothing else uses during `'a`.
///
/// # Errors
/// A pointer that is null or misaligned where it must not be, or a length beyond the address space.
pub unsafe fn out_param<'a, T>(pointer: *mut T) -> Result<&'a mut T, NotAnArray> {
    check_array(pointer, 1)?;
    // SAFETY: not null and aligned; for the rest the caller vouches.
    Ok(unsafe { &mut *pointer })
}

/// Writes the answer to where `pointer` leads.
///
/// # Safety
/// Unless null, `pointer` points to memory for a `T` that nothing else uses.
///
/// # Errors
/// A pointer that is null or misaligned where it must not be, or a length beyond the address space.
pub unsafe fn answer<T>(pointer: *mut T, answer: T) -> Result<(), NotAnArray> {
    check_array(pointer, 1)?;
    // SAFETY: not null and aligned; for the rest the caller vouches.
    unsafe { pointer.write(answer) };
    Ok(())
}

/// The string at `pointer`; `None` for null.
///
/// # Safety
/// Unless null, `pointer` leads to a string ended by a zero that stays as it is during `'a`.
pub unsafe fn string<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    // SAFETY: not null where used; for the rest the caller vouches.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}

/// The text for C, up to the first zero in it.
pub fn c_string(text: &str) -> CString {
    let end = text.find('\0').unwrap_or(text.len());
    CString::new(&text[..end]).unwrap_or_default()
}

/// Checks that `pointer` can lead to `length` elements.
#[inline]
fn check_array<T>(pointer: *const T, length: usize) -> Result<(), NotAnArray> {
    let is_array = !pointer.is_null() && pointer.is_aligned() && length <= isize::MAX as usize / size_of::<T>();
    if is_array { Ok(()) } else { Err(NotAnArray { length }) }
}

impl From<NotAnArray> for CallError {
    #[cold]
    #[inline(never)]
    fn from(refused: NotAnArray) -> Self {
        CallError::error(format!(
            "the array argument for {} values is null, misaligned or too long; pass valid memory",
            refused.length
        ))
    }
}
