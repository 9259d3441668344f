//! A vehicle FMU, with a map of its variables.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use moris_fmu_host::Running;
use moris_fmu_host::files::MAX_TEXT_SIZE;
use moris_live::Sample;
use moris_live::format::{FieldAddress, Format};
use moris_pages::ride::RiderCommand;
use serde::Deserialize;

use super::{Features, Handling, Vehicle, shape};

/// A control of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Control {
    Throttle,
    Brake,
    Stick,
}

/// The input that takes a control.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Taken {
    /// Name of the FMU's variable.
    at: String,
    #[serde(default = "one")]
    scale: f64,
}

fn one() -> f64 {
    1.0
}

/// A running FMU and the map of its variables.
pub struct Fmu {
    running: Running,
    controls: BTreeMap<Control, Taken>,
    /// The fields, whose keys are names of variables.
    fields: Format,
    variables: Vec<String>,
    /// Time of a step \[s\].
    step: f64,
    steps: u32,
}

impl Fmu {
    /// The FMU with the map in this file.
    ///
    /// # Errors
    /// The map or the FMU cannot be used, or the FMU lacks a variable of the map.
    pub fn open(file: &Path, map: &Path) -> Result<Self> {
        // Words of a map that are not those of a table of fields.
        const MAP_KEYS: [&str; 3] = ["start", "step", "controls"];
        // Keys of a table of fields that a map may leave out, with their values.
        const MAP_DEFAULTS: [(&str, &str); 4] = [("name", "map"), ("about", ""), ("note", ""), ("layout", "json")];
        let text = moris_fmu_host::files::text(map, MAX_TEXT_SIZE).with_context(|| map.display().to_string())?;
        let mut table: toml::Table = text.parse().with_context(|| map.display().to_string())?;
        let [start, step, controls] = MAP_KEYS.map(|word| table.remove(word));
        for (word, value) in MAP_DEFAULTS {
            table.entry(word).or_insert_with(|| value.into());
        }
        let fields: Format = table.to_string().parse().with_context(|| map.display().to_string())?;
        let start: BTreeMap<String, f64> = start.map_or(Ok(BTreeMap::new()), toml::Value::try_into).context("start")?;
        let step: f64 = step.map_or(Ok(0.005), toml::Value::try_into).context("step")?;
        ensure!((1e-3..=0.05).contains(&step), "step must be from 0.001 to 0.05 s");
        let controls: BTreeMap<Control, Taken> =
            controls.map_or(Ok(BTreeMap::new()), toml::Value::try_into).context("controls")?;
        ensure!(controls.values().all(|taken| taken.scale.is_finite()), "the scale of a control must be a number");
        let key = |place: &FieldAddress| match place {
            FieldAddress::Key(name) => Some(name.clone()),
            FieldAddress::Index(_) => None,
        };
        let variables: Option<Vec<String>> = fields.fields.values().map(|field| key(&field.at)).collect();
        let variables = variables.context("a field's `at` is the name of a variable")?;
        let values: Vec<(&str, f64)> = start.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let running = Running::start(file, &values).with_context(|| file.display().to_string())?;
        let mut fmu = Fmu { running, controls, fields, variables, step, steps: 0 };
        fmu.sample()?;
        fmu.control(&RiderCommand::default())?;
        Ok(fmu)
    }

    /// Sets the inputs that take controls.
    fn control(&mut self, command: &RiderCommand) -> Result<()> {
        for (control, Taken { at, scale }) in &self.controls {
            let values = [command.throttle, command.brake, command.stick];
            self.running.set(at, scale * values[*control as usize])?;
        }
        Ok(())
    }
}

impl Vehicle for Fmu {
    fn step(&self) -> f64 {
        self.step
    }

    fn features(&self) -> Features {
        Features {
            is_inside: true,
            has_position: self.fields.has_position(),
            handling: (!self.controls.is_empty()).then_some(Handling::Inputs),
            shape: shape(&self.fields),
            road: None,
        }
    }

    fn sample(&mut self) -> Result<Sample> {
        let mut values = serde_json::Map::new();
        for name in &self.variables {
            values.insert(name.clone(), self.running.get(name)?.into());
        }
        let text = serde_json::to_vec(&values)?;
        let mut sample = self.fields.decode(&text)?;
        sample.time = None;
        Ok(sample)
    }

    fn advance(&mut self, command: &RiderCommand) -> Result<()> {
        self.control(command)?;
        self.running.step(f64::from(self.steps) * self.step, self.step)?;
        self.steps += 1;
        Ok(())
    }
}
