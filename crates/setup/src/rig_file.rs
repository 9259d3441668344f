//! Rig files: where a platform's joints are, and what its legs can do.
//!
//! ```toml
//! name = "MORIS, default rig"
//! neutralHeight = 1.091              # m: the platform's origin above the base's; negative where it hangs
//!
//! [base]                             # joints on the base, in the base frame, legs 1 to 6 in order
//! radius = 1.0                       # m: on a circle ...
//! degrees = [-8, 8, 112, 128, 232, 248]
//!
//! [platform]                         # joints on the platform, in the platform frame
//! joints = [[0.52, -0.67, 0.0], [0.52, 0.67, 0.0], [0.32, 0.79, 0.0], [-0.84, 0.12, 0.0], [-0.84, -0.12, 0.0], [0.32, -0.79, 0.0]]
//!                                    # ... or one by one, in m
//! [actuator]
//! minLength = 1.0                    # m, from joint to joint
//! maxLength = 1.6
//! velocityLimit = 1.0                # m/s
//! accelerationLimit = 15.0           # m/s2
//! diameter = 0.1                     # m, optional: `rig check` looks for legs that touch each other
//!
//! [head]                             # optional: the rider's
//! height = 1.2                       # m above the platform
//! torsoLength = 0.75
//!
//! [safety]                           # optional: the safety units' limits, for x, y, z
//! positionLimit = [0.37, 0.37, 0.33] # m from neutral
//! velocityLimit = [1.0, 1.0, 1.0]    # m/s
//! accelerationLimit = [10.0, 10.0, 10.0] # m/s2
//! ```
//!
//! Joints and legs are required in full, since a mixture with the default rig describes no machine.
//! The head and the safety units' speeds and accelerations are the default's where they are not
//! given. The safety units' positions then follow from the rig: 95 % of what it reaches along each
//! axis alone.

use moris_interface::shown;
use moris_washout::interface::{Parameters, SafetyParameters, StructureParameters};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::{Axis, displaced, single_axis_range, stroke_margin};
use moris_washout::platform::{Geometry, Pose, leg_lengths};
use moris_washout::{ParameterError, Rig, check};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::names::nearest;
use crate::{Error, NamedValues};

/// Fraction of the reach along an axis alone that a safety unit allows where the file does not say.
pub const SAFETY_FRACTION: f64 = 0.95;

/// A rig file's contents; see the [module](self).
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct RigFile {
    /// Name of the rig.
    pub name: String,
    /// Height of the platform's origin over the base's at neutral \[m\]; negative where it hangs.
    pub neutral_height: f64,
    /// Joints on the base.
    pub base: Joints,
    /// Joints on the platform.
    pub platform: Joints,
    /// Limits of the legs.
    pub actuator: Actuator,
    /// Where the rider's head is.
    #[serde(default)]
    pub head: Head,
    /// The safety units' limits.
    #[serde(default)]
    pub safety: Safety,
}

/// Six joints: on a circle, or one by one.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct Joints {
    /// Of the circle \[m\].
    radius: Option<f64>,
    /// Where on the circle, from x towards y \[deg\].
    degrees: Option<[f64; 6]>,
    /// x, y, z of each joint \[m\].
    joints: Option<[[f64; 3]; 6]>,
}

/// Stroke, speed and acceleration of each leg.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct Actuator {
    /// \[m\]
    pub min_length: f64,
    /// \[m\]
    pub max_length: f64,
    /// \[m/s\]
    pub velocity_limit: f64,
    /// \[m/s2\]
    pub acceleration_limit: f64,
    /// Thickness, which keeps two legs apart \[m\]; `rig check` assumes one where none is given.
    pub diameter: Option<f64>,
}

/// The rider's head.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct Head {
    /// Above the platform \[m\].
    pub height: Option<f64>,
    /// From seat to head \[m\]; the default's where none is given, or the height if that is less.
    pub torso_length: Option<f64>,
}

/// The safety units' limits along x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct Safety {
    /// From neutral \[m\].
    pub position_limit: Option<[f64; 3]>,
    /// \[m/s\]
    pub velocity_limit: Option<[f64; 3]>,
    /// \[m/s2\]
    pub acceleration_limit: Option<[f64; 3]>,
}

/// Every key that a rig file may have.
const RIG_FILE_KEYS: &str = "name neutralHeight base.radius base.degrees base.joints platform.radius platform.degrees \
    platform.joints actuator.minLength actuator.maxLength actuator.velocityLimit \
    actuator.accelerationLimit actuator.diameter head.height head.torsoLength \
    safety.positionLimit safety.velocityLimit safety.accelerationLimit";

/// A platform larger than this, in metres, has been given in other units.
const MAX_PLATFORM_SIZE: f64 = 30.0;
/// Joints closer than this to each other are one \[m\].
const MIN_JOINT_DISTANCE: f64 = 1e-3;
/// A leg faster than this, in m/s, has been given in other units.
const MAX_LEG_SPEED: f64 = 20.0;
/// A leg with more than this, in m/s2, has been given in other units.
const LARGEST_ACCELERATION: f64 = 500.0;
/// A leg thicker than this, in metres, has been given in other units.
const LARGEST_DIAMETER: f64 = 1.0;

