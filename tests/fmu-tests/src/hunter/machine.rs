//! Random machines and random parameters.

use anyhow::Result;
use moris_interface::{Kind, Row, Variability};
use moris_setup::{changed, rig_file};

use super::episode::Values;
use super::random::Random;
use super::variables::Variables;

/// The rigs shipped with the workbench.
const RIGS: [&str; 4] = [
    include_str!("../../../../examples/rigs/default.toml"),
    include_str!("../../../../examples/rigs/compact.toml"),
    include_str!("../../../../examples/rigs/long-stroke.toml"),
    include_str!("../../../../examples/rigs/narrow.toml"),
];

/// Values of log-uniform draws with tails: lowest, low, high, highest.
type Range = [f64; 4];

const LEG_ACCELERATION: Range = [0.2, 0.5, 30.0, 100.0];
const LEG_VELOCITY: Range = [0.02, 0.1, 2.0, 5.0];
const SAFETY_POSITION: Range = [1e-6, 0.01, 1.0, 1e6];
const SAFETY_VELOCITY: Range = [1e-5, 0.02, 3.0, 1e6];
const SAFETY_ACCELERATION: Range = [1e-4, 0.1, 30.0, 1e7];
const FREQUENCY: Range = [1e-6, 0.1, 20.0, 1e3];
const DAMPING: Range = [1e-3, 0.05, 2.0, 1e2];
const SCALE: Range = [1e-3, 0.2, 5.0, 1e3];
const LIMIT: Range = [1e-3, 0.5, 100.0, 1e9];
const LONGEST_STEP: Range = [1e-5, 2e-4, 0.02, 0.05];

/// Draws machines: parameters that differ from the default, of which a washout can perhaps be made.
pub struct Machines<'a> {
    variables: &'a Variables,
    rigs: Vec<Values>,
}

impl<'a> Machines<'a> {
    /// Reads the shipped rigs.
    ///
    /// # Errors
    /// A shipped rig cannot be read.
    pub fn new(variables: &'a Variables) -> Result<Self> {
        let rigs = RIGS
            .iter()
            .map(|text| Ok(changed(&rig_file::read(text, "a shipped rig")?.parameters()).into_iter().collect()))
            .collect::<Result<_>>()?;
        Ok(Machines { variables, rigs })
    }

    /// A machine with fixed and tunable parameters.
    pub fn draw(&self, random: &mut Random) -> Values {
        let mut machine = Values::new();
        match random.below(6) {
            0 | 1 => machine = random.pick(&[&self.rigs[1], &self.rigs[2], &self.rigs[3]]).clone(),
            2 => self.scaled_rig(random, &mut machine),
            3 => self.small_rig(random, &mut machine),
            _ => {}
        }
        let is_small = machine.contains_key("solver.maxStep");
        if !is_small && random.chance(0.8) {
            machine.insert("actuator.accelerationLimit".into(), random.log_with_tails(LEG_ACCELERATION));
            machine.insert("actuator.velocityLimit".into(), random.log_with_tails(LEG_VELOCITY));
        }
        if !is_small && random.chance(0.7) {
            machine.insert("solver.maxStep".into(), random.log_with_tails(LONGEST_STEP));
        }
        self.draw_structure(random, &mut machine);
        machine.extend(self.draw_tunables(random, 0.5));
        machine
    }

    /// A shipped rig in another size, each joint a little elsewhere, and with another stroke.
    fn scaled_rig(&self, random: &mut Random, machine: &mut Values) {
        let rig = &self.rigs[random.below(self.rigs.len())];
        let size = if random.chance(0.5) { random.log_between(0.3, 4.0) } else { 1.0 };
        let disorder = random.pick(&[0.0, 0.02, 0.1]);
        for (slot, _, name) in self.variables.parameters(Variability::Fixed) {
            let value = rig.get(&name).copied().unwrap_or(self.variables.start(slot));
            let is_joint = name.starts_with("rig.base") || name.starts_with("rig.platform");
            let is_length =
                is_joint || name == "rig.neutralHeight" || name.ends_with("Length") && name.starts_with("act");
            if is_length {
                let moved = if is_joint { random.between(-disorder, disorder) } else { 0.0 };
                machine.insert(name, size * (value + moved));
            }
        }
    }

