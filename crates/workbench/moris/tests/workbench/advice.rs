//! Following a verdict ends at a better motion: on drives, rigs and sets.

use moris::recording::Recording;
use moris::simulate::Outcome;
use moris_analysis::bench::drives::{BENCH_DRIVES, RATE_FRAME};
use moris_setup::Setup;
use moris_simulation::channels::channels;
use moris_simulation::preview::Previewer;
use moris_simulation::verdict::Fault;
use moris_simulation::{Manoeuvre, Weight};
use moris_washout::platform::reach::Axis;

use crate::cases::cases;

/// What of a motion is judged, from its measures alone: each the smaller the better, with the value
/// up to which it does not matter.
fn figures(outcome: &Outcome) -> Vec<(String, f64, f64)> {
    let measures = &outcome.measures;
    let limited = measures.effort.limited;
    let comfort =
        |which: usize| measures.comfort.iter().flatten().map(|comfort| comfort.values()[which]).fold(0.0, f64::max);
    let axes = measures.shape.axes.iter().flatten();
    let mut figures = vec![
        ("limited".to_owned(), limited.safety.max(limited.actuator), 0.0),
        ("inverted".to_owned(), axes.clone().map(|axis| axis.inverted).fold(0.0, f64::max), 0.02),
        ("shake".to_owned(), comfort(0), 0.1),
        ("jolt".to_owned(), comfort(1), 1.0),
        ("disproportion".to_owned(), axes.map(|axis| 1.0 - axis.shape).fold(0.0, f64::max), 0.15),
    ];
    for channel in channels(&outcome.evaluated()) {
        let name = channel.axis.name();
        let is_desired = channel.at_rest >= if channel.axis.is_rotation() { 1_f64.to_radians() } else { 0.05 };
        let error = channel.without_tilt.unwrap_or(channel.felt.rms_error);
        let least = if channel.axis.is_rotation() { 1_f64.to_radians() } else { 0.0 };
        if error > if is_desired { 1.05 * channel.at_rest } else { least } {
            figures.push((format!("{name} false"), channel.cues.false_cues, 0.05));
        }
    }
    figures
}

