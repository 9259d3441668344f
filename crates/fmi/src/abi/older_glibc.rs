//! Own versions of glibc functions newer than glibc 2.17, which Rust's standard library and some
//! dependencies call. With them a library loads with any glibc since 2012, whatever glibc the
//! machine has that links it.
//!
//! [`export_fmi2!`](crate::export_fmi2) and [`export_fmi3!`](crate::export_fmi3) put them into the
//! library by the names of C, hidden from its host.

#![cfg(all(target_os = "linux", target_env = "gnu", any(target_arch = "x86_64", target_arch = "aarch64")))]

use std::ffi::{c_char, c_int, c_uint};

/// `stat64`, of glibc 2.33.
///
/// # Safety
/// As C's.
pub unsafe extern "C" fn stat64(path: *const c_char, buffer: *mut libc::stat64) -> c_int {
    // SAFETY: the caller vouches for the pointers. On these processors the kernel's struct is the C library's.
    unsafe { libc::syscall(libc::SYS_newfstatat, libc::AT_FDCWD, path, buffer, 0) as c_int }
}

/// `fstat64`, of glibc 2.33.
///
/// # Safety
/// As C's.
pub unsafe extern "C" fn fstat64(file: c_int, buffer: *mut libc::stat64) -> c_int {
    // SAFETY: as above.
    unsafe { libc::syscall(libc::SYS_fstat, file, buffer) as c_int }
}

/// `statx`, of glibc 2.28.
///
/// # Safety
/// As C's.
pub unsafe extern "C" fn statx(
    directory: c_int,
    path: *const c_char,
    flags: c_int,
    mask: c_uint,
    buffer: *mut libc::statx,
) -> c_int {
    // SAFETY: as above.
    unsafe { libc::syscall(libc::SYS_statx, directory, path, flags, mask, buffer) as c_int }
}

/// `gettid`, of glibc 2.30.
pub extern "C" fn gettid() -> libc::pid_t {
    // SAFETY: it takes no arguments and always succeeds.
    unsafe { libc::syscall(libc::SYS_gettid) as libc::pid_t }
}

/// `exp2`, of glibc 2.29.
pub extern "C" fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

/// `log2`, of glibc 2.29.
pub extern "C" fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// `pow`, of glibc 2.29.
pub extern "C" fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// `hypot`, of glibc 2.35.
pub extern "C" fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// Instruction that goes on in another function, with its arguments.
#[cfg(target_arch = "x86_64")]
#[doc(hidden)] // for `own_functions_of_newer_glibc!`
#[macro_export]
macro_rules! jump_instruction {
    () => {
        "jmp {}"
    };
}

/// Instruction that goes on in another function, with its arguments.
#[cfg(target_arch = "aarch64")]
#[doc(hidden)] // for `own_functions_of_newer_glibc!`
#[macro_export]
macro_rules! jump_instruction {
    () => {
        "b {}"
    };
}

/// Puts the functions of this module into the library. In Rust a function with a name of C is
/// exported; in assembly it need not be.
#[doc(hidden)] // for the macros that export a model
#[macro_export]
macro_rules! own_functions_of_newer_glibc {
    () => {
        $crate::own_functions_of_newer_glibc!(@ stat64 fstat64 statx gettid exp2 log2 pow hypot);
    };
    (@ $($name:ident)+) => {
        #[cfg(all(target_os = "linux", target_env = "gnu", any(target_arch = "x86_64", target_arch = "aarch64")))]
        mod own_functions_of_newer_glibc {
            $(
                std::arch::global_asm!(
                    // A library may export several versions of FMI.
                    concat!(".ifndef ", stringify!($name)),
                    concat!(".hidden ", stringify!($name)),
                    // As Rust's standard library refers to some of them: the assembler warns of anything else.
                    concat!(".weak ", stringify!($name)),
                    concat!(".type ", stringify!($name), ", @function"),
                    concat!(stringify!($name), ":"),
                    $crate::jump_instruction!(),
                    ".endif",
                    sym $crate::abi::older_glibc::$name,
                );
            )+
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_described_as_by_the_c_library() {
        let path = c"/proc/self/exe";
        // SAFETY: all-zero bytes are a struct, and the path ends with a zero.
        let (own, theirs) = unsafe {
            let (mut own, mut theirs): (libc::stat64, libc::stat64) = (std::mem::zeroed(), std::mem::zeroed());
            assert_eq!(stat64(path.as_ptr(), &mut own), 0);
            assert_eq!(libc::stat64(path.as_ptr(), &mut theirs), 0);
            (own, theirs)
        };
        let facts = |stat: &libc::stat64| (stat.st_dev, stat.st_ino, stat.st_mode, stat.st_size, stat.st_mtime_nsec);
        assert_eq!(facts(&own), facts(&theirs));
        assert!(own.st_size > 0);
    }
}
