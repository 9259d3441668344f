//! The washout's library in the hands of a host that does everything wrong.

use moris_fmu_host::Api;

use crate::fixture::library;
use crate::standard;

pub mod driver;

use driver::{Choices, Tally, run};

fn calls(tally: &Tally) -> u64 {
    tally.values().sum()
}

/// Four times 250 000 calls, by seeds that stay the same.
#[test]
fn a_million_calls_do_no_harm() {
    let fmu = moris_fmu_host::Fmu::from_library(&library(), "").unwrap();
    let mut total = Tally::new();
    for seed in 0..4 {
        let tally = run(fmu.api(), Choices::Seed(seed), 250_000);
        assert!(calls(&tally) >= 250_000);
        tally.into_iter().for_each(|(key, count)| *total.entry(key).or_default() += count);
    }
    // Every function was called, and those that can be used were, both with success and without.
    for function in Api::SYMBOLS {
        let count = |status| total.iter().filter(|((name, s), _)| name == function && *s == status).count();
        let allowed = standard::CALLING_SEQUENCE.iter().find(|(name, _)| name == function);
        let usable = allowed.is_none_or(|(name, states)| {
            states.contains(['I', 'N', 'C', 'T']) && *name != "fmi2GetDirectionalDerivative"
        });
        let always = ["fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2FreeInstance", "fmi2Reset"].contains(function);
        let only_discards = ["fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"].contains(function);
        let done = if only_discards { count(2) } else { count(0) };
        assert!(done > 0 || !usable, "{function} never succeeded");
        assert!(count(3) > 0 || always, "{function} was never refused");
    }
}

/// As the fuzzer does it, see fuzz/.
#[test]
fn bytes_lead_the_host_too() {
    let fmu = moris_fmu_host::Fmu::from_library(&library(), "").unwrap();
    let mut seed = Choices::Seed(1);
    for _ in 0..100 {
        let bytes: Vec<u8> = (0..2000).map(|_| seed.bits() as u8).collect();
        assert!(calls(&run(fmu.api(), Choices::Bytes(&bytes), u64::MAX)) > 100);
    }
}
