//! The map of a washout FMU's variables.

use std::collections::BTreeMap;
use std::path::Path;

use moris_fmu_host::files::MAX_TEXT_SIZE;
use moris_washout::motion::orientation::Orientation;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Input, interface::AngularVelocityFrame, interface::STANDARD_GRAVITY};
use serde::de::Error;
use serde::{Deserialize, Deserializer};

use crate::error::{About, Result, bail, ensure};
use crate::recording::Quantity;
use crate::recording::conventions::Gravity;
use crate::recording::felt::Kind;
use crate::recording::units::Dimension;

/// The map of a washout FMU's variables, as its file has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// Communication step \[s\]; that of the recording if none is given.
    pub step: Option<f64>,
    /// Gravity in `ax ay az`, as an accelerometer measures it; removed, they are zero at rest.
    #[serde(default = "included")]
    gravity: Gravity,
    /// Values of parameters and inputs at the start.
    #[serde(default)]
    pub start: BTreeMap<String, f64>,
    /// Inputs that take the recording's quantities.
    pub inputs: BTreeMap<Quantity, MappedVariable>,
    /// Outputs, by the columns of a table of felt motion, or constants.
    pub outputs: BTreeMap<String, MappedOutput>,
}

/// A variable, with its unit and sign.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of at, unit, scale and offset")]
pub struct MappedVariable {
    /// Name of the FMU's variable.
    pub at: String,
    /// Unit of the FMU's variable; that of its model description if none is given, and else of SI.
    pub unit: Option<String>,
    /// Factor; a negative one turns the axis round.
    #[serde(default = "one")]
    pub scale: f64,
    /// Added last, in SI units.
    #[serde(default)]
    pub offset: f64,
}

/// A variable, or a constant in SI units.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "an output is a number, or a table of at, unit, scale and offset")]
pub enum MappedOutput {
    Constant(f64),
    Variable(MappedVariable),
}

fn included() -> Gravity {
    Gravity::Included
}

fn one() -> f64 {
    1.0
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // Keys of the quantities that a washout takes.
        const INPUT_KEYS: &[&str] = &["ax", "ay", "az", "wx", "wy", "wz", "roll", "pitch", "yaw", "speed", "lean"];
        let key = String::deserialize(deserializer)?;
        let known = Quantity::of_key(&key).ok().filter(|quantity| INPUT_KEYS.contains(&quantity.key()));
        known.ok_or_else(|| D::Error::unknown_variant(&key, INPUT_KEYS))
    }
}

/// The columns of a table of felt motion, each with its dimension: all of a group, or none.
const COLUMN_GROUPS: [(&[&str], &[Kind]); 5] = [
    (&["ax", "ay", "az"], &[Kind::Of(Dimension::Force); 3]),
    (&["wx", "wy", "wz"], &[Kind::Of(Dimension::Rate); 3]),
    (&["x", "y", "z"], &[Kind::Length; 3]),
    (&["roll", "pitch", "yaw"], &[Kind::Of(Dimension::Angle); 3]),
    (&["leg1", "leg2", "leg3", "leg4", "leg5", "leg6"], &[Kind::Length; 6]),
];

impl Map {
    /// The map in a file.
    ///
    /// # Errors
    /// The file cannot be read, has unknown words, or its outputs are no whole motion.
    pub fn read(file: &Path) -> Result<Self> {
        let shown = || file.display().to_string();
        let text = moris_fmu_host::files::text(file, MAX_TEXT_SIZE).about(shown)?;
        let map: Map = toml::from_str(&text).about(shown)?;
        map.check().about(shown)?;
        Ok(map)
    }