/// Reads the text of a rig file. `source_name` is what errors call the file.
///
/// # Errors
/// Text that is not TOML; a key that is not one, is missing or has a value that it cannot have.
pub fn read(text: &str, source_name: &str) -> Result<RigFile, Error> {
    let toml_error = |error| Error::toml(source_name, &error, "a rig file is TOML; copy examples/rigs/default.toml");
    let table: toml::Table = text.parse().map_err(toml_error)?;
    // Before anything else: a misspelt key is also a missing one, and the misspelling is what helps.
    if let Some(name) = keys(&table).find(|key| !RIG_FILE_KEYS.split(' ').any(|known| known == *key)) {
        return Err(Error::UnknownName {
            source_name: source_name.to_owned(),
            what: "key",
            nearest: if is_other_kind(&name) { Vec::new() } else { nearest(&name, RIG_FILE_KEYS.split(' ')) },
            otherwise: if is_other_kind(&name) { OTHER_KIND } else { "docs/rig.md lists the keys of a rig file" },
            name,
        });
    }
    if let Some((name, value)) = not_finite(&table) {
        return Err(Error::wrong_value(source_name, &name, format!("is {value}, but must be a finite number")));
    }
    // Lists of joints of a rig with fewer legs.
    let remedy = |error: toml::de::Error| match error.message().contains("invalid length") {
        true => Error::toml(source_name, &error, OTHER_KIND),
        false => toml_error(error),
    };
    let file: RigFile = toml::from_str(text).map_err(remedy)?;
    file.check_joints(source_name)?;
    Ok(file)
}

/// Remedy for a rig of another kind.
const OTHER_KIND: &str = "rigs with six legs that change their lengths are supported, not cranks, cables or fewer legs; \
                          docs/platforms.md says how the pose serves other rigs";

/// True for a key of cranks, cables or other mechanisms than legs.
fn is_other_kind(key: &str) -> bool {
    const WORDS: [&str; 8] = ["servo", "crank", "arm", "rod", "horn", "rotary", "cable", "winch"];
    key.to_lowercase().split('.').any(|part| WORDS.iter().any(|word| part.starts_with(word)))
}

/// The keys of a table, those of tables within it after its name.
fn keys(table: &toml::Table) -> impl Iterator<Item = String> {
    table.iter().flat_map(|(key, value)| match value {
        toml::Value::Table(inner) => inner.keys().map(|inner| format!("{key}.{inner}")).collect(),
        _ => vec![key.clone()],
    })
}

/// The first number of a table that is not finite, with its key. A place in a
/// list is counted from 1.
fn not_finite(table: &toml::Table) -> Option<(String, f64)> {
    table.iter().find_map(|(key, value)| not_finite_in(key, value))
}

fn not_finite_in(name: &str, value: &toml::Value) -> Option<(String, f64)> {
    match value {
        toml::Value::Float(number) => (!number.is_finite()).then(|| (name.to_owned(), *number)),
        toml::Value::Array(items) => {
            let mut items = items.iter().zip(1..);
            items.find_map(|(item, place)| not_finite_in(&format!("{name}[{place}]"), item))
        }
        toml::Value::Table(inner) => {
            inner.iter().find_map(|(key, value)| not_finite_in(&format!("{name}.{key}"), value))
        }
        _ => None,
    }
}

impl Joints {
    /// The joints \[m\].
    pub fn coordinates(&self) -> Option<[Vector3<f64>; 6]> {
        match (self.radius, self.degrees, self.joints) {
            (None, None, Some(joints)) => Some(joints.map(Vector3::from)),
            (Some(radius), Some(degrees), None) => Some(degrees.map(|angle| {
                let (sin, cos) = angle.to_radians().sin_cos();
                Vector3::new(radius * cos, radius * sin, 0.0)
            })),
            _ => None,
        }
    }
}

impl RigFile {
    /// Checks beyond the file's syntax: each joint once, and lengths in metres.
    fn check_joints(&self, source_name: &str) -> Result<(), Error> {
        for (name, joints) in [("base", &self.base), ("platform", &self.platform)] {
            let wrong = |reason: String| Error::wrong_value(source_name, &format!("[{name}]"), reason);
            let joints = joints
                .coordinates()
                .ok_or_else(|| wrong("needs either radius and degrees, or joints; not both".to_owned()))?;
            let farthest = joints.iter().map(Vector3::amax).fold(0.0, f64::max);
            if joints.iter().all(|joint| (joint - joints[0]).norm() < MIN_JOINT_DISTANCE) {
                return Err(wrong("has all its joints at one point; a platform needs at least three".to_owned()));
            }
            if farthest > MAX_PLATFORM_SIZE {
                let farthest = shown(farthest);
                return Err(wrong(format!("has a joint {farthest} m away; are these millimetres? Write metres")));
            }
        }
        self.check_actuators(source_name)?;
        if let Some(diameter) = self.actuator.diameter.filter(|diameter| !(0.0..LARGEST_DIAMETER).contains(diameter)) {
            let reason = format!("is {} m, but must be from 0 to {LARGEST_DIAMETER} m", shown(diameter));
            return Err(Error::wrong_value(source_name, "actuator.diameter", reason));
        }
        Ok(())
    }

