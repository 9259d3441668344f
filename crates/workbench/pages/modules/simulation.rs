//! Simulation of a recording in a report's page: plain functions over linear memory.
//!
//! The page writes [numbers](moris_pages::memory::numbers) and calls [`record`] once. For each set
//! of parameters it calls [`begin`], then [`advance`] and [`part`] until all samples are simulated,
//! then [`finish`]. Curves are so in the page while further samples are simulated, and before the
//! measures. Texts are JSON.

use std::cell::RefCell;
use std::ops::Range;

use moris_interface::{Group, Reader, slot_count};
use moris_pages::memory::{group, respond, with_numbers};
use moris_pages::report::{Rig, Run, Thinning, events, felt_chart, run};
use moris_simulation::capabilities::{AxisAlone, Capabilities};
use moris_simulation::measures::References;
use moris_simulation::{Evaluated, Limits, Simulation, Unfinished, measures_with};
use moris_simulation::{Manoeuvre, Replay};
use moris_washout::interface::StructureParameters;
use moris_washout::{Input, Parameters};
use serde_json::{Value, json};

/// A recording, as the page knows it.
struct Recorded {
    manoeuvre: Manoeuvre,
    /// The parameters for which the bounds hold.
    start: Parameters,
    /// Least RMS error by axis \[m/s2\]; not a number where it is not known.
    bounds: [f64; 3],
    references: References,
    /// The simulation, and how many of its samples are in parts.
    simulation: Option<(Unfinished, usize)>,
}

thread_local! {
    static RECORDED: RefCell<Option<Recorded>> = RefCell::default();
    static CURVES: RefCell<Vec<f32>> = RefCell::default();
}

/// Takes a recording from the numbers: the time between samples, the bounds of the three axes, the
/// parameters for which they hold, and each sample's inputs. The result is the number of samples.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn record() -> usize {
    const INPUT_SLOTS: usize = slot_count(Input::ROWS);
    const PARAMETER_SLOTS: usize = slot_count(Parameters::ROWS);
    let recorded = with_numbers(|numbers| {
        let (head, samples) = numbers.split_at(4 + PARAMETER_SLOTS);
        let input = |slots| Input::read(&mut Reader::new(slots));
        Recorded {
            manoeuvre: Manoeuvre::new(head[0], samples.chunks_exact(INPUT_SLOTS).map(input).collect()),
            start: Parameters::read(&mut Reader::new(&head[4..])),
            bounds: [head[1], head[2], head[3]],
            references: References::default(),
            simulation: None,
        }
    });
    let count = recorded.manoeuvre.inputs().len();
    RECORDED.set(Some(recorded));
    count
}

/// Begins to simulate with the parameters that the numbers hold. True if the text is what holds for
/// all parts; false if it is the reason why the parameters cannot be used.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn begin() -> bool {
    let parameters: Parameters = group();
    respond(with_recorded(|recorded| recorded.begin(&parameters)))
}

/// Simulates up to so many further samples. The result is the number of all so far.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn advance(samples: usize) -> usize {
    with_recorded(|recorded| Ok(recorded.advance(samples))).unwrap_or_default()
}

/// Writes the curves of the samples since the last part. The result is the first of them.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn part() -> usize {
    with_recorded(|recorded| Ok(recorded.part())).unwrap_or_default()
}

/// Evaluates the simulation when all samples are simulated. True if the text is measures, findings
/// and events, and the curve is the flag of the tilt's limits; false if it is the reason why there
/// are none.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn finish() -> bool {
    respond(with_recorded(Recorded::finish))
}

/// The verdict on the rig of the parameters that the numbers hold; before them the diameter of its
/// legs, which is not a number where it is not known. True if the text is the verdict; false if it
/// is the reason why there is none.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn check_rig() -> bool {
    respond(with_numbers(|numbers| {
        let given: Parameters = Parameters::read(&mut Reader::new(&numbers[1..]));
        rig_verdict(&given, Some(numbers[0]).filter(|diameter| diameter.is_finite()))
    }))
}

/// Address of the curves: series one after the other, in the order of the page's `simulator.js`.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn curves() -> *const f32 {
    CURVES.with_borrow(|curves| curves.as_ptr())
}

/// Number of the curves' values.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn curves_length() -> usize {
    CURVES.with_borrow(Vec::len)
}

fn with_recorded<T>(act: impl FnOnce(&mut Recorded) -> Result<T, String>) -> Result<T, String> {
    RECORDED.with_borrow_mut(|recorded| recorded.as_mut().map_or_else(|| Err("no recording".to_owned()), act))
}

impl Recorded {
    fn begin(&mut self, parameters: &Parameters) -> Result<String, String> {
        let begun = Unfinished::begin(&Replay::new(&self.manoeuvre), parameters).map_err(|error| error.to_string())?;
        let charts: Vec<Value> = self.bounded().map(|axis| chart_head(&begun.simulation, axis)).collect();
        self.simulation = Some((begun, 0));
        Ok(json!({ "limits": Limits::from(parameters), "rig": Rig::from(parameters), "charts": charts }).to_string())
    }

