//! Whatever is commanded, the legs stay inside their stroke, the drives inside their force, and all
//! is finite; and a state continues as its copy does.

use moris_interface::SlotModel;
use moris_stewart_platform::{Input, Model, Output, Parameters, StewartPlatform};
use proptest::prelude::*;

use crate::cranks::with_cranks;

/// A commanded length, sane or not.
fn length() -> impl Strategy<Value = f64> {
    prop_oneof![6 => 0.95..1.65_f64, 2 => -50.0..50.0_f64, 1 => Just(f64::NAN), 1 => Just(1e300), 1 => Just(f64::NEG_INFINITY)]
}

fn velocity() -> impl Strategy<Value = f64> {
    prop_oneof![4 => Just(0.0), 4 => -1.5..1.5_f64, 1 => Just(f64::NAN), 1 => Just(-1e300)]
}

fn input() -> impl Strategy<Value = Input> {
    (prop::array::uniform6(length()), prop::array::uniform6(velocity()), prop_oneof![-1.0..1.0_f64, Just(f64::NAN)])
        .prop_map(|(length, velocity, lean)| Input {
            length,
            velocity,
            lean,
            angle: velocity,
            angular_velocity: length,
        })
}

fn step() -> impl Strategy<Value = f64> {
    prop_oneof![3 => Just(0.001), 2 => 1e-4..0.03_f64, 1 => 1e-9..1e-4_f64, 1 => Just(0.1), 1 => Just(f64::NAN), 1 => Just(-1.0)]
}

fn parameters() -> impl Strategy<Value = Parameters> {
    let actuators = (1.0..400.0_f64, 0.1..3.0_f64, prop_oneof![Just(0.0), 1e-5..0.2_f64], 0.0..1.0_f64);
    let masses = (1.0..2000.0_f64, 0.0..500.0_f64, -0.8..0.8_f64, -0.8..0.8_f64);
    let steps = prop_oneof![Just(0.001), 1e-4..0.01_f64];
    (actuators, masses, steps, any::<bool>()).prop_map(|(actuators, masses, max_step, has_cranks)| {
        let mut parameters = if has_cranks { with_cranks() } else { Parameters::default() };
        let (mass, payload, x, y) = masses;
        parameters.masses.platform_mass = mass;
        parameters.masses.payload_mass = payload;
        parameters.masses.payload_centre.x = x;
        parameters.masses.payload_centre.y = y;
        parameters.setting.max_step = max_step;
        let (bandwidth, damping, dead_time, strength) = actuators;
        parameters.actuators.bandwidth = bandwidth;
        parameters.actuators.damping = damping;
        parameters.actuators.dead_time = dead_time;
        // From hardly enough to carry the platform to plenty.
        parameters.actuators.force_limit = (1.0 + 8.0 * strength * strength) * heaviest_load(&parameters);
        parameters
    })
}

/// The largest force of a leg at rest at neutral \[N\].
fn heaviest_load(parameters: &Parameters) -> f64 {
    let mut strong = *parameters;
    strong.actuators.force_limit = 1e9;
    let forces = StewartPlatform::new(&strong, &Input::default()).unwrap().output().force;
    1.001 * forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()))
}

fn numbers(output: &Output) -> Vec<f64> {
    use moris_interface::{Group, Writer, slot_count};
    let mut values = vec![0.0; slot_count(Output::ROWS)];
    output.write(&mut Writer::new(&mut values));
    values
}

fn check(parameters: &Parameters, platform: &StewartPlatform) -> Result<(), TestCaseError> {
    let output = platform.output();
    for (value, slot) in numbers(&output).into_iter().chain(numbers(&platform.output_derivative())).zip(0..) {
        prop_assert!(value.is_finite(), "output {slot} is {value}");
    }
    let limit = parameters.actuators.force_limit;
    for i in 0..6 {
        let (force, stop) = (output.force[i], output.stop_force[i]);
        let (rig, [start, end]) = (&parameters.rig, parameters.rig.stroke());
        let position = if rig.has_cranks() { rig.crank_arm * output.angle[i] } else { output.length[i] };
        // 0 at the short end, 1 at the long one.
        let place = (position - start) / (end - start);
        prop_assert!((-1e-12..=1.0 + 1e-12).contains(&place), "actuator {i}: {position} m");
        prop_assert!(force.abs() <= limit, "drive {i}: {force}");
        // The long end pulls, the short end pushes.
        prop_assert!(stop == 0.0 || output.at_stop, "stop {i}: {stop}");
        prop_assert!(stop >= 0.0 || place > 0.83, "stop {i}: {stop} at {place}");
        prop_assert!(stop <= 0.0 || place < 0.17, "stop {i}: {stop} at {place}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases::cases(150, 50)))]

    #[test]
    fn nothing_leaves_its_limits(
        parameters in parameters(),
        ride in prop::collection::vec((input(), step(), 1..30_usize), 1..8),
    ) {
        let mut platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
        for (input, step, times) in ride {
            for _ in 0..times {
                platform.step(&input, step);
                check(&parameters, &platform)?;
            }
        }
    }

    #[test]
    fn a_ride_repeats_bit_for_bit(ride in prop::collection::vec((input(), step()), 1..60)) {
        let mut platform = StewartPlatform::new(&Parameters::default(), &Input::default()).unwrap();
        let mut copies = Vec::new();
        for (k, (input, step)) in ride.iter().enumerate() {
            if k % 20 == 7 {
                copies.push((k, platform.clone()));
            }
            platform.step(input, *step);
        }
        for (k, mut copy) in copies {
            ride[k..].iter().for_each(|(input, step)| copy.step(input, *step));
            prop_assert!(copy == platform);
        }
    }
}

/// The same motion whether the host gives slopes, or the commands' rates, or takes smaller steps.
#[test]
fn slopes_rates_and_smaller_steps_say_the_same() {
    let identity = StewartPlatform::IDENTITY;
    let slot = |name: String| identity.slot(&name).unwrap();
    let mut slots = vec![0.0; identity.slots.len()];
    StewartPlatform::start_slots(&mut slots);
    let neutral = slots[slot("command[1].length".to_owned())];
    let ride = |steps: usize, by_slopes: bool| {
        let mut platform = StewartPlatform::from_slots(&slots).unwrap();
        let (mut slots, mut derivatives) = (slots.clone(), vec![0.0; slots.len()]);
        for k in 0..steps {
            for i in 1..=6 {
                let rate = 0.01 * f64::from(i) - 0.035;
                let time = k as f64 / steps as f64;
                slots[slot(format!("command[{i}].length"))] = neutral + rate * time;
                if by_slopes {
                    derivatives[slot(format!("command[{i}].length"))] = rate;
                } else {
                    slots[slot(format!("command[{i}].velocity"))] = rate;
                }
            }
            platform.step_slots(&slots, Some(&derivatives), 1.0 / steps as f64);
        }
        numbers(&platform.output())
    };
    let expected = ride(1000, true);
    for (steps, by_slopes) in [(1000, false), (10, true), (10, false), (5000, true)] {
        for (value, expected) in ride(steps, by_slopes).iter().zip(&expected) {
            assert!((value - expected).abs() < 1e-8 * expected.abs().max(1.0), "{steps}: {value}, not {expected}");
        }
    }
}
