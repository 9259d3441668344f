//! A hostile host's calls by FMI 3.0, chosen by the fuzzer. The driver is that of the tests. The
//! first byte says which description the host has read: with scalars or with arrays.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use moris_fmi::fmi3::Layout;
use moris_fmu_tests::hostile::{Choices, Functions, run};

mod library;

static FUNCTIONS: LazyLock<[Functions; 2]> =
    LazyLock::new(|| [Layout::Scalars, Layout::Arrays].map(|layout| Functions::fmi3(&library::fmi3(), layout)));

fuzz_target!(|bytes: &[u8]| {
    let [layout, rest @ ..] = bytes else { return };
    run(&FUNCTIONS[usize::from(layout % 2)], Choices::Bytes(rest), u64::MAX);
});
