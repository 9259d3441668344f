//! Parameters that cannot be used are refused with the variable's name and the reason.

use moris_interface::{Causality, Kind, Model, ParameterError, SlotModel};
use moris_washout::{Input, Washout, check};

use crate::common::parameters;

fn refusal(changed: &[(&str, f64)]) -> ParameterError {
    check(&parameters(changed)).expect_err(&format!("{changed:?} must be refused"))
}

/// Names of all real parameters.
fn real_parameters() -> Vec<String> {
    let identity = Washout::IDENTITY;
    (0..identity.slots.len())
        .filter(|&slot| {
            let row = identity.row(slot);
            row.causality == Causality::Parameter && matches!(row.kind, Kind::Real(_))
        })
        .map(|slot| identity.variable_name(slot))
        .collect()
}

#[test]
fn what_is_not_a_finite_number_is_refused_for_every_parameter() {
    for name in real_parameters() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let refusal = refusal(&[(&name, value)]);
            assert_eq!(refusal.variable, name);
            assert!(refusal.reason.contains("finite"), "{refusal}");
        }
    }
}

#[test]
fn what_must_be_above_zero_is_refused_at_zero_and_below() {
    for name in real_parameters() {
        let any_sign = [
            "rig.base[",
            "rig.neutralHeight",
            "rig.platform[",
            "washoutPoint.",
            "scale.",
            "crank.heading[",
            "crank.minAngle",
            "crank.maxAngle",
        ];
        if any_sign.iter().any(|prefix| name.starts_with(prefix)) {
            continue;
        }
        let may_be_zero = [
            "input.cutoff",
            "input.rateCutoff",
            "head.height",
            "head.torsoLength",
            "softLimit.pace",
            "softLimit.margin",
            "crank.arm",
            "crank.rod",
        ]
        .contains(&name.as_str());
        let bad = if may_be_zero { vec![-1.0] } else { vec![-1.0, 0.0] };
        for value in bad {
            let refusal = refusal(&[(&name, value)]);
            assert_eq!(refusal.variable, name, "{refusal}");
            assert!(refusal.reason.contains(&format!("is {value}")), "{refusal}");
        }
    }
}

#[test]
fn what_is_out_of_its_range_is_refused() {
    for (name, value) in [
        ("splitter.order", 1.0),
        ("splitter.order", 5.0),
        ("angular.order", 0.0),
        ("tilt.angleLimit", 1.5),
        ("solver.maxStep", 1.0),
        ("solver.maxStep", 1e-7),
        ("splitter.x.omega1", 1e4),
        ("splitter.z.lowPassOmega", 1e-7),
        ("angular.yaw.zeta2", 1e3),
        ("head.torsoLength", 1.3),
        ("actuator.minLength", 1.7),
        ("rig.neutralHeight", 0.2),
    ] {
        let refusal = refusal(&[(name, value)]);
        assert_eq!(refusal.variable, name, "{refusal}");
        assert!(refusal.to_string().starts_with(name) && refusal.reason.len() > 10, "{refusal}");
    }
}

fn extreme_lengths_at_neutral() -> [f64; 2] {
    let lengths = Washout::new(&parameters(&[])).unwrap().output().length;
    [lengths.into_iter().fold(f64::INFINITY, f64::min), lengths.into_iter().fold(0.0, f64::max)]
}

#[test]
fn a_leg_at_an_end_of_its_stroke_at_neutral_is_refused() {
    let [shortest, longest] = extreme_lengths_at_neutral();
    for end in [("actuator.maxLength", longest), ("actuator.minLength", shortest)] {
        let refusal = refusal(&[end]);
        assert_eq!(refusal.variable, "rig.neutralHeight", "{refusal}");
    }
}

#[test]
fn less_stroke_at_neutral_than_a_leg_moves_in_half_a_step_is_refused() {
    let [shortest, longest] = extreme_lengths_at_neutral();
    // A h^2/8 at 100 m/s2 and V h/2 at 1.25 m/s, both in steps of 50 ms.
    for velocity_limit in [5.0, 1.25] {
        const RESERVE: f64 = 0.03125;
        let with = |end: &str, length: f64| {
            check(&parameters(&[
                ("solver.maxStep", 0.05),
                ("actuator.accelerationLimit", 100.0),
                ("actuator.velocityLimit", velocity_limit),
                (end, length),
            ]))
        };
        for (end, neutral, outwards) in [("actuator.maxLength", longest, 1.0), ("actuator.minLength", shortest, -1.0)] {
            assert_eq!(with(end, neutral + outwards * (RESERVE + 1e-9)), Ok(()));
            for reserve in [RESERVE, RESERVE - 1e-9] {
                let refusal = with(end, neutral + outwards * reserve).unwrap_err();
                assert_eq!(refusal.variable, "solver.maxStep");
                assert!(
                    refusal.reason.contains("up to 0.0312 m") && refusal.reason.contains("only 0.0312 m"),
                    "{refusal}"
                );
            }
        }
    }
}

