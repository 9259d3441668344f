//! Steps an FMU by the crate fmu-runner: `with-fmu-runner FMU`.
//!
//! Standard input has the names of the inputs, those of the outputs, the communication step in s,
//! and then, a line a step, the inputs to set. Standard output gets the outputs after each step, a
//! line a step. From half way on everything is done twice: the second time from the state that was
//! serialized there, and the numbers have to be the same.

use std::collections::HashMap;
use std::io::read_to_string;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use fmu_runner::model_description::ScalarVariable;
use fmu_runner::{Fmu, FmuInstance, FmuLibrary, fmi2Type};

fn main() -> Result<()> {
    let path = std::env::args_os().nth(1).context("which FMU?")?;
    let library = Fmu::unpack(Path::new(&path))?.load(fmi2Type::fmi2CoSimulation)?;
    let text = read_to_string(std::io::stdin())?;
    let ride = Ride::read(&text, &library)?;
    let instance = FmuInstance::instantiate(&library, true)?;
    instance.setup_experiment(0.0, Some(ride.step * ride.rows.len() as f64), None)?;
    instance.enter_initialization_mode()?;
    instance.exit_initialization_mode()?;

    let half = ride.rows.len() / 2;
    let mut answers = ride.make(&instance, 0, half)?;
    let states = instance.get_set_state_capability().context("the FMU has no states")?;
    let serialization = instance.serialize_state_capability().context("the FMU does not serialize its state")?;
    let bytes = serialization.serialize_state(&states.get_state()?)?;
    let rest = ride.make(&instance, half, ride.rows.len())?;
    states.set_state(serialization.deserialize_state(&bytes)?)?;
    ensure!(ride.make(&instance, half, ride.rows.len())? == rest, "the second time, the numbers are others");

    answers.extend(rest);
    for row in answers {
        println!("{}", row.iter().map(f64::to_string).collect::<Vec<_>>().join(" "));
    }
    Ok(())
}

/// Variables to set and to get.
struct Ride<'a> {
    inputs: Vec<&'a ScalarVariable>,
    outputs: Vec<&'a ScalarVariable>,
    /// \[s\]
    step: f64,
    rows: Vec<Vec<f64>>,
}

impl<'a> Ride<'a> {
    fn read(text: &str, library: &'a FmuLibrary) -> Result<Self> {
        let mut lines = text.lines();
        let mut line = || lines.next().context("a line is missing");
        let variable = |name| library.variables().get(name).ok_or_else(|| anyhow!("there is no variable {name}"));
        let inputs = line()?.split(' ').map(variable).collect::<Result<_>>()?;
        let outputs = line()?.split(' ').map(variable).collect::<Result<_>>()?;
        let step = line()?.parse()?;
        let numbers = |line: &str| line.split(' ').map(str::parse).collect();
        let rows = lines.map(numbers).collect::<Result<_, _>>()?;
        Ok(Ride { inputs, outputs, step, rows })
    }

    /// Makes these steps; returns the outputs after each.
    fn make(&self, instance: &FmuInstance<&FmuLibrary>, from: usize, to: usize) -> Result<Vec<Vec<f64>>> {
        let mut answers = Vec::new();
        for k in from..to {
            let values: HashMap<_, _> = self.inputs.iter().copied().zip(self.rows[k].iter().copied()).collect();
            instance.set_reals(&values)?;
            instance.do_step(k as f64 * self.step, self.step, false)?;
            let got = instance.get_reals(&self.outputs)?;
            answers.push(self.outputs.iter().map(|output| got[output]).collect());
        }
        Ok(answers)
    }
}
