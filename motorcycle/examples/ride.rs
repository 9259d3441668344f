//! Rides: accelerates, slaloms, takes a turn and brakes to a stop. Prints a CSV table of the ride.

use std::error::Error;

use moris_motorcycle::{Input, Motorcycle, Parameters};

/// What the rider is told at a time \[s\].
fn command(time: f64) -> Input {
    let within = |begin: f64, end: f64| time >= begin && time < end;
    let throttle = if within(1.0, 6.0) {
        0.5
    } else if within(6.0, 26.0) {
        0.12
    } else {
        0.0
    };
    let brake = if time >= 27.0 { 0.6 } else { 0.0 };
    let slalom = (15.0_f64).to_radians() * (2.0 * std::f64::consts::PI * 0.25 * (time - 8.0)).sin();
    let lean = if within(8.0, 16.0) {
        slalom
    } else if within(18.0, 24.0) {
        -(30.0_f64).to_radians()
    } else {
        0.0
    };
    Input { throttle, brake, lean, ..Input::default() }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut motorcycle = Motorcycle::new(&Parameters::default(), &Input::default())?;
    println!(
        "time,speed,x,y,roll,pitch,yaw,ax,ay,az,wx,wy,wz,steer,torque,rider,front_load,rear_load,front_travel,rear_travel,reference,fl,rl"
    );
    for k in 0..40_000 {
        let time = f64::from(k) * 0.001;
        motorcycle.step_between(&command(time), &command(time + 0.001), 0.001);
        if k % 5 == 4 {
            let o = motorcycle.output();
            let (f, w, r) = (o.specific_force, o.angular_velocity, o.orientation);
            println!(
                "{:.3},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                time + 0.001,
                o.speed,
                o.position.x,
                o.position.y,
                r.roll,
                r.pitch,
                r.yaw,
                f.x,
                f.y,
                f.z,
                w.x,
                w.y,
                w.z,
                o.steer_angle,
                o.steer_torque,
                o.lean,
                o.front_load,
                o.rear_load,
                o.front_travel,
                o.rear_travel,
                o.lean_reference,
                o.front_lateral,
                o.rear_lateral
            );
        }
    }
    Ok(())
}