#[test]
fn weights_and_limits_without_a_regulator_are_refused_by_the_strategys_name() {
    for (strategy, prefix) in [(3.0, "optimal"), (4.0, "predictive"), (5.0, "robust")] {
        let weight = |name: &str, value: f64| (format!("{prefix}.{name}"), value);
        let extreme = [
            weight("weightPosition", 33.0),
            weight("weightVelocity", 5.7e5),
            weight("weightTiltRate", 1.5e-4),
            weight("weightTiltAcceleration", 3.9e-5),
            weight("slowPole", 0.016),
            weight("fastPole", 4.4),
        ];
        let mut changed = vec![
            ("strategy", strategy),
            ("safety.x.positionLimit", 3.9e5),
            ("safety.x.velocityLimit", 6.3e-9),
            ("tilt.rateLimit", 1.9e-7),
            ("tilt.accelerationLimit", 560.0),
            ("tilt.angleLimit", 2e-4),
        ];
        let mut washout = Washout::new(&parameters(&[("strategy", strategy)])).unwrap();
        let before = washout.clone();
        changed.extend(extreme.iter().map(|(name, value)| (name.as_str(), *value)));
        let unusable = parameters(&changed);
        for refusal in [Washout::new(&unusable).unwrap_err(), washout.retune(&unusable).unwrap_err()] {
            assert_eq!(refusal.variable, "strategy");
            // The weight of travel is one cause among others.
            assert!(!refusal.reason.contains("weightPosition"), "{refusal}");
            for part in [&format!("is {prefix}, "), &format!("{prefix}.*"), "safety.*", "tilt.*", "Riccati"] {
                assert!(refusal.reason.contains(part), "{part}: {refusal}");
            }
        }
        assert_eq!(washout, before);
    }
}

#[test]
fn a_plan_whose_program_is_not_convex_is_refused_for_that_reason() {
    let extreme = [("strategy", 4.0), ("safety.x.velocityLimit", 1e-7), ("predictive.weightVelocity", 1e4)];
    let refusal = Washout::new(&parameters(&extreme)).unwrap_err();
    assert_eq!(refusal.variable, "strategy");
    assert!(refusal.reason.contains("not convex") && !refusal.reason.contains("Riccati"), "{refusal}");
}

#[test]
fn limits_without_a_regulator_of_the_automatic_scale_are_refused_by_the_name_of_a_parameter() {
    let extreme = [
        ("scale.automatic", 2.0),
        ("safety.x.positionLimit", 3.9e5),
        ("safety.x.velocityLimit", 6.3e-9),
        ("tilt.rateLimit", 1.9e-7),
        ("tilt.accelerationLimit", 560.0),
        ("tilt.angleLimit", 2e-4),
    ];
    let refusal = Washout::new(&parameters(&extreme)).unwrap_err();
    assert!(Washout::IDENTITY.slot(&refusal.variable).is_some(), "{refusal}");
    assert!(refusal.variable == "scale.automatic" && refusal.reason.contains("Riccati"), "{refusal}");
}

#[test]
fn the_model_refuses_alike_and_retuning_changes_nothing() {
    let mut slots = vec![0.0; Washout::IDENTITY.slots.len()];
    Washout::start_slots(&mut slots);
    let mut washout = Washout::from_slots(&slots).unwrap();
    let before = washout.clone();
    slots[Washout::IDENTITY.slot("tilt.rateLimit").unwrap()] = -1.0;
    assert_eq!(washout.retune_from(&slots).unwrap_err().variable, "tilt.rateLimit");
    assert_eq!(Washout::from_slots(&slots).unwrap_err().variable, "tilt.rateLimit");
    assert_eq!(washout, before);
}

#[test]
fn parameters_so_extreme_that_arithmetic_fails_are_refused_or_survived() {
    for name in real_parameters() {
        for value in [1e-300, 1e-30, 1e-9, 1e4, 1e9, 1e30, 1e300] {
            let Ok(mut washout) = Washout::new(&parameters(&[(&name, value)])) else { continue };
            for k in 0..200 {
                let mut input = Input::default();
                input.specific_force.x += if k < 100 { 3.0 } else { 0.0 };
                input.specific_force.y -= 2.0;
                input.angular_velocity.fill(0.3);
                washout.step(&input, 0.001);
            }
            let output = washout.output();
            assert!(output.position.iter().all(|p| p.is_finite()), "{name} = {value}");
            assert!(output.length.iter().all(|length| (1.0..=1.6).contains(length)) || name.starts_with("actuator"));
            assert!(output.felt_specific_force.iter().all(|f| f.is_finite()), "{name} = {value}");
            assert!(washout.retune(&parameters(&[(&name, value), ("tilt.rateLimit", 0.05)])).is_ok());
        }
    }
}
