//! What a component passes in memory: lists, strings, records and answers.

use std::alloc::{Layout, alloc, handle_alloc_error, realloc};
use std::mem::ManuallyDrop;
use std::ptr::null_mut;

use super::super::types::*;

/// A list or string.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct List<T> {
    pub(super) first: *mut T,
    pub(super) length: usize,
}

impl<T> List<T> {
    /// A list of these values, which [`Release`] frees.
    pub fn new(values: Vec<T>) -> Self {
        let values = ManuallyDrop::new(values.into_boxed_slice());
        List { first: values.as_ptr().cast_mut(), length: values.len() }
    }

    /// The list that a host has passed.
    ///
    /// # Safety
    /// The memory is that of `cabi_realloc` or of [`List::new`], and is used by nothing else.
    pub unsafe fn take(first: *mut T, length: usize) -> Vec<T> {
        // SAFETY: allocated with the alignment and the size of these values, as the caller guarantees.
        if length == 0 { Vec::new() } else { unsafe { Vec::from_raw_parts(first, length, length) } }
    }
}

/// Results that a host reads from memory: a value, or the status of a call that failed.
#[repr(C)]
pub struct Answer<T: Copy> {
    failed: bool,
    content: Content<T>,
}

/// Lies where the alignment of both permits, as the canonical ABI has it.
#[derive(Clone, Copy)]
#[repr(C)]
union Content<T: Copy> {
    value: T,
    status: u8,
}

impl<T: Copy> Answer<T> {
    /// The value made if the call has succeeded or warned, else its status.
    pub(super) fn new(status: fmi3Status, value: impl FnOnce() -> T) -> *mut Self {
        match status {
            fmi3Status::fmi3OK | fmi3Status::fmi3Warning => {
                Box::into_raw(Box::new(Answer { failed: false, content: Content { value: value() } }))
            }
            _ => Self::failed(status),
        }
    }

    /// The status of a call that failed.
    pub(super) fn failed(status: fmi3Status) -> *mut Self {
        Box::into_raw(Box::new(Answer { failed: true, content: Content { status: status as u8 } }))
    }
}

/// Frees what a value owns.
pub trait Release {
    /// # Safety
    /// The value comes from here and is not used afterwards.
    unsafe fn release(&self) {}
}

impl Release for StepResult {}
impl Release for u64 {}

impl<T> Release for List<T> {
    unsafe fn release(&self) {
        // SAFETY: `List::new` made it.
        drop(unsafe { Self::take(self.first, self.length) });
    }
}

/// Frees an answer that the host has read.
///
/// # Safety
/// It comes from a function of this module.
pub unsafe fn release<T: Copy + Release>(answer: *mut Answer<T>) {
    // SAFETY: guaranteed by the caller.
    let answer = unsafe { Box::from_raw(answer) };
    if !answer.failed {
        // SAFETY: the value is there, because the call has not failed.
        unsafe { answer.content.value.release() };
    }
}

/// The record `do-step-result`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct StepResult {
    pub(super) last_successful_time: f64,
    pub(super) event_handling_needed: fmi3Boolean,
    pub(super) terminate_simulation: fmi3Boolean,
    pub(super) early_return: fmi3Boolean,
}

/// A variable and an order of its derivative.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Request {
    pub(super) reference: fmi3ValueReference,
    pub(super) order: u32,
}

/// The record `interval-fraction`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Fraction {
    pub(super) counter: u64,
    pub(super) resolution: u64,
}

/// An `option` of a handle.
#[repr(C)]
pub struct OptionalHandle {
    pub(super) present: bool,
    pub(super) handle: u32,
}

/// The version of FMI.
pub fn version() -> *mut List<u8> {
    Box::into_raw(Box::new(List::new(b"3.0".to_vec())))
}

/// Memory for lists: new for `old` of no size, else the old block with another size.
///
/// # Safety
/// As the canonical ABI says.
pub unsafe fn reallocate(old: *mut u8, old_size: usize, alignment: usize, size: usize) -> *mut u8 {
    let Ok(layout) = Layout::from_size_align(size, alignment) else { return null_mut() };
    // SAFETY: sizes are not zero where memory is requested; the old block comes from here.
    let block = unsafe {
        match (old_size, size) {
            (_, 0) => return alignment as *mut u8,
            (0, _) => alloc(layout),
            _ => realloc(old, Layout::from_size_align_unchecked(old_size, alignment), size),
        }
    };
    if block.is_null() {
        handle_alloc_error(layout);
    }
    block
}
