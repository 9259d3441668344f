//! A hostile host's calls by FMI 3.0, led by the fuzzer: the same driver as in the tests. The first
//! byte says whether the host has read the description with scalars or that with arrays.

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