    fn check(&self) -> Result<()> {
        // Shortest and longest step [s].
        const STEP_RANGE: std::ops::RangeInclusive<f64> = 1e-4..=0.5;
        if let Some(step) = self.step {
            ensure!(STEP_RANGE.contains(&step), "step is {step}, but must be from 0.0001 to 0.5 s");
        }
        ensure!(!self.inputs.is_empty(), "[inputs] is empty; the washout needs the motion, such as ax, ay and az");
        for (name, output) in &self.outputs {
            if self.kind(name).is_none() {
                let known: Vec<&str> = COLUMN_GROUPS.iter().flat_map(|(names, _)| *names).copied().collect();
                bail!("[outputs] has {name}, but must have some of {}", known.join(", "));
            }
            if let MappedOutput::Constant(value) = output {
                ensure!(value.is_finite(), "{name} is {value}, but must be a finite number");
            }
        }
        let has = |name: &&str| self.outputs.contains_key(*name);
        for (names, _) in COLUMN_GROUPS {
            if let (true, Some(missing)) = (names.iter().any(has), names.iter().find(|name| !has(name))) {
                bail!("[outputs] lacks {missing}: give all of {}; a constant is a number", names.join(", "));
            }
        }
        if has(&"x") != has(&"roll") {
            bail!("[outputs] must have all of x, y, z, roll, pitch, yaw, or none; a constant is a number, as yaw = 0");
        }
        if !["ax", "x", "leg1"].iter().any(has) {
            bail!("[outputs] has nothing to judge; give x, y, z, roll, pitch, yaw, or leg1 to leg6, or ax, ay, az");
        }
        for (name, variable) in self.variables() {
            let is_usable = variable.scale.is_finite() && variable.scale != 0.0 && variable.offset.is_finite();
            ensure!(is_usable, "{name}: scale must be a number other than zero, and offset a number");
        }
        Ok(())
    }

    /// All variables, by the quantities.
    fn variables(&self) -> impl Iterator<Item = (String, &MappedVariable)> {
        let inputs = self.inputs.iter().map(|(quantity, variable)| (quantity.key().to_owned(), variable));
        let outputs = self.outputs.iter().filter_map(|(name, output)| match output {
            MappedOutput::Constant(_) => None,
            MappedOutput::Variable(variable) => Some((name.clone(), variable)),
        });
        inputs.chain(outputs)
    }

    /// The dimension of an output.
    pub fn kind(&self, output: &str) -> Option<Kind> {
        let of = |(names, kinds): (&[&str], &[Kind])| Some(kinds[names.iter().position(|name| *name == output)?]);
        COLUMN_GROUPS.into_iter().find_map(of)
    }

    /// The value of a quantity at an input, in SI units and body axes.
    pub fn value(&self, quantity: Quantity, input: &Input, frame: AngularVelocityFrame) -> f64 {
        let to_body = || Orientation::new(input.orientation).rotation.transpose();
        let force = || match self.gravity {
            Gravity::Included => input.specific_force,
            Gravity::Removed => input.specific_force - to_body() * (Vector3::z() * STANDARD_GRAVITY),
        };
        let rate = || match frame {
            AngularVelocityFrame::Body => input.angular_velocity,
            AngularVelocityFrame::World => to_body() * input.angular_velocity,
        };
        match quantity {
            Quantity::Force(axis) => force()[axis],
            Quantity::Rate(axis) => rate()[axis],
            Quantity::Angle(axis) => [input.orientation.roll, input.orientation.pitch, input.orientation.yaw][axis],
            Quantity::Speed => input.speed,
            _ => input.lean,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        let read = || -> Result<()> { toml::from_str::<Map>(text).about(String::new)?.check() };
        read().unwrap_err().with_sources(|_| String::new())
    }

    #[test]
    fn a_map_that_is_no_whole_motion_is_refused() {
        let outputs = |text: &str| error(&format!("inputs.ax = {{ at = \"u\" }}\n[outputs]\n{text}"));
        assert!(outputs("x = 0\ny = 0").contains("lacks z"));
        assert!(outputs("x = 0\ny = 0\nz = 1").contains("yaw = 0"));
        assert!(outputs("wx = 0\nwy = 0\nwz = 0").contains("nothing to judge"));
        assert!(outputs("heave = 0").contains("has heave, but must have some of ax, ay"));
        assert!(
            outputs("x = { at = \"x\", scale = 0 }\ny = 0\nz = 1\nroll = 0\npitch = 0\nyaw = 0").contains("x: scale")
        );
        assert!(error("[inputs]\nsurge = { at = \"u\" }\n[outputs]").contains("unknown variant `surge`"));
        assert!(error("step = 2\ninputs.ax = { at = \"u\" }\n[outputs]").contains("0.0001 to 0.5 s"));
        assert!(error("[inputs]\n[outputs]").contains("[inputs] is empty"));
    }
}
