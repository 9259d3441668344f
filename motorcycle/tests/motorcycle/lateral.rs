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

/// How far the farthest of Whipple's eigenvalues is from the nearest of the tyred model's.
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
        for speed in [1.0, 3.0, 5.0, 8.0, 20.0, 40.0] {
            for relaxation in [0.01, 0.2] {
                let distances = [1e6, 1e7, 1e8].map(|stiffness| distance(bicycle, speed, stiffness, relaxation));
                println!("{speed} {relaxation} {distances:?}");
            }
        }
    }
}
