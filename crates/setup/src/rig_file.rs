//! Rig files: where a platform's joints are, and what its legs or cranks can do.
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
//! A platform with cranks has a table `crank` in the place of `actuator`; its base joints
//! are where the axles are:
//!
//! ```toml
//! [crank]                            # motors with an arm each, and a rod from its end to the platform
//! arm = 0.18                         # m, from the axle to the rod
//! rod = 0.72                         # m, from the arm's end to the platform joint
//! headingDegrees = [150, -90, 30, 150, -90, 30] # of the level arms, from x towards y; the axles are across
//! minAngleDegrees = -60.0            # of the arm above level
//! maxAngleDegrees = 60.0
//! leastTransmission = 0.3            # optional: sine of the least angle between rod and arm
//! velocityLimit = 6.0                # rad/s
//! accelerationLimit = 60.0           # rad/s2
//! diameter = 0.02                    # m, optional: of the rods
//! ```
//!
//! Joints and actuators are required in full, since a mixture with the default rig describes no
//! machine. The head and the safety units' speeds and accelerations are the default's where they
//! are not given. The safety units' positions then follow from the rig: 95 % of what it reaches
//! along each axis alone.

use moris_interface::shown;
use moris_washout::interface::{Parameters, SafetyParameters, StructureParameters};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::{Axis, displaced, single_axis_range, stroke_clearance};
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
    /// Limits of the legs; none for a rig with cranks.
    pub actuator: Option<Actuator>,
    /// Cranks in the place of legs.
    pub crank: Option<Crank>,
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

/// Arms, rods and limits of cranks.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct Crank {
    /// From the axle to the rod \[m\].
    pub arm: f64,
    /// From the arm's end to the platform joint \[m\].
    pub rod: f64,
    /// Of the arms while they are level, from x towards y \[deg\].
    pub heading_degrees: [f64; 6],
    /// Lowest angle of the arms above level \[deg\].
    pub min_angle_degrees: f64,
    /// Highest angle of the arms \[deg\].
    pub max_angle_degrees: f64,
    /// Sine of the least angle between rod and arm that is allowed.
    pub least_transmission: Option<f64>,
    /// \[rad/s\]
    pub velocity_limit: f64,
    /// \[rad/s2\]
    pub acceleration_limit: f64,
    /// Thickness of the rods, as [`Actuator::diameter`] \[m\].
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
    actuator.accelerationLimit actuator.diameter crank.arm crank.rod crank.headingDegrees \
    crank.minAngleDegrees crank.maxAngleDegrees crank.leastTransmission crank.velocityLimit \
    crank.accelerationLimit crank.diameter head.height head.torsoLength \
    safety.positionLimit safety.velocityLimit safety.accelerationLimit";

/// A platform larger than this, in metres, has been given in other units.
const MAX_PLATFORM_SIZE: f64 = 30.0;

