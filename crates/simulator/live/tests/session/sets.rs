//! Two parameter sets, and changes from one to the other in the middle of a ride.

use moris_interface::{Group as _, Reader, Variability, slots_of};
use moris_live::Event;
use moris_live::log::name_of;
use moris_washout::{Parameters, Washout, presets};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::ride::RideEvent;
use crate::{MOST, SETS, any_event, any_ride, discomfort};

/// Groups of parameters that people tune.
const TUNED: [&str; 5] = ["scale", "splitter", "angular", "tilt", "input"];

/// Slots of a set's tunable parameters in these groups that are not 0, with their values.
fn tuned(parameters: &Parameters) -> Vec<(usize, f64)> {
    let slots = slots_of(parameters).into_iter().enumerate();
    let is_tuned = |slot: usize| {
        let row = &Parameters::ROWS[usize::from(Parameters::SLOTS[slot].row)];
        let name = name_of(slot);
        row.variability == Variability::Tunable && TUNED.contains(&name.split('.').next().unwrap_or_default())
    };
    slots.filter(|(slot, value)| *value != 0.0 && is_tuned(*slot)).collect()
}

/// The parameters with one of the two sets.
fn with(parameters: &Parameters, sets: &[(usize, [f64; 2])], which: usize) -> Parameters {
    let mut slots = slots_of(parameters);
    sets.iter().for_each(|(slot, values)| slots[*slot] = values[which]);
    Parameters::read(&mut Reader::new(&slots))
}

/// True if the washout takes both sets.
fn is_usable(parameters: &Parameters, sets: &[(usize, [f64; 2])]) -> bool {
    (0..2).all(|which| Washout::new(parameters).unwrap().retune(&with(parameters, sets, which)).is_ok())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::cases::cases(8, 4), rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    /// Each parameter 0.7 to 1.4 times that of the base, in both sets.
    #[test]
    fn a_change_from_one_set_to_another_is_no_jolt(
        set in prop::sample::select(SETS),
        factors in prop::collection::vec([-1.0..1.0_f64, -1.0..1.0], 120),
        events in prop::collection::vec(prop_oneof![
            3 => (0.3..8.0_f64, (0..2_usize).prop_map(RideEvent::Set)),
            1 => any_event(),
        ], 10..20),
        mut ride in any_ride(),
    ) {
        let parameters = presets::parameters(set.1);
        let tuned = tuned(&parameters);
        prop_assert!((20..=factors.len()).contains(&tuned.len()));
        ride.sets = tuned.iter().zip(&factors).map(|((slot, value), two)| (*slot, two.map(|log| value * (0.5 * log).exp2()))).collect();
        // What the washout refuses stays as it is.
        let all = std::mem::take(&mut ride.sets);
        ride.sets = all.into_iter().filter(|one| is_usable(&parameters, &[*one])).collect();
        prop_assume!(is_usable(&parameters, &ride.sets));
        let events = [&[(5.0, RideEvent::Person(Event::Engage))], &events[..]].concat();
        // Both sets alone are comfortable.
        for which in 0..2 {
            let mut alone = ride.clone();
            alone.sets.iter_mut().for_each(|(_, values)| *values = [values[which]; 2]);
            let found = discomfort(&with(&parameters, &alone.sets, which), alone, &events);
            prop_assume!(found[0] <= MOST[0] && found[1] <= MOST[1]);
        }
        let [shake, jolt] = discomfort(&parameters, ride, &events);
        prop_assert!(shake <= MOST[0] && jolt <= MOST[1], "{}: shake {shake}, jolt {jolt} m/s2", set.0);
    }
}
