//! Results do not depend on how the host has set the processor's arithmetic.

use std::arch::asm;
use std::fs;

use moris_interface::Causality;

use crate::library::*;

/// MXCSR: all traps masked, round to nearest.
const DEFAULT: u32 = 0x1f80;
const ROUNDING: [(&str, u32); 4] = [("to nearest", 0x0000), ("down", 0x2000), ("up", 0x4000), ("to zero", 0x6000)];
/// Flush results to zero, and take small operands as zero.
const FLUSHING: [(&str, u32); 2] = [("", 0), (", flushing to zero", 0x8040)];
/// Without the flags of what has happened.
const SETTING: u32 = !0x3f;

fn set_arithmetic(setting: u32) {
    // SAFETY: the instruction loads the control word, no reserved bit of which is set. Until it is the default again,
    // nothing here computes with floating-point numbers.
    unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const setting, options(nostack)) };
}

fn arithmetic() -> u32 {
    let mut setting = 0;
    // SAFETY: the instruction stores the control word.
    unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut setting, options(nostack)) };
    setting & SETTING
}

const STEP: f64 = 0.003;
const STEPS: usize = 400;

/// A ride, computed beforehand: the inputs' slots, their values step by step, the times of the
/// steps, and the outputs' slots.
struct Ride {
    inputs: Vec<usize>,
    values: Vec<Vec<f64>>,
    times: Vec<f64>,
    reals: Vec<u32>,
}

impl Ride {
    /// Every real input moves about its start value.
    fn of(model: &TestedModel) -> Ride {
        let start = model.start();
        let is_real = |slot: &usize| matches!(model.identity.row(*slot).kind, moris_interface::Kind::Real(_));
        let inputs: Vec<usize> = model
            .slots()
            .filter(is_real)
            .filter(|&slot| model.identity.row(slot).causality == Causality::Input)
            .collect();
        let moved = |k: usize| {
            let value = |(n, &slot): (usize, &usize)| {
                start[slot] + 0.02 * ((1.0 + 0.3 * n as f64) * STEP * k as f64 + n as f64).sin()
            };
            inputs.iter().enumerate().map(value).collect()
        };
        Ride {
            values: (0..STEPS).map(moved).collect(),
            times: (0..STEPS).map(|k| STEP * k as f64).collect(),
            reals: model.slots().filter(is_real).map(|slot| slot as u32).collect(),
            inputs,
        }
    }

    /// All real variables after each step with this arithmetic, which is set before the library
    /// is loaded; to the bit.
    fn results(&self, model: TestedModel, version: Version, setting: u32) -> Vec<u64> {
        // A copy is another library for the loader: nothing in it has been computed yet.
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("library.so");
        fs::copy(model.library(), &file).unwrap();
        let library = Library::open(model, version, &file);
        let mut rows = vec![0.0; STEPS * self.reals.len()];
        let messages = Messages::default();
        set_arithmetic(setting);
        let outcome = self.ride(&library, &messages, &mut rows);
        let left = arithmetic();
        set_arithmetic(DEFAULT);
        assert_eq!(outcome, Ok(()), "{}: {messages:?}", model.identity.name);
        assert_eq!(left, setting & SETTING, "the host's setting is changed");
        rows.into_iter().map(f64::to_bits).collect()
    }

    fn ride(&self, library: &Library, messages: &Messages, rows: &mut [f64]) -> Result<(), &'static str> {
        let mut instance = library.instantiate(messages).ok_or("not instantiated")?;
        let mut status = instance.enter_initialization_mode();
        status = status.max(instance.exit_initialization_mode());
        for k in 0..STEPS {
            for (slot, value) in self.inputs.iter().zip(&self.values[k]) {
                status = status.max(instance.set(*slot, *value));
            }
            status = status.max(instance.step(self.times[k], STEP));
            let row = &mut rows[k * self.reals.len()..(k + 1) * self.reals.len()];
            status = status.max(instance.get_reals(&self.reals, row));
        }
        if status == OK { Ok(()) } else { Err("a call has failed") }
    }
}

#[test]
fn every_library_gives_the_same_bits_whatever_the_host_has_set() {
    for model in MODELS {
        let ride = Ride::of(&model);
        for version in VERSIONS {
            let expected = ride.results(model, version, DEFAULT);
            let moved = expected[..ride.reals.len()] != expected[expected.len() - ride.reals.len()..];
            assert!(moved, "{}: a ride in which nothing happens shows nothing", model.identity.name);
            for (rounding, bits) in ROUNDING {
                for (flushing, more_bits) in FLUSHING {
                    let results = ride.results(model, version, DEFAULT | bits | more_bits);
                    let name = model.identity.name;
                    assert!(results == expected, "{name}, {version:?}: rounding {rounding}{flushing}");
                }
            }
        }
    }
}

/// A host that traps on inexact results would be killed by the first step.
#[test]
fn a_host_that_traps_is_not_killed() {
    const ALL_TRAPS: u32 = 0;
    for model in MODELS {
        let ride = Ride::of(&model);
        for version in VERSIONS {
            assert!(ride.results(model, version, ALL_TRAPS) == ride.results(model, version, DEFAULT));
        }
    }
}