    /// Checks that the legs' lengths are in metres from joint to joint, and their limits in m/s and
    /// m/s2.
    fn check_actuators(&self, source_name: &str) -> Result<(), Error> {
        let Actuator { min_length, max_length, velocity_limit, acceleration_limit, .. } = self.actuator;
        for (name, value, largest, [unit, other]) in [
            ("neutralHeight", self.neutral_height.abs(), MAX_PLATFORM_SIZE, ["m", "millimetres"]),
            ("actuator.minLength", min_length, MAX_PLATFORM_SIZE, ["m", "millimetres"]),
            ("actuator.maxLength", max_length, MAX_PLATFORM_SIZE, ["m", "millimetres"]),
            ("actuator.velocityLimit", velocity_limit, MAX_LEG_SPEED, ["m/s", "mm/s"]),
            ("actuator.accelerationLimit", acceleration_limit, LARGEST_ACCELERATION, ["m/s2", "mm/s2"]),
        ] {
            // Numbers that are beyond any unit have the parameter's range as their error.
            if value > largest && value < 1e6 {
                let reason = format!("is {}; is this in {other}? Write {unit}", shown(value));
                return Err(Error::wrong_value(source_name, name, reason));
            }
        }
        let rig = self.rig();
        let neutral = leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig));
        let mean = neutral.iter().sum::<f64>() / 6.0;
        let is_travel = min_length <= 0.0 && max_length > min_length && max_length < mean;
        if is_travel {
            // From neutral, or from the retracted leg.
            let shortest = if min_length < 0.0 { mean + min_length } else { mean - 0.5 * max_length };
            let longest = shortest + max_length - min_length;
            let reason = format!(
                "is {}, but lengths are from joint to joint, not travel; with neutral in the middle of this stroke minLength \
                 would be {shortest:.3} and maxLength {longest:.3}",
                shown(min_length)
            );
            return Err(Error::wrong_value(source_name, "actuator.minLength", reason));
        }
        Ok(())
    }

    /// The rig as the washout takes it.
    pub fn rig(&self) -> Rig {
        let coordinates = |joints: &Joints| joints.coordinates().expect("the file was checked when it was read");
        Rig {
            base: coordinates(&self.base),
            platform: coordinates(&self.platform),
            neutral_height: self.neutral_height,
            min_length: self.actuator.min_length,
            max_length: self.actuator.max_length,
            velocity_limit: self.actuator.velocity_limit,
            acceleration_limit: self.actuator.acceleration_limit,
        }
    }

    /// The washout's parameters on this rig, all others the default's.
    pub fn parameters(&self) -> Parameters {
        let defaults = Parameters::default();
        let rig = self.rig();
        let head_height = self.head.height.unwrap_or(defaults.structure.head_height);
        let vector = |given: Option<[f64; 3]>, default| given.map_or(default, Vector3::from);
        // Legs that do not reach neutral reach nothing, and a limit of nothing would be refused before they are.
        let reaches_neutral = stroke_margin(&rig, &displaced(&rig, Axis::Heave, 0.0)) >= 0.0;
        let reach = || {
            if !reaches_neutral {
                return defaults.safety.position_limit;
            }
            let min_reach = |axis| single_axis_range(&rig, axis).min_reach();
            SAFETY_FRACTION * Vector3::new(min_reach(Axis::Surge), min_reach(Axis::Sway), min_reach(Axis::Heave))
        };
        Parameters {
            safety: SafetyParameters {
                position_limit: self.safety.position_limit.map_or_else(reach, Vector3::from),
                velocity_limit: vector(self.safety.velocity_limit, defaults.safety.velocity_limit),
                acceleration_limit: vector(self.safety.acceleration_limit, defaults.safety.acceleration_limit),
            },
            structure: StructureParameters {
                head_height,
                torso_length: self.head.torso_length.unwrap_or(defaults.structure.torso_length.min(head_height)),
                ..defaults.structure
            },
            rig,
            ..defaults
        }
    }

    /// The file as values of the FMU's variables.
    pub fn values(&self) -> NamedValues {
        crate::named_values::changed(&self.parameters())
    }

    /// Checks that a washout can be constructed on this rig.
    ///
    /// # Errors
    /// Errors of the rig: legs that do not reach neutral, a singularity inside the stroke, a
    /// value out of its range.
    pub fn check(&self) -> Result<(), ParameterError> {
        check(&self.parameters())
    }
}
