//! A recording on a rig with one set of parameters: the simulation, its measures and bounds.

use moris_setup::Setup;
use moris_simulation::advice::{Advice, Advisor};
use moris_simulation::foreign::ForeignMotion;
use moris_simulation::measures::{Axes, Measures};
use moris_simulation::preview::Previewer;
use moris_simulation::{Evaluated, Simulation, measures};
use moris_washout::ParameterError;
use rayon::prelude::*;

use crate::bounds::AxisBound;
use crate::error::Result;
use crate::recording::Recording;

/// A simulation with one set of parameters, and its measures.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The rig and the parameters.
    pub setup: Setup,
    /// All inputs and outputs.
    pub simulation: Simulation,
    /// The measures.
    pub measures: Measures,
    /// The bound, axis by axis; none without a desired signal or if not requested.
    pub bounds: Axes<Option<AxisBound>>,
    /// Simulated alternatives; none where nothing is wrong, or none were simulated.
    pub advice: Option<Advice>,
}

impl Outcome {
    /// Simulates, with a preview if there is one, and measures. `progress` is called after each
    /// sample.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn of(
        recording: &Recording,
        setup: &Setup,
        previewer: Option<Previewer>,
        progress: impl FnMut(),
    ) -> Result<Self> {
        let parameters = recording.parameters(&setup.parameters);
        Outcome::measured(Simulation::previewed(&recording.replay(), &parameters, previewer, progress)?, setup)
    }

    /// Judges motion that another washout computed, under its name.
    ///
    /// # Errors
    /// The motion does not fit the recording, or cannot be meant.
    pub fn foreign(
        recording: &Recording,
        setup: &Setup,
        name: &str,
        motion: &ForeignMotion,
        notes: Vec<String>,
    ) -> Result<Self> {
        let parameters = recording.parameters(&setup.parameters);
        let simulation = motion.simulation(recording.inputs(), recording.step(), &parameters, notes)?;
        Outcome::measured(simulation, &Setup { parameters_name: name.to_owned(), ..setup.clone() })
    }

    /// With simulated alternatives where something is wrong, of a simulation with a preview of so
    /// many seconds.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn advised(mut self, recording: &Recording, preview: f64) -> Result<Self> {
        self.advice = self.alternatives(recording, preview)?;
        Ok(self)
    }

    /// The simulated alternatives of [`Outcome::advised`]; none where nothing is wrong.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn alternatives(&self, recording: &Recording, preview: f64) -> Result<Option<Advice>> {
        let Some(advisor) = Advisor::of(&self.evaluated(), &recording.manoeuvre, preview) else { return Ok(None) };
        let found = advisor.candidates().into_par_iter().map(|candidate| advisor.best(candidate));
        let found = found.collect::<Result<Vec<_>, ParameterError>>()?;
        Ok(Some(Advice::new(advisor.fault, found.into_iter().flatten().collect())))
    }

    /// Measures a simulation with this setup's rig.
    ///
    /// # Errors
    /// The simulation has too few samples.
    pub fn measured(simulation: Simulation, setup: &Setup) -> Result<Self> {
        let measures = measures(&simulation)?;
        let setup = Setup { parameters: simulation.parameters, ..setup.clone() };
        Ok(Outcome { setup, simulation, measures, bounds: Axes::default(), advice: None })
    }

    /// The simulation with its measures and the bounds' errors.
    pub fn evaluated(&self) -> Evaluated<'_> {
        let bounds = self.bounds.each_ref().map(|bound| bound.as_ref().map(|bound| bound.bound.rms_error));
        Evaluated { simulation: &self.simulation, measures: &self.measures, bounds, advice: self.advice.as_ref() }
    }
}

/// A number with its noun: `1 recording`, `2 recordings`.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Names in a row, those with a comma in quotes.
pub fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let quoted = |name: &str| if name.contains(',') { format!("\"{name}\"") } else { name.to_owned() };
    names.map(quoted).collect::<Vec<_>>().join(", ")
}
