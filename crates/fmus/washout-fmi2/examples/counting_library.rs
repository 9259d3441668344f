//! The shared library with an allocator that counts, for the test that says that
//! stepping allocates nothing.

#[path = "../src/lib.rs"]
mod library;

use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Number of allocations, reallocations and deallocations.
#[unsafe(no_mangle)]
pub extern "C" fn memory_operations() -> usize {
    let stats = ALLOCATOR.stats();
    stats.allocations + stats.reallocations + stats.deallocations
}
