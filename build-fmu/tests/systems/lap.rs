//! The lap of MotorcycleLap.ssp: the models of its FMUs, with its start values and connections.
//! The models are stepped as by a co-simulation tool, with one step of delay for each connection.

use moris_build_fmu::ssp::{COMPONENTS, Form, MOTORCYCLE_LAP};
use moris_interface::SlotModel;
use moris_motorcycle::Motorcycle;
use moris_stewart_platform::StewartPlatform;
use moris_washout::Washout;

use crate::description::{connections, structure};

/// The lap's duration and communication step \[s\].
const DURATION: f64 = 100.0;
const STEP: f64 = 0.001;

/// Least RMS errors of surge and sway that any controller could reach on this lap \[m/s²\]. The
/// source is `moris simulate` for the motorcycle's outputs.
const BOUND: [f64; 2] = [0.79, 0.00];

/// A component with its values in slots.
struct Part {
    slots: Vec<f64>,
    model: Box<dyn Stepped>,
}

trait Stepped {
    fn advance(&mut self, slots: &mut [f64]);
}

impl<M: SlotModel> Stepped for M {
    fn advance(&mut self, slots: &mut [f64]) {
        self.step_slots(slots, None, STEP);
        self.write_outputs(slots);
    }
}

fn part<M: SlotModel>(start: &[f64]) -> Part {
    let mut slots = start.to_vec();
    let model = M::from_slots(&slots).expect("start values are usable");
    model.write_outputs(&mut slots);
    Part { slots, model: Box::new(model) }
}

/// A component's place in the system, and a variable's slot in it.
fn place((component, variable): (&str, &str)) -> (usize, usize) {
    let part = COMPONENTS.iter().position(|(name, _)| *name == component).expect("a component");
    let slot = COMPONENTS[part].1.functions.identity.slot(variable);
    (part, slot.unwrap_or_else(|| panic!("{component} has no {variable}")))
}

#[test]
fn surge_and_sway_of_the_lap_are_near_the_bound() {
    let starts = MOTORCYCLE_LAP.starts().unwrap();
    let [motorcycle, washout, platform] = starts.as_slice() else { panic!("three components") };
    let mut parts = [
        part::<Motorcycle>(motorcycle.slots()),
        part::<Washout>(washout.slots()),
        part::<StewartPlatform>(platform.slots()),
    ];
    let text = structure(&MOTORCYCLE_LAP, Form::Flat);
    let wires: Vec<_> = connections(&text)
        .iter()
        .map(|[from, output, to, input]| (place((from, output)), place((to, input))))
        .collect();
    let desired = ["x", "y"].map(|axis| place(("motorcycle", &format!("vehicle.specificForce.{axis}"))));
    let felt = ["x", "y"].map(|axis| place(("platform", &format!("rider.specificForce.{axis}"))));
    let never =
        [("motorcycle", "status.offPath"), ("washout", "status.actuatorLimited"), ("platform", "status.atStop")]
            .map(place);

    let steps = (DURATION / STEP).round() as usize;
    let mut squares = [[0.0; 2]; 2];
    let mut flagged = [0; 3];
    for _ in 0..steps {
        let values: Vec<f64> = wires.iter().map(|&((part, slot), _)| parts[part].slots[slot]).collect();
        for (&(_, (part, slot)), value) in wires.iter().zip(values) {
            parts[part].slots[slot] = value;
        }
        for part in &mut parts {
            part.model.advance(&mut part.slots);
        }
        let value = |(part, slot): (usize, usize)| parts[part].slots[slot];
        for axis in 0..2 {
            squares[0][axis] += value(desired[axis]).powi(2);
            squares[1][axis] += (value(felt[axis]) - value(desired[axis])).powi(2);
        }
        for (count, status) in flagged.iter_mut().zip(never) {
            *count += usize::from(value(status) != 0.0);
        }
    }
    let [rest, errors] = squares.map(|of| of.map(|sum: f64| (sum / steps as f64).sqrt()));
    println!("RMS of surge and sway: at rest {rest:.3?}, felt {errors:.3?} m/s²; steps with a limit: {flagged:?}");
    assert!(rest[0] > 1.8 && rest[1] > 0.3, "the lap is brisk: {rest:?}");
    for (error, bound) in errors.into_iter().zip(BOUND) {
        assert!(error <= f64::max(1.25 * bound + 0.05, 0.10), "{errors:?} m/s²");
    }
    assert_eq!([flagged[0], flagged[2]], [0, 0]);
    assert!(flagged[1] * 200 <= steps, "the guard acts in {} of {steps} steps", flagged[1]);
}
