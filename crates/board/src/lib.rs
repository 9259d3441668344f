//! The washout on a microcontroller: its C interface, and the memory that the caller gives it.
//!
//! `include/moris_board.h` documents the functions. `cargo rustc --crate-type staticlib` makes the
//! library. The crate is empty where there is an operating system.

#![no_std]
#![cfg(target_os = "none")]

extern crate alloc;

pub mod arena;
#[cfg(target_arch = "arm")]
mod copying;

use alloc::borrow::Cow;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::ToString;
use core::ffi::c_char;
use core::slice;

use moris_interface::{Group, Reader, Writer, slot_count};
use moris_washout::{Input, Output, Parameters, Preview, Washout};

/// Size of the buffer for a washout with the strategies that are built in, in bytes.
pub const BUFFER_SIZE: usize = if cfg!(feature = "predictive") { 240 << 10 } else { 24 << 10 };
/// Elements of the output.
pub const OUTPUT_COUNT: usize = slot_count(Output::ROWS);

/// Size of the buffer that [`moris_create`] needs.
#[unsafe(no_mangle)]
pub extern "C" fn moris_buffer_size() -> usize {
    BUFFER_SIZE
}

/// Makes a washout at rest at neutral in the caller's buffer. NULL on an error, whose text is then
/// written to `message`.
///
/// # Safety
/// `buffer`, `parameters` and `message` point to as many bytes, numbers and characters as the
/// arguments after them say, or are NULL. The buffer is the washout's from now on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moris_create(
    buffer: *mut u8,
    size: usize,
    parameters: *const f64,
    count: usize,
    message: *mut c_char,
    message_size: usize,
) -> *mut Washout {
    // SAFETY: the caller promises both.
    let made = unsafe { create(buffer, size, parameters, count) };
    arena::close_memory();
    made.unwrap_or_else(|text| {
        if !message.is_null() && message_size > 0 {
            let length = text.len().min(message_size - 1);
            // SAFETY: the caller promises that the message has its size.
            unsafe {
                message.copy_from_nonoverlapping(text.as_ptr().cast(), length);
                message.add(length).write(0);
            }
        }
        core::ptr::null_mut()
    })
}

/// # Safety
/// As [`moris_create`].
unsafe fn create(
    buffer: *mut u8,
    size: usize,
    parameters: *const f64,
    count: usize,
) -> Result<*mut Washout, Cow<'static, str>> {
    // Alignment of the buffer [bytes].
    const BUFFER_ALIGNMENT: usize = 8;
    const PARAMETER_COUNT: usize = slot_count(Parameters::ROWS);
    if buffer.is_null() || size < BUFFER_SIZE || buffer.align_offset(BUFFER_ALIGNMENT) != 0 {
        let reason = "buffer: is NULL, smaller than moris_buffer_size() or not aligned to 8 bytes; give another one";
        return Err(reason.into());
    }
    // SAFETY: the caller gives the buffer away.
    unsafe { arena::open_memory(buffer, size) };
    if parameters.is_null() || count != PARAMETER_COUNT {
        let reason = format!(
            "parameters: are NULL or {count} numbers, but this library has {PARAMETER_COUNT} parameters; write \
             moris_parameters.h by moris parameters --c-header of the same version"
        );
        return Err(reason.into());
    }
    // SAFETY: the caller promises as many numbers.
    let parameters = Parameters::read(&mut Reader::new(unsafe { slice::from_raw_parts(parameters, count) }));
    match Washout::new(&parameters) {
        Ok(washout) => Ok(Box::into_raw(Box::new(washout))),
        Err(error) => Err(error.to_string().into()),
    }
}

/// Advances by `step` seconds.
///
/// # Safety
/// `washout` comes from [`moris_create`], `input` points to an input's numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moris_step(washout: *mut Washout, input: *const f64, step: f64) {
    const INPUT_COUNT: usize = slot_count(Input::ROWS);
    // SAFETY: the caller promises both.
    if let (Some(washout), input) = unsafe { (washout.as_mut(), slice::from_raw_parts(input, INPUT_COUNT)) } {
        washout.step(&Input::read(&mut Reader::new(input)), step);
    }
}

/// Sets the specific force to come.
///
/// # Safety
/// `washout` comes from [`moris_create`], `preview` points to a preview's numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moris_preview(washout: *mut Washout, preview: *const f64) {
    const PREVIEW_COUNT: usize = slot_count(Preview::ROWS);
    // SAFETY: the caller promises both.
    if let (Some(washout), preview) = unsafe { (washout.as_mut(), slice::from_raw_parts(preview, PREVIEW_COUNT)) } {
        washout.preview(&Preview::read(&mut Reader::new(preview)));
    }
}

/// Writes the output now.
///
/// # Safety
/// `washout` comes from [`moris_create`], `output` has the place for an output's numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moris_read(washout: *const Washout, output: *mut f64) {
    // SAFETY: the caller promises both.
    if let (Some(washout), output) = unsafe { (washout.as_ref(), slice::from_raw_parts_mut(output, OUTPUT_COUNT)) } {
        washout.output().write(&mut Writer::new(output));
    }
}

/// Stops the program where it is. The washout does not panic; a watchdog of the board would act.
#[panic_handler]
fn stop(_: &core::panic::PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