    /// The default rig in a small size, its joints displaced, with legs near an end of the stroke
    /// at neutral, or near both.
    fn small_rig(&self, random: &mut Random, machine: &mut Values) {
        let size = random.between(0.3, 0.6);
        let mut value = |name: &str, displaced: f64| {
            let start = self.variables.slot(name).map_or(0.0, |slot| self.variables.start(slot));
            let value = size * (start + random.between(-displaced, displaced));
            machine.insert(name.to_owned(), value);
            value
        };
        let height = value("rig.neutralHeight", 0.0);
        let lengths = [1, 2, 3, 4, 5, 6].map(|leg| {
            let square = ["x", "y", "z"].map(|axis| {
                let [base, platform] = ["base", "platform"].map(|end| value(&format!("rig.{end}[{leg}].{axis}"), 0.1));
                (platform + if axis == "z" { height } else { 0.0 } - base).powi(2)
            });
            square.iter().sum::<f64>().sqrt()
        });
        let [little, much] = [random.log_between(0.01, 0.04), 0.3 * size];
        let [below, above] = random.pick(&[[little, much], [much, little], [little, little]]);
        machine.insert("actuator.minLength".into(), lengths.into_iter().fold(f64::INFINITY, f64::min) - below);
        machine.insert("actuator.maxLength".into(), lengths.into_iter().fold(0.0, f64::max) + above);
        machine.insert("actuator.accelerationLimit".into(), random.log_between(2.0, 20.0));
        machine.insert("actuator.velocityLimit".into(), random.log_between(0.2, 1.0));
        machine.insert("solver.maxStep".into(), random.pick(&[1e-3, 5e-3, 0.01]));
        for axis in ["x", "y", "z"] {
            machine.insert(format!("safety.{axis}.positionLimit"), random.log_between(0.01, 0.2));
        }
    }

    /// The filters' structure and the rider.
    fn draw_structure(&self, random: &mut Random, machine: &mut Values) {
        for (slot, row, name) in self.variables.parameters(Variability::Fixed) {
            // The oracle judges legs.
            let is_of_rig = ["rig.", "actuator.", "crank."].iter().any(|group| name.starts_with(group));
            if is_of_rig || name == "solver.maxStep" {
                continue;
            }
            let choice = matches!(row.kind, Kind::Enumeration(_) | Kind::Integer | Kind::Boolean);
            if random.chance(if choice { 0.4 } else { 0.15 }) {
                let value = self.value(random, slot, row, &name);
                machine.insert(name, value);
            }
        }
        let head = |machine: &Values, name: &str, start: f64| machine.get(name).copied().unwrap_or(start);
        let height = head(machine, "head.height", 1.2);
        if head(machine, "head.torsoLength", 0.75) > height {
            machine.insert("head.torsoLength".into(), 0.5 * height);
        }
    }

    /// Tunable parameters; `probability` is that of a group of them to be drawn at all.
    pub fn draw_tunables(&self, random: &mut Random, probability: f64) -> Values {
        let mut values = Values::new();
        let groups = ["splitter.", "angular.", "safety.", "tilt.", "scale.", "limit."];
        let drawn = groups.map(|_| random.chance(probability));
        let others = random.chance(0.5 * probability);
        for (slot, row, name) in self.variables.parameters(Variability::Tunable) {
            let group = groups.iter().position(|group| name.starts_with(group));
            if group.map_or(others, |group| drawn[group]) && random.chance(0.8) {
                let value = self.value(random, slot, row, &name);
                values.insert(name, value);
            }
        }
        values
    }

    /// A value for this parameter.
    pub fn value(&self, random: &mut Random, slot: usize, row: &Row, name: &str) -> f64 {
        let value = match row.kind {
            Kind::Enumeration(enumeration) => random.integer(1, enumeration.items.len()) as f64,
            Kind::Boolean => f64::from(random.chance(0.5)),
            Kind::Integer => {
                let (low, high) = row.range.unwrap_or((self.variables.start(slot), self.variables.start(slot)));
                random.integer(low as usize, high as usize) as f64
            }
            Kind::Real(_) => self.real_value(random, slot, name),
        };
        row.range.map_or(value, |(low, high)| value.clamp(low, high))
    }

    fn real_value(&self, random: &mut Random, slot: usize, name: &str) -> f64 {
        let start = self.variables.start(slot);
        let range = match name {
            "tilt.angleLimit" => [1e-4, 0.05, 1.0, 1.047],
            "gravity" => [0.5, 9.0, 10.0, 30.0],
            "input.cutoff" if random.chance(0.3) => return 0.0,
            "input.cutoff" => [1e-3, 1.0, 100.0, 1e6],
            "head.height" | "head.torsoLength" => [1e-3, 0.3, 2.0, 10.0],
            _ if name.starts_with("washoutPoint") => return random.between(-2.0, 2.0),
            _ if name.starts_with("safety.") && name.ends_with("positionLimit") => SAFETY_POSITION,
            _ if name.starts_with("safety.") && name.ends_with("velocityLimit") => SAFETY_VELOCITY,
            _ if name.starts_with("safety.") && name.ends_with("accelerationLimit") => SAFETY_ACCELERATION,
            _ if name.starts_with("scale.") => {
                return if random.chance(0.2) { -1.0 } else { 1.0 } * random.log_with_tails(SCALE);
            }
            _ if name.starts_with("limit.") => LIMIT,
            _ if name.contains("mega") => FREQUENCY,
            _ if name.contains("eta") => DAMPING,
            _ if start > 0.0 => [1e-3, 0.1, 10.0, 1e3].map(|factor| factor * start),
            _ => [1e-3, 0.1, 10.0, 1e3],
        };
        random.log_with_tails(range)
    }
}
