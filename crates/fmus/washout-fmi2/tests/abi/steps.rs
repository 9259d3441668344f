//! Communication points over long simulations.

use moris_fmu_host::{Instance, Status};

use crate::fixture::*;

fn ready(start: f64, stop: Option<f64>) -> Instance {
    let mut instance = open().instantiate("washout").unwrap();
    assert_eq!(instance.setup_experiment(start, stop), Status::Ok);
    assert_eq!(instance.enter_initialization_mode(), Status::Ok);
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    instance
}

/// A hundred seconds of 1 ms steps up to the stop time. One host computes the time as a
/// product, one as a sum.
#[test]
fn time_does_not_drift_and_the_stop_time_is_the_end() {
    let h = 1e-3;
    let mut by_product = ready(0.0, Some(100.0));
    let mut by_sum = ready(0.0, Some(100.0));
    by_product.set("vehicle.specificForce.x", 1.0).unwrap();
    by_sum.set("vehicle.specificForce.x", 1.0).unwrap();
    by_product.steps(100_000, h).unwrap();
    let sum = (0..100_000).fold(0.0, |time, _| {
        by_sum.step(time, h).unwrap();
        time + h
    });
    assert_eq!(by_product.get("time").unwrap(), 99_999.0 * h + h);
    assert_eq!(by_sum.get("time").unwrap(), sum);
    for name in ["platform.position.x", "rider.specificForce.x", "actuator[3].length"] {
        assert_eq!(by_product.get(name).unwrap().to_bits(), by_sum.get(name).unwrap().to_bits(), "{name}");
    }
    for (mut instance, time) in [(by_product, 1e5 * h), (by_sum, sum)] {
        let before = bytes(&mut instance);
        assert_eq!(instance.do_step(time, h), Status::Error);
        assert!(instance.messages().pop().unwrap().text.contains("stop time 100"));
        assert!(bytes(&mut instance) == before);
    }
}

/// At a calendar's time in seconds, the time's rounding exceeds a millionth of the step. A repeated
/// step is still detected.
#[test]
fn a_step_made_twice_is_refused_however_late_it_is() {
    let h = 1e-3;
    for start in [0.0, 1e6, 1.7e9, -1.7e9] {
        let mut instance = ready(start, None);
        for step in 0..1000 {
            instance.step(start + f64::from(step) * h, h).unwrap();
        }
        let before = bytes(&mut instance);
        for wrong in [start + 999.0 * h, start + 1001.0 * h] {
            assert_eq!(instance.do_step(wrong, h), Status::Error, "{start} {wrong}");
        }
        assert!(bytes(&mut instance) == before);
    }
}
