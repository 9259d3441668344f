//! A hostile host's calls by FMI 2.0, chosen by the fuzzer. The driver is that of the tests.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use moris_fmu_tests::hostile::{Choices, Functions, run};

mod library;

static FUNCTIONS: LazyLock<Functions> = LazyLock::new(|| Functions::fmi2(&library::fmi2()));

fuzz_target!(|bytes: &[u8]| {
    run(&FUNCTIONS, Choices::Bytes(bytes), u64::MAX);
});
