//! The washout's library in the hands of a host that does everything wrong, by
//! both versions of FMI.

use crate::cases::{cases, searches};
use moris_fmi::fmi3::Layout;
use moris_fmu_host::{Api, Fmu, fmi3};
use moris_fmu_tests::hostile::{CallCounts, Choices, Functions, run};
use moris_fmu_tests::{standard2, standard3};

fn library() -> std::path::PathBuf {
    moris_fmu_host::example_library("washout_library")
}

fn calls(counts: &CallCounts) -> u64 {
    counts.values().sum()
}

/// Makes so many calls for each seed, always the same; returns how they ended.
fn many_calls(functions: &Functions, seeds: std::ops::Range<u64>) -> CallCounts {
    let each = searches(40_000, 10_000) as u64;
    let mut total = CallCounts::new();
    for seed in seeds {
        let counts = run(functions, Choices::Seed(seed), each);
        assert!(calls(&counts) >= each);
        counts.into_iter().for_each(|(key, count)| *total.entry(key).or_default() += count);
    }
    total
}

/// Asserts that every function was called, and that those that can be used were, both
/// with success and without.
fn assert_all_called(total: &CallCounts, functions: &[&str], sequence: &[(&str, &str)], exceptions: &Exceptions) {
    for function in functions {
        let count = |status| total.iter().filter(|((name, s), _)| name == function && *s == status).count();
        let allowed = sequence.iter().find(|(name, _)| name == function);
        let usable = allowed.is_none_or(|(_, states)| !states.is_empty());
        let done = if exceptions.only_discard.contains(function) { count(2) } else { count(0) };
        assert!(done > 0 || !usable || exceptions.only_fail.contains(function), "{function} never succeeded");
        assert!(count(3) > 0 || exceptions.never_fail.contains(function), "{function} was never refused");
    }
}

/// Functions that end in fewer ways than others.
struct Exceptions {
    only_discard: &'static [&'static str],
    only_fail: &'static [&'static str],
    never_fail: &'static [&'static str],
}

#[test]
fn many_calls_of_fmi_2_do_no_harm() {
    let fmu = Fmu::from_library(&library(), "").unwrap();
    let exceptions = Exceptions {
        only_discard: &["fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"],
        // There is never a step in progress.
        only_fail: &["fmi2GetDirectionalDerivative", "fmi2CancelStep"],
        never_fail: &["fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2FreeInstance", "fmi2Reset"],
    };
    let total = many_calls(&Functions::fmi2(fmu.api()), 0..4);
    assert_all_called(&total, Api::SYMBOLS, standard2::CALLING_SEQUENCE, &exceptions);
}

#[test]
fn many_calls_of_fmi_3_do_no_harm() {
    let library = fmi3::Library::open(&library()).unwrap();
    let exceptions = Exceptions {
        only_discard: &[],
        only_fail: &[
            "fmi3InstantiateModelExchange",
            "fmi3InstantiateScheduledExecution",
            "fmi3GetNumberOfVariableDependencies",
            "fmi3GetVariableDependencies",
            "fmi3GetDirectionalDerivative",
            "fmi3GetAdjointDerivative",
        ],
        never_fail: &["fmi3GetVersion", "fmi3FreeInstance", "fmi3Reset"],
    };
    for (layout, seeds) in [(Layout::Scalars, 0..1), (Layout::Arrays, 1..2)] {
        let total = many_calls(&Functions::fmi3(library.api(), layout), seeds);
        assert_all_called(&total, fmi3::Api::SYMBOLS, standard3::CALLING_SEQUENCE, &exceptions);
    }
}

/// As the fuzzer does it, see fuzz/.
#[test]
fn bytes_lead_the_host_too() {
    let (fmu, library) = (Fmu::from_library(&library(), "").unwrap(), fmi3::Library::open(&library()).unwrap());
    let versions = [
        Functions::fmi2(fmu.api()),
        Functions::fmi3(library.api(), Layout::Scalars),
        Functions::fmi3(library.api(), Layout::Arrays),
    ];
    let mut seed = Choices::Seed(1);
    for functions in &versions {
        for _ in 0..cases(40, 10) {
            let bytes: Vec<u8> = (0..4000).map(|_| seed.bits() as u8).collect();
            assert!(calls(&run(functions, Choices::Bytes(&bytes), u64::MAX)) > 100);
        }
    }
}
