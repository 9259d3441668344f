//! Writes pages for tests, and their data as plain JSON:
//! `cargo run -p moris-pages --example pages -- DIRECTORY`.
//!
//! The recording shows all parts of a report: all axes, and each kind of limit.

use std::f64::consts::TAU;
use std::path::Path;
use std::process::exit;

use moris_pages::report::{Chart, LimitHistory, Line, Report, Run, Thinning, Vehicle, html, run};
use moris_simulation::measures::{Better, Row};
use moris_simulation::{Evaluated, Finding, Manoeuvre, Replay, Simulation, Weight};
use moris_washout::{Input, Parameters, presets};
use serde_json::json;

fn main() {
    let Some(directory) = std::env::args_os().nth(1) else {
        eprintln!("error: say into which directory: pages DIRECTORY");
        exit(2);
    };
    let directory = Path::new(&directory);
    let written = std::fs::create_dir_all(directory).and_then(|()| {
        write_page(directory, "two-runs", &two_runs())?;
        write_page(directory, "hostile", &hostile_report())?;
        write_page(directory, "long", &long_report())
    });
    if let Err(error) = written {
        eprintln!("error: {}: {error}", directory.display());
        exit(1);
    }
}

fn write_page(directory: &Path, name: &str, report: &Report) -> std::io::Result<()> {
    std::fs::write(directory.join(format!("{name}.html")), html(report))?;
    let runs: Vec<_> = report
        .runs
        .iter()
        .map(|run| {
            let LimitHistory { tilt, soft, safety, actuator, .. } = &run.limited;
            json!({
                "limited": { "tilt": tilt, "soft": soft, "safety": safety, "actuator": actuator },
                "name": run.name, "times": run.times, "position": run.position, "orientation": run.orientation,
                "legs": run.legs, "lean": run.lean, "felt": run.felt.specific_force, "measures": run.measures,
            })
        })
        .collect();
    let plain = json!({ "title": report.title, "subtitle": report.subtitle, "rig": report.rig, "runs": runs });
    std::fs::write(directory.join(format!("{name}.json")), plain.to_string())
}

fn two_runs() -> Report {
    let shipped = presets::parameters(presets::CLASSICAL);
    let mut soft = shipped;
    soft.conditioning.force_scale.fill(0.7);
    soft.conditioning.rate_scale.fill(0.3);
    let small_motions = presets::parameters(include_str!("../../../../../examples/paper-runs/small-motions.toml"));
    Report {
        vehicle: Vehicle::Motorcycle,
        title: "Out of town and a brusque stop".into(),
        subtitle: "A computed ride of 60 s on the default rig, with the shipped parameters and two others".into(),
        findings: vec![new_finding(Weight::Note, "The ride is computed.")],
        provenance: vec![("ride".into(), "computed".into()), ("step".into(), "0.01 s".into())],
        rig: (&shipped).into(),
        runs: vec![
            Run {
                findings: vec![new_finding(Weight::Good, "No leg comes to the end of its stroke.")],
                ..simulated_run("default", &shipped, 60.0, 0.01)
            },
            Run {
                findings: vec![new_finding(Weight::Note, "The brusque stop is felt for four seconds less.")],
                ..simulated_run("soft", &soft, 60.0, 0.01)
            },
            Run {
                findings: vec![new_finding(Weight::Warning, "The safety units hold the platform back.")],
                ..simulated_run("small-motions", &small_motions, 60.0, 0.01)
            },
        ],
        selected: 0,
        simulator: None,
        no_simulator_because: None,
    }
}

fn new_finding(weight: Weight, text: &str) -> Finding {
    Finding { weight, text: text.into() }
}

fn hostile_report() -> Report {
    // Text that would run a script, end an element, or break out of a string if it were not
    // escaped.
    const HOSTILE: &str = "</script><script>alert(1)</script><img src=x onerror=alert(2)> \"&lt;' {{data}} \u{2028} ?";
    let mut run = simulated_run(HOSTILE, &Parameters::default(), 5.0, 0.01);
    run.measures.push(Row {
        subject: HOSTILE.into(),
        name: HOSTILE,
        value: Some(1.0),
        unit: HOSTILE,
        definition: HOSTILE,
        source: HOSTILE,
        better: Better::Neither,
    });
    run.charts.push(Chart {
        title: HOSTILE.into(),
        quantity: HOSTILE.into(),
        times: vec![0.0, 2.5, 5.0],
        lines: vec![Line { label: HOSTILE.into(), values: vec![1.0, f64::NAN, 2.0] }],
        limits: vec![],
    });
    Report {
        vehicle: Vehicle::Car,
        title: HOSTILE.into(),
        subtitle: HOSTILE.into(),
        findings: vec![new_finding(Weight::Warning, HOSTILE)],
        provenance: vec![(HOSTILE.into(), HOSTILE.into())],
        rig: (&Parameters::default()).into(),
        runs: vec![run.clone(), run],
        selected: 1,
        simulator: None,
        no_simulator_because: None,
    }
}

/// Two minutes at 1 kHz.
fn long_report() -> Report {
    let parameters = Parameters::default();
    Report {
        title: "Two minutes at 1 kHz".into(),
        rig: (&parameters).into(),
        runs: vec![simulated_run("default", &parameters, 120.0, 0.001)],
        ..Report::default()
    }
}

/// A smooth rise from 0 to 1 that begins at `start` and takes `duration` \[s\].
fn smooth_rise(t: f64, start: f64, duration: f64) -> f64 {
    let x = ((t - start) / duration).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Accelerate, bends and bumps, and an abrupt stop at 40 s.
fn ride_input(t: f64) -> Input {
    const GRAVITY: f64 = 9.80665;
    let surge = 2.2 * (smooth_rise(t, 1.0, 3.0) - smooth_rise(t, 10.0, 3.0));
    let brake = if t < 40.0 { -3.5 * smooth_rise(t, 32.0, 4.0) } else { 0.0 };
    let bends = smooth_rise(t, 14.0, 2.0) - smooth_rise(t, 28.0, 2.0);
    let sway = 0.8 * bends * (TAU * 0.25 * t).sin();
    let bumps = 0.6 * bends * (TAU * 1.5 * t).sin() + if (35.0..35.05).contains(&t) { 25.0 } else { 0.0 };
    let mut input = Input::default();
    input.specific_force.x = surge + brake;
    input.specific_force.y = sway;
    input.specific_force.z = GRAVITY + bumps;
    input.angular_velocity.x = 0.25 * bends * (TAU * 0.25 * t).cos();
    input.angular_velocity.z = 0.15 * bends * (TAU * 0.25 * t).sin();
    input.lean = 0.2 * bends * (TAU * 0.125 * t).sin();
    input
}

/// The ride with these parameters, in this step \[s\], with a few rows for the table.
fn simulated_run(name: &str, parameters: &Parameters, duration: f64, step: f64) -> Run {
    let manoeuvre = Manoeuvre::sampled(step, duration, ride_input);
    let simulation = Simulation::of(&Replay::new(&manoeuvre), parameters, || ()).expect("the parameters are good");
    let measures = moris_simulation::measures(&simulation).expect("a ride has more than one sample");
    let evaluated = Evaluated { simulation: &simulation, measures: &measures, bounds: [None; 3], advice: None };
    let samples = simulation.inputs.len();
    let mut run = Run { verdict: Finding::default(), ..run(&evaluated, name, &Thinning::new(samples, samples)) };
    run.measures.retain(|row| row.subject.starts_with("Specific force") && row.name.ends_with("error"));
    run
}
