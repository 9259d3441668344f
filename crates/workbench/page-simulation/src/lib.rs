//! Simulation of a recording in a report's page: plain functions over linear memory.
//!
//! The page writes [numbers](moris_page_memory::numbers), calls [`record`] once, and [`simulate`]
//! for each set of parameters. The result is a text of JSON and the curves.

use std::cell::RefCell;

use moris_batch::{Manoeuvre, Replay};
use moris_interface::{Group, Reader, slot_count};
use moris_measures::References;
use moris_page_memory::{group, say, with_numbers};
use moris_report::{Chart, Event, Finding, Limits, Measure, Rig, Run, Thinning, events};
use moris_simulation::capabilities::{AxisAlone, Capabilities};
use moris_simulation::{Evaluated, Simulation, measures_with};
use moris_washout::interface::StructureParameters;
use moris_washout::{Input, Parameters};
use serde::Serialize;

const INPUTS: usize = slot_count(Input::ROWS);
const PARAMETERS: usize = slot_count(Parameters::ROWS);

/// What the page knows of a recording.
struct Recorded {
    manoeuvre: Manoeuvre,
    /// The parameters for which the bounds hold.
    start: Parameters,
    /// Least RMS error by axis \[m/s2\]; not a number where it is not known.
    bounds: [f64; 3],
    references: References,
}

thread_local! {
    static RECORDED: RefCell<Option<Recorded>> = RefCell::default();
    static CURVES: RefCell<Vec<f32>> = RefCell::default();
}

/// All but the curves.
#[derive(Serialize)]
struct Answer {
    findings: Vec<Finding>,
    measures: Vec<Measure>,
    limits: Limits,
    rig: Rig,
    events: Vec<Event>,
    leans: bool,
    charts: Vec<ChartHead>,
}

/// Findings of `moris rig check`, but for the size of the workspace.
#[derive(Serialize)]
struct Verdict {
    is_sound: bool,
    heads: [&'static str; 5],
    /// Cells for each axis.
    rows: [Vec<String>; 6],
    texts: [String; 4],
}

/// A chart of one line, whose values are among the curves.
#[derive(Serialize)]
struct ChartHead {
    title: String,
    quantity: String,
    label: String,
}

/// Takes a recording from the numbers: the time between samples, the bounds of the three axes, the
/// parameters for which they hold, and each sample's inputs. The result is the number of samples.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn record() -> usize {
    let recorded = with_numbers(|numbers| {
        let (head, samples) = numbers.split_at(4 + PARAMETERS);
        let input = |slots| Input::read(&mut Reader::new(slots));
        Recorded {
            manoeuvre: Manoeuvre::new(head[0], samples.chunks_exact(INPUTS).map(input).collect()),
            start: Parameters::read(&mut Reader::new(&head[4..])),
            bounds: [head[1], head[2], head[3]],
            references: References::default(),
        }
    });
    let count = recorded.manoeuvre.inputs().len();
    RECORDED.set(Some(recorded));
    count
}

/// Simulates with the parameters that the numbers hold. True if the text is the answer and the
/// curves are written; false if it is the reason why the parameters cannot be used.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn simulate() -> bool {
    let parameters: Parameters = group();
    let run = RECORDED.with_borrow_mut(|recorded| {
        recorded.as_mut().ok_or_else(|| "no recording".to_owned()).and_then(|one| one.run(&parameters))
    });
    say(run.map(|run| {
        CURVES.set(curves_of(&run));
        answer(&run, &parameters)
    }))
}

/// The verdict on the rig of the parameters that the numbers hold; before them the diameter of its
/// legs, which is not a number where it is not known. True if the text is the verdict; false if it
/// is the reason why there is none.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn check_rig() -> bool {
    say(with_numbers(|numbers| {
        let given: Parameters = Parameters::read(&mut Reader::new(&numbers[1..]));
        verdict(&given, Some(numbers[0]).filter(|diameter| diameter.is_finite()))
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

impl Recorded {
    fn run(&mut self, parameters: &Parameters) -> Result<Run, String> {
        let replay = Replay::new(&self.manoeuvre);
        let simulation = Simulation::of(&replay, parameters, || ()).map_err(|error| error.to_string())?;
        let measures = measures_with(&simulation, &mut self.references).map_err(|error| error.to_string())?;
        let bounds = self.bounds.map(|bound| Some(bound).filter(|bound| bound.is_finite() && self.holds(parameters)));
        let evaluated = Evaluated { simulation: &simulation, measures: &measures, bounds };
        let samples = simulation.inputs.len();
        let thinning = Thinning::new(samples, samples);
        let bounded = (0..3).filter(|&axis| self.bounds[axis].is_finite());
        let charts = bounded.map(|axis| evaluated.felt_chart(axis, &thinning)).collect();
        Ok(Run { charts, ..evaluated.run("", &thinning) })
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

fn verdict(given: &Parameters, diameter: Option<f64>) -> Result<String, String> {
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
    let verdict = Verdict {
        is_sound: capabilities.is_sound(),
        heads: AxisAlone::HEADS,
        rows: capabilities.axes.each_ref().map(AxisAlone::row),
        texts: texts.map(|text| text.trim_end().to_owned()),
    };
    serde_json::to_string(&verdict).map_err(|error| error.to_string())
}

fn answer(run: &Run, parameters: &Parameters) -> String {
    let answer = Answer {
        findings: run.findings.clone(),
        measures: run.measures.clone(),
        limits: run.limits,
        rig: Rig::from(parameters),
        events: events(run, &Rig::from(parameters)),
        leans: !run.lean.is_empty(),
        charts: run.charts.iter().map(head).collect(),
    };
    serde_json::to_string(&answer).unwrap_or_default()
}

fn head(chart: &Chart) -> ChartHead {
    let label = chart.lines.first().map(|line| line.label.clone()).unwrap_or_default();
    ChartHead { title: chart.title.clone(), quantity: chart.quantity.clone(), label }
}

fn curves_of(run: &Run) -> Vec<f32> {
    let groups: [&[Vec<f64>]; 10] = [
        &run.desired.specific_force,
        &run.desired.angular_velocity,
        &run.felt.specific_force,
        &run.felt.angular_velocity,
        &run.position,
        &run.orientation,
        &run.legs,
        &run.tilt,
        &run.tilt_rate,
        std::slice::from_ref(&run.lean),
    ];
    let values = groups.into_iter().flatten().flatten().map(|&value| value as f32);
    let limited = &run.limited;
    let flags = [&limited.tilt, &limited.soft, &limited.safety, &limited.actuator]
        .into_iter()
        .flatten()
        .map(|&flag| f32::from(u8::from(flag)));
    let of_charts = run.charts.iter().flat_map(|chart| &chart.lines).flat_map(|line| &line.values);
    values.chain(flags).chain(of_charts.map(|&value| value as f32)).collect()
}
