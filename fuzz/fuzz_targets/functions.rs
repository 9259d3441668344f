//! A hostile host's calls, led by the fuzzer: the same driver as in the tests.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use moris_fmu_host::Api;

#[allow(dead_code, unused_imports)] // what only the tests use
#[path = "../../crates/fmus/washout-fmi2/tests/abi/hostile/driver/mod.rs"]
mod driver;
mod library;
#[path = "../../crates/fmi/tests/abi/standard.rs"]
mod standard;

static API: LazyLock<Api> = LazyLock::new(library::open);

fuzz_target!(|bytes: &[u8]| {
    driver::run(&API, driver::Choices::Bytes(bytes), u64::MAX);
});
