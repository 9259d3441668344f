//! A hostile host's calls, led by the fuzzer: the same driver as in the tests.

#![no_main]

use std::sync::LazyLock;

use fmu_host::Api;
use libfuzzer_sys::fuzz_target;

#[allow(dead_code, unused_imports)] // what only the tests use
#[path = "../../fmu/tests/abi/hostile/driver/mod.rs"]
mod driver;
mod library;
#[path = "../../fmi/tests/abi/standard.rs"]
mod standard;

static API: LazyLock<Api> = LazyLock::new(library::open);

fuzz_target!(|bytes: &[u8]| {
    driver::run(&API, driver::Choices::Bytes(bytes), u64::MAX);
});
