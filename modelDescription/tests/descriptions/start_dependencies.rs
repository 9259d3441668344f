//! Dependencies of the outputs before the first step, as a description lists them.

use std::collections::{BTreeMap, BTreeSet};

use moris_interface::{Causality, Kind, Model, Row, SlotModel};
use moris_motorcycle::Motorcycle;
use moris_stewart_platform::StewartPlatform;
use moris_washout::Washout;

use crate::cases::cases;

/// Start values, over the model's own.
type Values = &'static [(&'static str, f64)];

fn slots<M: Model>(values: Values) -> Vec<f64> {
    let mut slots = vec![0.0; M::IDENTITY.slots.len()];
    M::start_slots(&mut slots);
    for (name, value) in values {
        slots[M::IDENTITY.slot(name).unwrap_or_else(|| panic!("no {name}"))] = *value;
    }
    slots
}

/// Other values of a variable: some near its own, the ends of a small range, all items.
fn others(row: &Row, own: f64) -> Vec<f64> {
    let candidates = match row.kind {
        Kind::Real(_) => vec![own + 1e-3, own * 0.9, own + 0.7],
        _ => (0..7).map(f64::from).collect(),
    };
    // A negative sign or zero is left to all cases.
    candidates.into_iter().rev().take(cases(7, 5)).filter(|value| *value != own && row.accepts(*value)).collect()
}

/// Every input and parameter changed by itself: an output that changes with it must list it.
fn outputs_list_what_they_change_with<M: Model>(starts: &[Values]) {
    let identity = M::IDENTITY;
    // Of an array: the components of the first joint, or all joints.
    let first_elements = cases(18, 3);
    let outputs: Vec<usize> =
        (0..identity.slots.len()).filter(|&slot| identity.row(slot).causality == Causality::Output).collect();
    let mut found: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for values in starts {
        let own = slots::<M>(values);
        let at_start = |slots: &[f64]| {
            let mut slots = slots.to_vec();
            M::from_slots(&slots).ok()?.write_outputs(&mut slots);
            Some(slots)
        };
        let before = at_start(&own).expect("start values are usable");
        for slot in 0..own.len() {
            let known = identity.row(slot);
            let is_set = matches!(known.causality, Causality::Input | Causality::Parameter);
            if !is_set || usize::from(identity.slots[slot].element) >= first_elements {
                continue;
            }
            for value in others(known, own[slot]) {
                let mut changed = own.clone();
                changed[slot] = value;
                let Some(after) = at_start(&changed) else { continue };
                for &output in outputs.iter().filter(|&&output| after[output] != before[output]) {
                    found.entry(identity.row(output).name).or_default().insert(known.name);
                }
            }
        }
    }
    assert!(found.len() > 2, "{found:?}");
    for row in identity.rows.iter().filter(|row| row.causality == Causality::Output) {
        let of_row = found.remove(row.name).unwrap_or_default();
        for known in identity.rows.iter().filter(|known| of_row.contains(known.name)) {
            assert!(row.starts_depending_on(known), "{} changes with {}", row.name, known.name);
        }
    }
}

#[test]
fn of_the_washout() {
    let strategy = |number: f64| -> Values { Box::leak(Box::new([("strategy", number), ("rider.lean", 0.2)])) };
    const OTHERS: Values =
        &[("washoutLocation", 3.0), ("scale.automatic", 2.0), ("rider.lean", 0.1), ("vehicle.speed", 9.0)];
    let starts: Vec<Values> = (1..=5).map(|number| strategy(f64::from(number))).chain([OTHERS]).collect();
    outputs_list_what_they_change_with::<Washout>(&starts);
}

#[test]
fn of_the_motorcycle() {
    const MOVING: Values = &[
        ("initial.speed", 25.0),
        ("initial.heading", 0.4),
        ("command.throttle", 0.5),
        ("command.brake", 0.5),
        ("command.riderLean", 0.1),
        ("wind.force.y", 20.0),
    ];
    const CUSTOM: Values = &[
        ("path.course", 2.0),
        ("path.point.count", 3.0),
        ("path.point.distance[2]", 30.0),
        ("path.point.distance[3]", 300.0),
        ("path.point.curvature[2]", 0.02),
        ("path.point.speed[1]", 14.0),
        ("path.point.speed[2]", 12.0),
        ("path.point.speed[3]", 20.0),
        ("initial.speed", 12.0),
    ];
    outputs_list_what_they_change_with::<Motorcycle>(&[MOVING, CUSTOM]);
}

#[test]
fn of_the_platform() {
    const LEANING: Values = &[("rider.lean", 0.3), ("command[1].velocity", 0.1), ("command[2].length", 1.2)];
    outputs_list_what_they_change_with::<StewartPlatform>(&[&[], LEANING]);
}
