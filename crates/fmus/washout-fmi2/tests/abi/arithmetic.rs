//! The arithmetic of the thread that the library runs in is left as it was.

use moris_fmu_host::Fmu;
use moris_fmu_tests::hostile::{Choices, Functions, run};

use crate::fixture::*;

/// Control word of floating-point arithmetic: rounding, flushing to zero, traps; without the
/// flags of what happened.
fn arithmetic() -> u64 {
    let (mut sse, mut x87) = (0u32, 0u16);
    // SAFETY: the instructions store the two control words.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut sse, options(nostack));
        std::arch::asm!("fnstcw [{}]", in(reg) &raw mut x87, options(nostack));
    }
    u64::from(sse & !0x3f) << 16 | u64::from(x87)
}

/// Any calls at all leave the setting. The tests of all models set other ones: `tests/fmu-tests`.
#[test]
fn arithmetic_is_left_as_it_was() {
    std::thread::spawn(|| {
        let fmu = Fmu::from_library(&library(), "").unwrap();
        let usual = arithmetic();
        run(&Functions::fmi2(fmu.api()), Choices::Seed(11), 10_000);
        assert_eq!(arithmetic(), usual);
    })
    .join()
    .unwrap();
}
