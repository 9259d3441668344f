//! The processor's floating-point arithmetic during a call.
//!
//! A host may round otherwise than to nearest, flush subnormal numbers to zero, or trap on inexact
//! results. Its own code may need that, or a library in its process may have set it. A model's
//! results must not depend on the setting, and Rust itself assumes the default. So a call computes
//! with the default and restores the host's setting afterwards.

use std::hint::black_box;

use control_word::{ControlWord, DEFAULT, FLAGS, read, write};

/// Runs `body` with the default arithmetic: round to nearest, subnormal numbers
/// as they are, no traps.
///
/// Most hosts use the default. The only cost then is that of reading the setting.
#[inline]
pub fn with_default<R>(body: impl FnOnce() -> R) -> R {
    let host = read();
    if host & !FLAGS == DEFAULT { body() } else { with_control_word(host, body) }
}

#[cold]
#[inline(never)]
fn with_control_word<R>(host: ControlWord, body: impl FnOnce() -> R) -> R {
    write(DEFAULT);
    // Opaque to the compiler, which must not compute any part of `body` before the default is set.
    let result = black_box(body)();
    write(host);
    result
}

/// The register MXCSR, which controls all `f64` arithmetic. The x87 unit is not used.
#[cfg(target_arch = "x86_64")]
mod control_word {
    use std::arch::asm;

    pub type ControlWord = u32;
    /// All traps masked, round to nearest, neither FTZ nor DAZ.
    pub const DEFAULT: ControlWord = 0x1f80;
    /// Exception flags raised since the host last cleared them. The setting does not include them.
    pub const FLAGS: ControlWord = 0x3f;

    #[inline(always)]
    pub fn read() -> ControlWord {
        let mut word = 0;
        // SAFETY: the instruction stores the register in `word`.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags)) };
        word
    }

    #[inline(always)]
    pub fn write(word: ControlWord) {
        // SAFETY: `word` is the default or has been read from the register, so that no reserved bit is set. It is the
        // default wherever Rust computes. Memory counts as read and written, so that no access moves across.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack, preserves_flags)) };
    }
}

/// FPCR.
#[cfg(target_arch = "aarch64")]
mod control_word {
    use std::arch::asm;

    pub type ControlWord = u64;
    /// No traps, round to nearest, no flushing to zero.
    pub const DEFAULT: ControlWord = 0;
    /// The flags are in another register.
    pub const FLAGS: ControlWord = 0;

    #[inline(always)]
    pub fn read() -> ControlWord {
        let word;
        // SAFETY: the instruction copies the register.
        unsafe { asm!("mrs {}, fpcr", out(reg) word, options(nostack, preserves_flags)) };
        word
    }

    #[inline(always)]
    pub fn write(word: ControlWord) {
        // SAFETY: as on x86-64.
        unsafe { asm!("msr fpcr, {}", in(reg) word, options(nostack, preserves_flags)) };
    }
}

/// Other processors: the host's setting stays.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod control_word {
    pub type ControlWord = u32;
    pub const DEFAULT: ControlWord = 0;
    pub const FLAGS: ControlWord = 0;

    pub fn read() -> ControlWord {
        DEFAULT
    }

    pub fn write(_: ControlWord) {}
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    /// Round up, flush to zero, and all traps on.
    const STRANGE: ControlWord = 0x8000 | 0x4000 | 0x0040;

    #[test]
    fn the_body_runs_with_the_default_and_the_host_finds_its_own() {
        write(STRANGE);
        let inside = with_default(|| (read(), black_box(1.0) / black_box(3.0)));
        let after = read();
        write(DEFAULT);
        assert_eq!(inside.0 & !FLAGS, DEFAULT);
        assert_eq!(inside.1, 1.0 / 3.0);
        // The inexact quotient has left no exception flag.
        assert_eq!(after, STRANGE);
    }

    #[test]
    fn nothing_is_written_where_the_default_is_set() {
        let inside = with_default(|| {
            black_box(black_box(1.0) / black_box(3.0));
            read()
        });
        assert_eq!(read(), inside);
    }
}
