//! The motorcycle beside the washout: that both mean the same by the same names.

use moris_motorcycle::{Input, Model, Output};
use moris_washout::cueing::conditioning::cue;
use moris_washout::interface::GravityRemoval;
use moris_washout::{Parameters as Tuning, Washout, presets};
use nalgebra::{Rotation3, Vector3};

use crate::common::{at_speed, motorcycle};

/// Connection by name, as a host makes it.
fn connected(output: &Output) -> moris_washout::Input {
    moris_washout::Input {
        specific_force: output.specific_force,
        angular_velocity: output.angular_velocity,
        orientation: output.orientation,
        speed: output.speed,
        lean: output.lean,
        engaged: true,
    }
}

fn ride(time: f64) -> Input {
    Input {
        throttle: if time < 3.0 { 0.4 } else { 0.1 },
        brake: if time > 12.0 { 0.4 } else { 0.0 },
        lean: 0.35 * (1.2 * time).sin(),
        rider_lean: 0.1 * (0.9 * time).sin(),
        ..Input::default()
    }
}

#[test]
fn without_gravity_the_washout_is_left_with_the_heads_acceleration_and_the_angles_rates() {
    let mut tuning = presets::parameters(presets::PAPER).conditioning;
    tuning.gravity_removal = GravityRemoval::Full;
    tuning.force_limit = Vector3::repeat(1e6);
    tuning.rate_limit = Vector3::repeat(1e6);
    let step = 5e-4;
    let mut vehicle = motorcycle(&at_speed(15.0));
    let mut last = [vehicle.output(); 3];
    for k in 0..20_000 {
        let time = f64::from(k) * step;
        vehicle.step_between(&ride(time), &ride(time + step), step);
        last = [last[1], last[2], vehicle.output()];
        let [before, now, after] = &last;
        // Differences take no notice of the instants at which the throttle jumps.
        if k < 10 || (time - 3.0).abs() < 0.01 {
            continue;
        }
        let cued = cue(&connected(now), &tuning, 9.80665, now.lean);
        let acceleration = (after.head_velocity - before.head_velocity) / (2.0 * step);
        let o = now.orientation;
        let head = Rotation3::from_euler_angles(o.roll, o.pitch, o.yaw)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), now.lean);
        assert!((cued.force - head.inverse() * acceleration).norm() < 5e-3, "{} at {time} s", cued.force);
        let rates = (after.orientation.to_vector() - before.orientation.to_vector()) / (2.0 * step);
        assert!((cued.rates - rates).norm() < 1e-4, "{} instead of {rates} at {time} s", cued.rates);
    }
}

#[test]
fn on_a_whole_ride_the_washout_keeps_the_legs_in_their_stroke() {
    let mut washout = Washout::new(&Tuning::default()).unwrap();
    let mut vehicle = motorcycle(&at_speed(0.0));
    for k in 0..40_000 {
        let before = connected(&vehicle.output());
        let time = f64::from(k) * 1e-3;
        vehicle.step(&ride(time), 1e-3);
        washout.step_between(&before, &connected(&vehicle.output()), 1e-3);
        let output = washout.output();
        assert!(output.length.iter().all(|length| (1.0..=1.6).contains(length)));
        if time > 20.0 {
            assert_eq!(vehicle.output().speed, 0.0);
        }
    }
    // More than twenty seconds after the stop surge and heave are back; sway follows the rider, who goes on balancing.
    let off = washout.output().position - Vector3::new(0.0, 0.0, Tuning::default().rig.neutral_height);
    assert!(off.xz().norm() < 0.005 && off.y.abs() < 0.1, "{off}");
}

/// Rides at 30 m/s and brakes to the stop. Returns when it stops, in milliseconds, and the error of
/// the surge force felt \[m/s2\] every millisecond.
fn errors_of_a_stop(brake: f64, set: &str) -> (usize, Vec<f64>) {
    let mut washout = Washout::new(&presets::with(presets::PAPER, &presets::values(set))).unwrap();
    let mut vehicle = motorcycle(&at_speed(30.0));
    let mut stop = None;
    let errors = (0..40_000).map(|k| {
        let before = connected(&vehicle.output());
        let time = 1e-3 * k as f64;
        let throttle = if time < 3.0 { 0.15 } else { 0.0 };
        let brake = brake * ((time - 3.0) / 3.0).clamp(0.0, 1.0);
        vehicle.step(&Input { throttle, brake, ..Input::default() }, 1e-3);
        let asked = connected(&vehicle.output());
        washout.step_between(&before, &asked, 1e-3);
        if asked.speed == 0.0 {
            stop.get_or_insert(k);
        }
        let output = washout.output();
        assert!(!output.actuator_limited && !output.safety_active, "at {time} s");
        output.felt_specific_force.x - asked.specific_force.x
    });
    let errors = errors.collect();
    (stop.expect("the motorcycle stops"), errors)
}

/// From 5 s before the stop to 5 s after it the RMS error, and the largest after it.
#[test]
fn preaction_halves_the_error_of_a_stop() {
    for brake in [0.1, 0.15, 0.2] {
        let [(rms_off, peak_off), (rms, peak)] = ["", "\"preaction\" = \"on\""].map(|set| {
            let (stop, errors) = errors_of_a_stop(brake, set);
            let around = &errors[stop - 5000..stop + 5000];
            let rms = (around.iter().map(|error| error * error).sum::<f64>() / around.len() as f64).sqrt();
            (rms, errors[stop..stop + 8000].iter().fold(0.0_f64, |peak, error| peak.max(error.abs())))
        });
        println!("brake {brake}: RMS {rms_off} {rms}, peak {peak_off} {peak}");
        assert!(rms < 0.5 * rms_off, "{rms_off} {rms}");
        assert!(peak < 0.6 * peak_off, "{peak_off} {peak}");
    }
}
