//! Random calls in any order, with right and wrong arguments: none crashes, and one that
//! fails changes nothing.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_int};
use std::ptr::null_mut;

use moris_fmi::fmi3::Layout;

use crate::fixture::*;

/// Numbers from a seed (xorshift64*).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() >> 16) as usize % bound
    }

    /// A usual number or one that must do no harm.
    fn number(&mut self) -> f64 {
        let hostile = [0.0, -0.0, f64::NAN, f64::INFINITY, -f64::INFINITY, f64::MAX, f64::MIN_POSITIVE, -1.0, 1e300];
        match self.below(3) {
            0 => hostile[self.below(hostile.len())],
            _ => self.below(2000) as f64 / 1000.0,
        }
    }

    /// Value references, of which few lead to no variable; without the trap that
    /// makes the model panic.
    fn references(&mut self) -> Vec<u32> {
        let trap = reference("trap");
        let count = self.below(4);
        let one = |random: &mut Self| match random.below(20) {
            0 => u32::MAX - random.below(3) as u32,
            _ => random.below(IDENTITY.slots.len() + 1) as u32,
        };
        (0..count).map(|_| one(self)).filter(|&reference| reference != trap).collect()
    }

    /// A number of values that often fits.
    fn length(&mut self, references: &[u32], layout: Layout) -> usize {
        let size = |&reference: &u32| match (layout, IDENTITY.slots.get(reference as usize)) {
            (Layout::Arrays, Some(_)) => IDENTITY.row(reference as usize).slots(),
            _ => 1,
        };
        let fitting = references.iter().map(size).sum();
        if self.below(4) == 0 { self.below(20) } else { fitting }
    }
}

/// Makes one call; returns its name and how it ended.
fn call(instance: &Instance, random: &mut Random, layout: Layout, time: &mut f64) -> (&'static str, c_int) {
    let (api, c) = (instance.api(), instance.pointer);
    let references = random.references();
    let length = random.length(&references, layout);
    let (r, n) = (references.as_ptr(), references.len());
    let mut reals: Vec<f64> = (0..length).map(|_| random.number()).collect();
    let mut integers: Vec<i32> = (0..length).map(|_| random.next() as i32 % 8).collect();
    let mut longs: Vec<i64> = integers.iter().map(|&value| i64::from(value)).collect();
    let mut booleans: Vec<u8> = integers.iter().map(|&value| value as u8).collect();
    let choice = random.below(22);
    // SAFETY: the instance is alive, and the arrays are as long as said.
    unsafe {
        match choice {
            0 | 1 => ("get_float64", (api.get_float64)(c, r, n, reals.as_mut_ptr(), length)),
            2..=4 => ("set_float64", (api.set_float64)(c, r, n, reals.as_ptr(), length)),
            5 => ("get_int32", (api.get_int32)(c, r, n, integers.as_mut_ptr(), length)),
            6 => ("set_int32", (api.set_int32)(c, r, n, integers.as_ptr(), length)),
            7 => ("get_int64", (api.get_int64)(c, r, n, longs.as_mut_ptr(), length)),
            8 => ("set_int64", (api.set_int64)(c, r, n, longs.as_ptr(), length)),
            9 => ("get_boolean", (api.get_boolean)(c, r, n, booleans.as_mut_ptr(), length)),
            10 => ("set_boolean", (api.set_boolean)(c, r, n, booleans.as_ptr(), length)),
            11 => {
                let orders = vec![random.below(3) as i32; n];
                let function = api.get_output_derivatives;
                ("get_output_derivatives", function(c, r, n, orders.as_ptr(), reals.as_mut_ptr(), length))
            }
            12..=14 => {
                let step = if random.below(5) == 0 { random.number() } else { 0.01 };
                let from = if random.below(8) == 0 { random.number() } else { *time };
                let (status, last) = instance.do_step(from, step);
                if status == OK {
                    *time = last;
                }
                ("do_step", status)
            }
            15 => {
                let (start, stop) = (random.number(), random.number());
                let status = instance.enter_initialization_mode(start, (random.below(2) == 0).then_some(stop));
                if status == OK {
                    *time = start;
                }
                ("enter_initialization_mode", status)
            }
            16 | 17 => ("exit_initialization_mode", instance.exit_initialization_mode()),
            18 if random.below(4) == 0 => ("terminate", (api.terminate)(c)),
            19 if random.below(2) == 0 => ("reset", instance.reset()),
            20 => {
                let categories = [c"logEvents", c"logStatusError", c"no such category"];
                let category: &CStr = categories[random.below(3)];
                let on = random.below(2) as u8;
                ("set_debug_logging", (api.set_debug_logging)(c, on, 1, &category.as_ptr()))
            }
            21 => {
                let mut bytes = instance.bytes();
                let place = random.below(bytes.len());
                bytes[place] ^= 1 << random.below(8);
                let mut state = null_mut();
                let status = (api.deserialize_fmu_state)(c, bytes.as_ptr(), bytes.len(), &mut state);
                assert_eq!((status, state.is_null()), (ERROR, true), "a changed byte is noticed");
                ("deserialize_fmu_state", status)
            }
            _ => ("get_directional_derivative", {
                let (seed, room, size) = (reals.as_ptr(), reals.as_mut_ptr(), length);
                (api.get_directional_derivative)(c, r, n, r, n, seed, size, room, size)
            }),
        }
    }
}

#[test]
fn random_calls_do_no_harm_and_failed_ones_change_nothing() {
    for layout in [Layout::Scalars, Layout::Arrays] {
        let mut succeeded = BTreeMap::new();
        for seed in 1..=60 {
            let (mut random, mut time) = (Random(seed), 0.0);
            let instance = Instance::with(layout);
            for _ in 0..200 {
                let before = instance.bytes();
                let (function, status) = call(&instance, &mut random, layout, &mut time);
                assert!([OK, DISCARD, ERROR].contains(&status), "{function} ended with {status}");
                if status == OK {
                    *succeeded.entry(function).or_insert(0) += 1;
                } else {
                    assert_eq!(instance.bytes(), before, "{function} failed and changed something, seed {seed}");
                }
            }
        }
        for function in ["get_float64", "set_float64", "set_boolean", "get_output_derivatives", "do_step", "reset"] {
            assert!(succeeded.get(function).is_some_and(|&count| count > 10), "{function}: {succeeded:?}");
        }
    }
}
