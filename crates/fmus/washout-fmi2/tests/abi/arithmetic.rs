//! The arithmetic of the thread that the library runs in is left as it was.

use moris_fmu_host::Fmu;

use crate::fixture::*;
use crate::hostile::driver::{Choices, run};

/// Control word of floating-point arithmetic: rounding, flushing to zero, traps; without the flags of what happened.
fn arithmetic() -> u64 {
    let (mut sse, mut x87) = (0u32, 0u16);
    // SAFETY: the instructions store the two control words.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut sse, options(nostack));
        std::arch::asm!("fnstcw [{}]", in(reg) &raw mut x87, options(nostack));
    }
    u64::from(sse & !0x3f) << 16 | u64::from(x87)
}

/// Rounds up, flushes results to zero and takes small operands as zero.
fn set_strange_arithmetic() {
    let strange: u32 = 0x1f80 | 0x8000 | 0x4000 | 0x0040;
    // SAFETY: the instruction loads the control word; no trap is enabled in it.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const strange, options(nostack)) };
}

/// Some hosts flush small numbers to zero, some even round otherwise. The library neither minds nor changes it.
#[test]
fn arithmetic_is_left_as_it_was_even_if_it_is_strange() {
    std::thread::spawn(|| {
        let fmu = Fmu::from_library(&library(), "").unwrap();
        let usual = arithmetic();
        run(fmu.api(), Choices::Seed(11), 10_000);
        assert_eq!(arithmetic(), usual);
        set_strange_arithmetic();
        let strange = arithmetic();
        assert_ne!(strange, usual);
        run(fmu.api(), Choices::Seed(12), 10_000);
        assert_eq!(arithmetic(), strange);
    })
    .join()
    .unwrap();
}
