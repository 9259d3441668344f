//! Memory that a page's script and its WebAssembly share: numbers and a text.
//!
//! The script writes to [`numbers`] and calls a function of the module. The function reads the
//! numbers and leaves a text. `module.js` of the report's page is the script's side.

use std::cell::RefCell;

use moris_interface::{Group, Reader};

thread_local! {
    static NUMBERS: RefCell<Vec<f64>> = RefCell::default();
    static TEXT: RefCell<String> = RefCell::default();
}

/// Memory for so many numbers, which the page writes.
// SAFETY: no other function of the module has the name.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn numbers(count: usize) -> *mut f64 {
    NUMBERS.with_borrow_mut(|numbers| {
        numbers.clear();
        numbers.resize(count, 0.0);
        numbers.as_mut_ptr()
    })
}

/// Address of the text.
// SAFETY: no other function of the module has the name.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn text() -> *const u8 {
    TEXT.with_borrow(|text| text.as_ptr())
}

/// Length of the text in bytes.
// SAFETY: no other function of the module has the name.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn text_length() -> usize {
    TEXT.with_borrow(String::len)
}

/// Works with the numbers that the page has written.
pub fn with_numbers<T>(act: impl FnOnce(&[f64]) -> T) -> T {
    NUMBERS.with_borrow(|numbers| act(numbers))
}

/// A group of variables from the numbers, slot by slot.
pub fn group<T: Group>() -> T {
    with_numbers(|numbers| T::read(&mut Reader::new(numbers)))
}

/// Writes numbers for the page to read, and returns their address.
pub fn write(values: impl Iterator<Item = f64>) -> *const f64 {
    NUMBERS.with_borrow_mut(|numbers| {
        numbers.clear();
        numbers.extend(values);
        numbers.as_ptr()
    })
}

/// Puts a text, or the reason why there is none, for the page to read; true for a text.
pub fn respond(answer: Result<String, impl ToString>) -> bool {
    let is_good = answer.is_ok();
    TEXT.set(answer.unwrap_or_else(|reason| reason.to_string()));
    is_good
}
