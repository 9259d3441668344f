//! The equations on tyres that slip, against Whipple's where the tyres are stiff.

use moris_motorcycle::lateral::{Design, Lateral, Torso, Tyre};
use moris_motorcycle::whipple::Bicycle;
use moris_motorcycle::{Parameters, lateral};
use nalgebra::Complex;

use crate::common::{GRAVITY, benchmark};

fn on_stiff_tyres(bicycle: Bicycle, stiffness: f64, relaxation: f64) -> Lateral {
    let tyre = Tyre { cornering: stiffness, camber: 0.9 * 400.0, relaxation };
    let torso = Torso { mass: 0.0, arm: 0.0, x: 0.0, height: 0.0, inertia: 0.0 };
    let design = Design {
        bicycle,
        rear: tyre,
        front: tyre,
        steer_damping: 0.0,
        torso,
        wind_x: 0.0,
        wind_height: 0.0,
        gravity: GRAVITY,
    };
    Lateral::new(&design).unwrap()
}

/// Largest distance of an eigenvalue of Whipple's model from the nearest of the model with tyres.
fn distance(bicycle: Bicycle, speed: f64, stiffness: f64, relaxation: f64) -> f64 {
    let tyred = on_stiff_tyres(bicycle, stiffness, relaxation).state_matrix(speed, 0.0).complex_eigenvalues();
    let whipple = bicycle.equations().state_matrix(GRAVITY, speed).unwrap().complex_eigenvalues();
    let nearest = |value: &Complex<f64>| tyred.iter().map(|other| (other - value).norm()).fold(f64::MAX, f64::min);
    whipple.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn on_ever_stiffer_tyres_the_eigenvalues_become_whipples() {
    let motorcycle = lateral::bicycle(&Parameters::default().machine);
    for bicycle in [benchmark(), motorcycle] {
        for speed in [1.0, 3.0, 5.0, 8.0] {
            for relaxation in [0.01, 0.2] {
                let [soft, stiff, stiffer] =
                    [1e5, 1e6, 1e7].map(|stiffness| distance(bicycle, speed, stiffness, relaxation));
                // What is left goes with the tyres' compliance: a tenth for ten times the stiffness.
                for ratio in [soft / stiff, stiff / stiffer] {
                    assert!((7.0..14.0).contains(&ratio), "{ratio} at {speed} m/s, relaxation {relaxation} m");
                }
                assert!(stiffer < 0.02, "{stiffer} at {speed} m/s, relaxation {relaxation} m");
            }
        }
    }
}

#[test]
fn on_the_stiffest_tyres_the_benchmarks_eigenvalues_are_met_to_five_digits() {
    for speed in [1.0, 3.0, 5.0] {
        let off = distance(benchmark(), speed, 1e8, 0.2);
        assert!(off < 1e-4, "{off} at {speed} m/s");
    }
}

#[test]
fn the_default_motorcycle_weaves_and_wobbles_as_motorcycles_do() {
    // After Cossalter, Motorcycle Dynamics: weave at 0 to 4 Hz, wobble at 4 to 10 Hz.
    let design = Design::new(&Parameters::default());
    let modes = Lateral::new(&design).unwrap().state_matrix(30.0, 0.0).complex_eigenvalues();
    let mut hertz: Vec<_> =
        modes.iter().filter(|mode| mode.im > 1.0).map(|mode| mode.norm() / (2.0 * std::f64::consts::PI)).collect();
    hertz.sort_by(f64::total_cmp);
    assert_eq!(hertz.len(), 2, "{hertz:?}");
    assert!((2.0..4.0).contains(&hertz[0]) && (6.0..10.0).contains(&hertz[1]), "{hertz:?} Hz");
}