/// Reads the text of a rig file. `source_name` is what errors call the file.
///
/// # Errors
/// Text that is not TOML; a key that is not one, is missing or has a value that it cannot have.
pub fn read(text: &str, source_name: &str) -> Result<RigFile, Error> {
    // Remedy for a rig of another kind.
    const OTHER_KIND: &str = "rigs with six legs in a table [actuator], or six motors with arms and rods in a table [crank], are \
                              supported, not cables or fewer legs; docs/platforms.md has the keys, and says how the pose \
                              serves other rigs";
    let toml_error = |error| Error::toml(source_name, &error, "a rig file is TOML; copy examples/rigs/default.toml");
    let table: toml::Table = text.parse().map_err(toml_error)?;
    // Before anything else: a misspelt key is also a missing one, and the misspelling is what helps.
    if let Some(name) = dotted_keys(&table).find(|key| !RIG_FILE_KEYS.split(' ').any(|known| known == *key)) {
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

/// True for a key of other mechanisms than legs and cranks.
fn is_other_kind(key: &str) -> bool {
    const WORDS: [&str; 8] = ["servo", "crank", "arm", "rod", "horn", "rotary", "cable", "winch"];
    !key.starts_with("crank.")
        && key.to_lowercase().split('.').any(|part| WORDS.iter().any(|word| part.starts_with(word)))
}

/// The keys of a table, those of tables within it after its name.
fn dotted_keys(table: &toml::Table) -> impl Iterator<Item = String> {
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

impl Crank {
    /// Values with the largest that can be meant, and their units.
    fn units(&self) -> [(&'static str, f64, f64, [&'static str; 2]); 4] {
        // An arm longer than this, in metres, has been given in other units.
        const MAX_CRANK_ARM: f64 = 5.0;
        // A crank faster than this, in rad/s, has been given in degrees.
        const MAX_CRANK_SPEED: f64 = 60.0;
        // A crank with more than this, in rad/s2, has been given in degrees.
        const MAX_CRANK_ACCELERATION: f64 = 5000.0;
        [
            ("crank.arm", self.arm, MAX_CRANK_ARM, ["m", "millimetres"]),
            ("crank.rod", self.rod, MAX_PLATFORM_SIZE, ["m", "millimetres"]),
            ("crank.velocityLimit", self.velocity_limit, MAX_CRANK_SPEED, ["rad/s", "deg/s"]),
            ("crank.accelerationLimit", self.acceleration_limit, MAX_CRANK_ACCELERATION, ["rad/s2", "deg/s2"]),
        ]
    }

    /// Gives a rig these cranks. Its shortest and longest length become those that
    /// the joints can be apart.
    fn put_into(&self, rig: &mut Rig) {
        let Crank { arm, rod, .. } = *self;
        rig.crank_arm = arm;
        rig.crank_rod = rod;
        rig.crank_heading = self.heading_degrees.map(f64::to_radians);
        rig.crank_min_angle = self.min_angle_degrees.to_radians();
        rig.crank_max_angle = self.max_angle_degrees.to_radians();
        rig.crank_least_transmission = self.least_transmission.unwrap_or(rig.crank_least_transmission);
        rig.velocity_limit = arm * self.velocity_limit;
        rig.acceleration_limit = arm * self.acceleration_limit;
        // Between rod and arm there is at least the angle of the least transmission.
        let along = 2.0 * arm * rod * (1.0 - rig.crank_least_transmission.powi(2)).max(0.0).sqrt();
        let squares = arm * arm + rod * rod;
        rig.min_length = (squares - along).max(0.0).sqrt();
        rig.max_length = (squares + along).sqrt();
    }
}

impl RigFile {
    /// Checks beyond the file's syntax: each joint once, and lengths in metres.
    fn check_joints(&self, source_name: &str) -> Result<(), Error> {
        // Joints closer than this to each other are one [m].
        const MIN_JOINT_DISTANCE: f64 = 1e-3;
        // A leg thicker than this, in metres, has been given in other units.
        const LARGEST_DIAMETER: f64 = 1.0;
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
        for (name, angles) in self.angles() {
            // Around a circle degrees go beyond this; the whole range of an arm is wider.
            const MAX_RADIANS: f64 = 6.3;
            if angles.iter().all(|angle| angle.abs() <= MAX_RADIANS) {
                let reason = format!("is {angles:?}; are these radians? Write degrees");
                return Err(Error::wrong_value(source_name, name, reason));
            }
        }
        match (&self.actuator, &self.crank) {
            (Some(actuator), None) => self.check_actuators(actuator, source_name)?,
            (None, Some(crank)) => self.check_units(source_name, &crank.units())?,
            _ => {
                let reason = "needs a table [actuator] for legs or a table [crank] for cranks; not both".to_owned();
                return Err(Error::wrong_value(source_name, "[actuator]", reason));
            }
        }
        if let Some(diameter) = self.diameter().filter(|diameter| !(0.0..LARGEST_DIAMETER).contains(diameter)) {
            let reason = format!("is {} m, but must be from 0 to {LARGEST_DIAMETER} m", shown(diameter));
            let name = if self.crank.is_some() { "crank.diameter" } else { "actuator.diameter" };
            return Err(Error::wrong_value(source_name, name, reason));
        }
        Ok(())
    }

    /// The lists of angles of the file \[deg\], with their keys; those of a crank's range as one.
    fn angles(&self) -> Vec<(&'static str, Vec<f64>)> {
        let joints = [("base.degrees", self.base.degrees), ("platform.degrees", self.platform.degrees)];
        let heading = ("crank.headingDegrees", self.crank.map(|crank| crank.heading_degrees));
        let range = self.crank.map(|crank| vec![crank.min_angle_degrees, crank.max_angle_degrees]);
        let lists = joints.into_iter().chain([heading]).map(|(name, list)| (name, list.map(Vec::from)));
        let all = lists.chain([("[crank] minAngleDegrees, maxAngleDegrees", range)]);
        all.filter_map(|(name, list)| Some((name, list?))).collect()
    }

    /// Diameter of the legs or of the cranks' rods, if the file has it \[m\].
    pub fn diameter(&self) -> Option<f64> {
        self.actuator.and_then(|legs| legs.diameter).or(self.crank.and_then(|crank| crank.diameter))
    }

    /// Checks that the rig's height and these values are in their units: name, value, the largest
    /// that can be meant, the unit and the one that is suspected.
    fn check_units(&self, source_name: &str, values: &[(&str, f64, f64, [&str; 2])]) -> Result<(), Error> {
        let height = ("neutralHeight", self.neutral_height.abs(), MAX_PLATFORM_SIZE, ["m", "millimetres"]);
        for (name, value, largest, [unit, other]) in [height].iter().chain(values) {
            // Numbers that are beyond any unit have the parameter's range as their error.
            if value > largest && *value < 1e6 {
                let reason = format!("is {}; is this in {other}? Write {unit}", shown(*value));
                return Err(Error::wrong_value(source_name, name, reason));
            }
        }
        Ok(())
    }

    /// Checks that the legs' lengths are in metres from joint to joint, and their limits in m/s and
    /// m/s2.
    fn check_actuators(&self, legs: &Actuator, source_name: &str) -> Result<(), Error> {
        // A leg faster than this, in m/s, has been given in other units.
        const MAX_LEG_SPEED: f64 = 20.0;
        // A leg with more than this, in m/s2, has been given in other units.
        const LARGEST_ACCELERATION: f64 = 500.0;
        let Actuator { min_length, max_length, velocity_limit, acceleration_limit, .. } = *legs;
        let values = [
            ("actuator.minLength", min_length, MAX_PLATFORM_SIZE, ["m", "millimetres"]),
            ("actuator.maxLength", max_length, MAX_PLATFORM_SIZE, ["m", "millimetres"]),
            ("actuator.velocityLimit", velocity_limit, MAX_LEG_SPEED, ["m/s", "mm/s"]),
            ("actuator.accelerationLimit", acceleration_limit, LARGEST_ACCELERATION, ["m/s2", "mm/s2"]),
        ];
        self.check_units(source_name, &values)?;
        let rig = self.rig();
        let neutral = leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig));
        let mean = neutral.iter().sum::<f64>() / 6.0;
        // No leg of one stage is more than twice as long as when it is retracted.
        let is_travel = min_length < 0.5 * max_length && max_length < mean;
        if is_travel {
            // From neutral, or from the retracted leg.
            let stroke = max_length - min_length;
            let shortest = if min_length < 0.0 { mean + min_length } else { mean - 0.5 * stroke };
            let longest = shortest + stroke;
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
        let mut rig = Rig {
            base: coordinates(&self.base),
            platform: coordinates(&self.platform),
            neutral_height: self.neutral_height,
            ..Rig::default()
        };
        if let Some(legs) = &self.actuator {
            (rig.min_length, rig.max_length) = (legs.min_length, legs.max_length);
            (rig.velocity_limit, rig.acceleration_limit) = (legs.velocity_limit, legs.acceleration_limit);
        }
        if let Some(crank) = &self.crank {
            crank.put_into(&mut rig);
        }
        rig
    }

    /// The washout's parameters on this rig, all others the default's.
    pub fn parameters(&self) -> Parameters {
        let defaults = Parameters::default();
        let rig = self.rig();
        let head_height = self.head.height.unwrap_or(defaults.structure.head_height);
        let vector = |given: Option<[f64; 3]>, default| given.map_or(default, Vector3::from);
        // Legs that do not reach neutral reach nothing, and a limit of nothing would be refused before they are.
        let reaches_neutral = stroke_clearance(&rig, &displaced(&rig, Axis::Heave, 0.0)) >= 0.0;
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
    /// value out of its range. That of cranks ends with values that are accepted.
    pub fn check(&self) -> Result<(), ParameterError> {
        check(&self.parameters()).map_err(|error| self.with_remedy(error))
    }

    /// The error with the [`RigFile::accepted_cranks`] at its end, if there are any.
    pub fn with_remedy(&self, error: ParameterError) -> ParameterError {
        match self.accepted_cranks() {
            Some(values) => ParameterError { reason: format!("{}. Accepted is {values}", error.reason), ..error },
            None => error,
        }
    }

    /// Values with which cranks that are refused were tried and are accepted: the height or the
    /// rods with level arms at neutral, or narrower angles, or both. `None` for legs, for cranks
    /// that are accepted, and where none of these is.
    pub fn accepted_cranks(&self) -> Option<String> {
        let crank = self.crank.filter(|_| !self.is_accepted())?;
        let rig = self.rig();
        // From the end of each level arm to its platform joint, without the height.
        let ends: [Vector3<f64>; 6] = std::array::from_fn(|i| {
            let (sin, cos) = crank.heading_degrees[i].to_radians().sin_cos();
            rig.platform[i] - rig.base[i] - crank.arm * Vector3::new(cos, sin, 0.0)
        });
        let mean = |length: &dyn Fn(&Vector3<f64>) -> f64| {
            let mean = ends.iter().map(length).sum::<f64>() / 6.0;
            Some((mean * 1e4).round() / 1e4).filter(|mean| mean.is_finite())
        };
        let upward = self.neutral_height.signum();
        let height = mean(&|end| upward * (crank.rod.powi(2) - end.xy().norm_squared()).sqrt() - end.z);
        let rod = mean(&|end| end.xy().norm().hypot(end.z + self.neutral_height));
        let of_height =
            |height| (format!("neutralHeight = {height}, "), RigFile { neutral_height: height, ..self.clone() });
        let of_rod =
            |rod| (format!("crank.rod = {rod}, "), RigFile { crank: Some(Crank { rod, ..crank }), ..self.clone() });
        let others: Vec<(String, RigFile)> = height.map(of_height).into_iter().chain(rod.map(of_rod)).collect();
        let narrower = |(other, rig): &(String, RigFile)| {
            (3..10).rev().find_map(|tenths| {
                let crank = rig.crank?;
                let [low, high] = [crank.min_angle_degrees, crank.max_angle_degrees]
                    .map(|angle| (angle * f64::from(tenths) / 10.0).round());
                let crank = Crank { min_angle_degrees: low, max_angle_degrees: high, ..crank };
                let is_accepted = RigFile { crank: Some(crank), ..rig.clone() }.is_accepted();
                is_accepted.then(|| format!("{other}crank.minAngleDegrees = {low}, crank.maxAngleDegrees = {high}"))
            })
        };
        let alone = others.iter().filter(|(_, rig)| rig.is_accepted()).map(|(other, _)| other.trim_end_matches(", "));
        let found: Vec<String> = alone.map(str::to_owned).chain(narrower(&(String::new(), self.clone()))).collect();
        if found.is_empty() { others.iter().find_map(narrower) } else { Some(found.join("; or ")) }
    }

    fn is_accepted(&self) -> bool {
        check(&self.parameters()).is_ok()
    }
}
