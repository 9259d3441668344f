//! A vehicle FMU as the source of telemetry.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use moris_fmu_host::Running;
use moris_live::Sample;
use moris_live::format::{Format, Place};

/// Words of a map that are not those of a table of fields.
const OWN: [&str; 2] = ["start", "step"];
/// What a table of fields has, and a map needs not say.
const DEFAULTS: [(&str, &str); 4] = [("name", "map"), ("about", ""), ("note", ""), ("layout", "json")];

/// A running vehicle and the map of its variables.
pub struct Vehicle {
    running: Running,
    /// The fields, whose keys are names of variables.
    fields: Format,
    variables: Vec<String>,
    /// Time of a step \[s\].
    pub step: f64,
    steps: u32,
}

impl Vehicle {
    /// The FMU with the map in this file.
    ///
    /// # Errors
    /// The map or the FMU cannot be used, or the FMU lacks a variable of the map.
    pub fn open(file: &Path, map: &Path) -> Result<Self> {
        let text = fs::read_to_string(map).with_context(|| map.display().to_string())?;
        let mut table: toml::Table = text.parse().with_context(|| map.display().to_string())?;
        let [start, step] = OWN.map(|word| table.remove(word));
        for (word, value) in DEFAULTS {
            table.entry(word).or_insert_with(|| value.into());
        }
        let fields: Format = table.to_string().parse().with_context(|| map.display().to_string())?;
        let start: BTreeMap<String, f64> = start.map_or(Ok(BTreeMap::new()), toml::Value::try_into).context("start")?;
        let step: f64 = step.map_or(Ok(0.005), toml::Value::try_into).context("step")?;
        ensure!((1e-3..=0.05).contains(&step), "step must be from 0.001 to 0.05 s");
        let key = |place: &Place| match place {
            Place::Key(name) => Some(name.clone()),
            Place::Index(_) => None,
        };
        let variables: Option<Vec<String>> = fields.fields.values().map(|field| key(&field.at)).collect();
        let variables = variables.context("a field's `at` is the name of a variable")?;
        let values: Vec<(&str, f64)> = start.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let running = Running::start(file, &values).with_context(|| file.display().to_string())?;
        let mut vehicle = Vehicle { running, fields, variables, step, steps: 0 };
        vehicle.sample()?;
        Ok(vehicle)
    }

    /// The motion now.
    ///
    /// # Errors
    /// The FMU lacks a variable, or a value is no number.
    pub fn sample(&mut self) -> Result<Sample> {
        let mut values = serde_json::Map::new();
        for name in &self.variables {
            values.insert(name.clone(), self.running.get(name)?.into());
        }
        let text = serde_json::to_vec(&values)?;
        let mut sample = self.fields.decode(&text)?;
        sample.time = None;
        Ok(sample)
    }

    /// Steps the vehicle.
    ///
    /// # Errors
    /// The FMU does not make the step.
    pub fn advance(&mut self) -> Result<()> {
        self.running.step(f64::from(self.steps) * self.step, self.step)?;
        self.steps += 1;
        Ok(())
    }
}