/// The name of a fault's figures.
fn figure_of(fault: Fault) -> Vec<String> {
    let names: &[&str] = match fault {
        Fault::Limits => &["limited"],
        Fault::Inverted => &["inverted"],
        Fault::Rough => &["shake", "jolt"],
        Fault::WorseThanRest(axis) => return vec![format!("{} false", axis.name())],
        Fault::Disproportion => &["disproportion"],
    };
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn simulated(recording: &Recording, setup: &Setup, preview: f64) -> Outcome {
    Outcome::of(recording, setup, Previewer::of(&recording.manoeuvre, preview), || ()).unwrap()
}

/// Follows all advice once; returns how many verdicts were followed.
fn follow(recording: &Recording, setup: &Setup) -> usize {
    let about = format!("{} on {} with {}", recording.name, setup.rig_name, setup.parameters_name);
    let before = simulated(recording, setup, 0.0).advised(recording, 0.0).unwrap();
    let verdict = before.evaluated().verdict();
    let Some(fault) = before.evaluated().fault() else {
        assert!(verdict.weight == Weight::Good && before.advice.is_none(), "{about}: {}", verdict.text);
        return 0;
    };
    assert!(verdict.weight != Weight::Good, "{about}: {}", verdict.text);
    let advice = before.advice.as_ref().expect("a fault has advice, if only that nothing is better");
    let named: Vec<_> = [advice.recommended(), advice.conditional()].into_iter().flatten().collect();
    for alternative in &named {
        // The changes alone, as a user applies them to the parameters.
        let parameters = alternative.changes.applied(&setup.parameters);
        let preview = alternative.changes.preview.unwrap_or(0.0);
        let after = simulated(recording, &Setup { parameters, ..setup.clone() }, preview);
        let value = |outcome: &Outcome, name: &str| {
            figures(outcome).into_iter().find(|(other, ..)| other == name).map(|(_, value, allowed)| (value, allowed))
        };
        let excess = |outcome: &Outcome| {
            let excess = |name: &String| value(outcome, name).map(|(value, allowed)| value / f64::max(allowed, 1e-6));
            figure_of(fault).iter().filter_map(excess).fold(0.0, f64::max)
        };
        let text = format!("{about}: {} But:", verdict.text);
        assert!(excess(&after) < 0.96 * excess(&before), "{text} {} to {}", excess(&before), excess(&after));
        for (name, after, allowed) in figures(&after).into_iter().filter(|(name, ..)| !figure_of(fault).contains(name))
        {
            let before = value(&before, &name).map_or(0.0, |(value, _)| value);
            assert!(after <= allowed.max(1.06 * before), "{text} {name} from {before} to {after}");
        }
        let size = after.measures.shape.size().map(|size| format!("at {:.0} % of the vehicle's force", 100.0 * size));
        assert!(size.is_none_or(|size| verdict.text.contains(&size)), "{text} {:?}", after.measures.shape.size());
    }
    assert_eq!(named.is_empty(), verdict.text.contains("No other scale"), "{about}: {}", verdict.text);
    named.len()
}

/// An example's rig with a set.
fn on_rig(rig: &str, set: &str) -> Setup {
    let file = format!("{}/../../../examples/rigs/{rig}.toml", env!("CARGO_MANIFEST_DIR"));
    Setup::load(Some(file.as_ref()), &[set.to_owned()]).unwrap()
}

#[test]
fn following_a_verdict_makes_what_it_names_better_and_nothing_else_worse() {
    let drives = cases(
        &[
            "paper-a",
            "paper-b",
            "paper-c",
            "lane-change",
            "slalom",
            "emergency-stop",
            "roundabout",
            "motorway",
            "kart-lap",
            "flight",
        ][..],
        &["paper-b", "lane-change"],
    );
    let rigs = cases(&["hobby100", "default", "flight091"][..], &["hobby200", "default"]);
    let sets = cases(&["default", "classical", "robust"][..], &["default", "paper"]);
    let mut followed = 0;
    for drive in BENCH_DRIVES.iter().filter(|drive| drives.contains(&drive.name.as_str())) {
        let recording = Recording::computed(&drive.name, drive.manoeuvre(), RATE_FRAME);
        for rig in rigs {
            for set in sets {
                followed += follow(&recording, &on_rig(rig, set));
            }
        }
    }
    assert!(followed >= drives.len() * rigs.len(), "{followed} verdicts were followed");
}

#[test]
fn a_rate_that_is_felt_falsely_gets_smaller_rates_and_tilt_alone_is_no_fault() {
    // Bends at a constant speed: the tilt rolls the rider to the other side than the car does.
    let bends = |rate_scale: f64, rates: [f64; 3], omega: f64| {
        let mut setup = Setup::load(None, &[]).unwrap();
        setup.parameters.conditioning.rate_scale.fill(rate_scale);
        let manoeuvre = Manoeuvre::sampled(0.01, 40.0, |t| {
            let mut input = moris_washout::Input::default();
            let fade = (t / 2.0).min(1.0);
            input.specific_force.y = 0.8 * fade * (0.4 * t).sin();
            input.angular_velocity = nalgebra::Vector3::from(rates) * fade * (omega * t).sin();
            input
        });
        let recording = Recording::computed("bends", manoeuvre, RATE_FRAME);
        (simulated(&recording, &setup, 0.0).advised(&recording, 0.0).unwrap(), recording, setup)
    };
    let (tilted, ..) = bends(0.0, [0.04, 0.0, 0.0], 0.4);
    let roll = channels(&tilted.evaluated()).into_iter().find(|channel| channel.axis == Axis::Roll).unwrap();
    // The rotation of tilt coordination alone is a larger error than none; without it there is none but the vehicle's.
    let without_tilt = roll.without_tilt.unwrap() / roll.at_rest;
    assert!(roll.ratio() > 1.05 && (without_tilt - 1.0).abs() < 0.02, "{} {without_tilt}", roll.ratio());
    assert_eq!(tilted.evaluated().fault(), None, "{}", tilted.evaluated().verdict().text);
    let (shaken, recording, setup) = bends(-1.0, [0.0, 0.0, 0.15], 2.0);
    assert_eq!(
        shaken.evaluated().fault(),
        Some(Fault::WorseThanRest(Axis::Yaw)),
        "{}",
        shaken.evaluated().verdict().text
    );
    assert!(follow(&recording, &setup) >= 1);
}