    fn advance(&mut self, samples: usize) -> usize {
        let Some((unfinished, _)) = &mut self.simulation else { return 0 };
        unfinished.advance(&Replay::new(&self.manoeuvre), samples, None, || ());
        unfinished.simulation.outputs.len()
    }

    fn part(&mut self) -> usize {
        let axes: Vec<usize> = self.bounded().collect();
        let Some((Unfinished { simulation, .. }, sent)) = &mut self.simulation else { return 0 };
        let part = *sent..simulation.outputs.len();
        *sent = part.end;
        CURVES.set(curves_of(simulation, part.clone(), &axes));
        part.start
    }

    fn finish(&mut self) -> Result<String, String> {
        let (Unfinished { simulation, .. }, _) = self.simulation.take().ok_or("no simulation")?;
        let measures = measures_with(&simulation, Some(&mut self.references)).map_err(|error| error.to_string())?;
        let holds = self.holds(&simulation.parameters);
        let bounds = self.bounds.map(|bound| Some(bound).filter(|bound| bound.is_finite() && holds));
        let samples = simulation.inputs.len();
        let evaluated = Evaluated { simulation: &simulation, measures: &measures, bounds, advice: None };
        let run = run(&evaluated, "", &Thinning::new(samples, samples));
        CURVES.set(run.limited.tilt.iter().map(|&flag| f32::from(u8::from(flag))).collect());
        let events = events(&run, &Rig::from(&simulation.parameters));
        let Run { verdict, findings, measures, .. } = run;
        Ok(json!({ "verdict": verdict, "findings": findings, "measures": measures, "events": events }).to_string())
    }

    /// The axes whose bounds are known.
    fn bounded(&self) -> impl Iterator<Item = usize> {
        let bounds = self.bounds;
        (0..3).filter(move |&axis| bounds[axis].is_finite())
    }

    /// True where the bounds hold for these parameters: with the limits for
    /// which they were computed.
    fn holds(&self, parameters: &Parameters) -> bool {
        let of = |parameters: &Parameters| {
            let Parameters { tilt, safety, structure, rig, .. } = *parameters;
            let head = moris_washout::platform::LocationFrame::new(&structure, 0.0).point;
            (
                tilt,
                safety.position_limit,
                safety.velocity_limit,
                safety.acceleration_limit,
                head,
                structure.gravity,
                rig,
            )
        };
        of(&self.start) == of(parameters)
    }
}

fn rig_verdict(given: &Parameters, diameter: Option<f64>) -> Result<String, String> {
    given.check_ranges().map_err(|error| error.to_string())?;
    // As the command has them: the rig's, all others the default's.
    let defaults = Parameters::default();
    let structure = StructureParameters {
        head_height: given.structure.head_height,
        torso_length: given.structure.torso_length,
        ..defaults.structure
    };
    let alone = Parameters { rig: given.rig, safety: given.safety, structure, ..defaults };
    let capabilities = Capabilities::of(&alone, diameter).map_err(|error| error.to_string())?;
    let texts = [
        capabilities.legs(),
        capabilities.safety().join("\n"),
        capabilities.clearance.to_string(),
        capabilities.singularities.to_string(),
    ];
    let verdict = json!({
        "is_sound": capabilities.is_sound(),
        "heads": AxisAlone::HEADS,
        "rows": capabilities.axes.each_ref().map(AxisAlone::row),
        "texts": texts.map(|text| text.trim_end().to_owned()),
    });
    Ok(verdict.to_string())
}

fn chart_head(simulation: &Simulation, axis: usize) -> Value {
    let chart = felt_chart(simulation, axis, &Thinning::new(1, 1));
    let label = chart.lines.first().map(|line| line.label.clone()).unwrap_or_default();
    json!({ "title": chart.title, "quantity": chart.quantity, "label": label })
}

/// Curves of some samples, one after the other; the last are those of the charts of these axes.
fn curves_of(simulation: &Simulation, part: Range<usize>, axes: &[usize]) -> Vec<f32> {
    let samples: Vec<Vec<f64>> = part.map(|k| values_at(simulation, k, axes)).collect();
    let curves = samples.first().map_or(0, Vec::len);
    (0..curves).flat_map(|curve| samples.iter().map(move |values| values[curve] as f32)).collect()
}

/// A value of each curve at a sample.
fn values_at(simulation: &Simulation, k: usize, axes: &[usize]) -> Vec<f64> {
    let (input, output) = (&simulation.inputs[k], &simulation.outputs[k]);
    let (rate, orientation) = (simulation.desired_rate(k), output.orientation.to_vector());
    let felt = simulation.felt_without_gravity(k);
    let felt_on: Vec<f64> = axes.iter().map(|&axis| felt[axis]).collect();
    let raised = |flag: bool| f64::from(u8::from(flag));
    [
        input.specific_force.as_slice(),
        rate.as_slice(),
        output.felt_specific_force.as_slice(),
        output.felt_angular_velocity.as_slice(),
        output.position.as_slice(),
        orientation.as_slice(),
        &output.actuators(&simulation.parameters.rig)[0],
        &[output.tilt_roll, output.tilt_pitch, output.tilt_roll_rate, output.tilt_pitch_rate, input.lean],
        &[output.soft_limited, output.safety_active, output.actuator_limited].map(raised),
        &felt_on,
    ]
    .concat()
}
