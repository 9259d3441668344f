//! The motorcycle's own lap, ridden again and again by its rider.

use moris_laps::Sample;
use moris_motorcycle::{Course, Input as Command, Model, Motorcycle, Parameters};
use moris_washout::Input;
use moris_washout::interface::AngularVelocityFrame;

/// Time between samples \[s\].
pub const STEP: f64 = 0.02;

/// Inputs of the washout and samples of a ride of so many laps, and the sample at which each lap
/// begins. The rider's pace varies, and gusts from the side move the line.
pub fn ride(laps: usize) -> (Vec<Input>, Vec<Sample>, Vec<usize>) {
    let mut parameters = Parameters::default();
    parameters.path.course = Course::Lap;
    parameters.run.angular_velocity_frame = AngularVelocityFrame::Body;
    let mut motorcycle = Motorcycle::new(&parameters, &Command::default()).unwrap();
    let planned = parameters.path;
    let (mut inputs, mut samples, mut begins) = (Vec::new(), Vec::new(), vec![0]);
    // Of the closed circuit.
    let length = 1634.0;
    for k in 0.. {
        let time = f64::from(k) * STEP;
        let wander = |a: f64, b: f64| (a * time).sin() + 0.6 * (b * time + 1.0).sin();
        if k % 250 == 0 {
            let pace = 1.0 + 0.05 * wander(0.093, 0.271);
            parameters.path.lateral_acceleration = pace * planned.lateral_acceleration;
            parameters.path.forward_acceleration = pace * planned.forward_acceleration;
            parameters.path.deceleration = pace * planned.deceleration;
            motorcycle.retune(&parameters).unwrap();
        }
        let mut command = Command::default();
        command.wind.y = 60.0 * wander(0.31, 0.83);
        for _ in 0..20 {
            motorcycle.step(&command, 0.001);
        }
        let now = motorcycle.output();
        if now.path_distance >= begins.len() as f64 * length {
            begins.push(inputs.len());
            if begins.len() > laps {
                return (inputs, samples, begins);
            }
        }
        assert!(!now.fallen && !now.off_path && time < 120.0 * laps as f64, "{time} s");
        inputs.push(Input {
            specific_force: now.specific_force,
            angular_velocity: now.angular_velocity,
            orientation: now.orientation,
            speed: now.speed,
            lean: now.lean,
            engaged: true,
        });
        samples.push(Sample {
            step: STEP,
            position: now.position.into(),
            speed: Some(now.speed),
            force: [now.specific_force.x, now.specific_force.y],
        });
    }
    unreachable!()
}
