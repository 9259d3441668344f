//! The systems of which there are packages.

use moris_interface::{Causality, Identity};
use toml::{Table, Value};

use moris_build_fmu::Error;
use moris_build_fmu::model::{FmuModel, MOTORCYCLE, STEWART_PLATFORM, WASHOUT};

/// FMUs and how they are connected.
pub struct System {
    /// The package's name.
    pub name: &'static str,
    /// A sentence on what it is.
    pub text: &'static str,
    /// In the order in which data flows through them.
    pub components: &'static [Component],
    /// Which output each input gets.
    pub connections: fn() -> Vec<Connection>,
    /// Inputs of the system itself.
    pub inputs: &'static [Port],
    /// Outputs of the system itself.
    pub outputs: &'static [Port],
    /// Parameters that the components start with: a table in TOML for each component.
    pub parameters: &'static str,
    /// Place of these parameters in the package.
    pub place: Place,
    /// Where the default experiment ends \[s\].
    pub stop_time: f64,
    /// Communication step, for tools that read one \[s\].
    pub step_size: f64,
}

/// Place of a system's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Parameter sets, which a tool applies to FMUs with their models' own start values.
    Sets,
    /// The FMUs' start values, for parameters that not every tool takes from a set: items of
    /// enumerations, say.
    StartValues,
}

/// Every system; the first is built by default.
pub const SYSTEMS: &[&System] = &[&MOTORCYCLE_SIMULATOR, &MOTORCYCLE_LAP];

/// An input or output of a system, and the component's variable that it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    /// Letters and digits only: OMSimulator takes dots for the names of elements.
    pub name: &'static str,
    pub component: &'static str,
    pub variable: &'static str,
}

/// An FMU in a system.
pub struct Component {
    pub name: &'static str,
    pub model: &'static FmuModel,
    /// Outputs with a connector although nothing is connected to them: these variables, and those
    /// whose names continue one of these with a dot or an index. `*` stands for an index.
    pub shown: &'static [&'static str],
}

/// From a component's output to a component's input: the component's name and the variable's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Connection {
    pub from: (&'static str, String),
    pub to: (&'static str, String),
}

/// The whole simulator of the paper's Fig. 1: the motorcycle, the washout filter, and the platform.
pub const MOTORCYCLE_SIMULATOR: System = System {
    name: "MotorcycleSimulator",
    text: "A motorcycle simulator: a motorcycle with its rider, the washout filter, and the Stewart platform that moves",
    components: &[
        motorcycle(&["vehicle.position", "vehicle.acceleration", "steer.angle"]),
        WASHOUT_PART,
        PLATFORM_PART,
    ],
    connections: || simulator_connections(Preview::No),
    inputs: &[
        port("throttle", "motorcycle", "command.throttle"),
        port("brake", "motorcycle", "command.brake"),
        port("lean", "motorcycle", "command.lean"),
    ],
    outputs: OUTPUTS,
    parameters: include_str!("../MotorcycleSimulator.toml"),
    place: Place::Sets,
    stop_time: 45.0,
    step_size: 0.001,
};

/// The simulator on a lap: the motorcycle follows the path by itself, and the
/// washout has a preview.
pub const MOTORCYCLE_LAP: System = System {
    name: "MotorcycleLap",
    text: "A motorcycle that rides a lap by itself, the washout filter with a preview of it, and the Stewart platform",
    components: &[
        motorcycle(&["vehicle.position", "vehicle.acceleration", "steer.angle", "path", "status"]),
        WASHOUT_PART,
        PLATFORM_PART,
    ],
    connections: || simulator_connections(Preview::Connected),
    inputs: &[],
    outputs: OUTPUTS,
    parameters: include_str!("../MotorcycleLap.toml"),
    place: Place::StartValues,
    stop_time: 100.0,
    step_size: 0.001,
};

const fn motorcycle(shown: &'static [&'static str]) -> Component {
    Component { name: "motorcycle", model: &MOTORCYCLE, shown }
}

const WASHOUT_PART: Component = Component {
    name: "washout",
    model: &WASHOUT,
    shown: &["rider.specificForce", "rider.angularVelocity", "tilt", "status"],
};

const PLATFORM_PART: Component = Component {
    name: "platform",
    model: &STEWART_PLATFORM,
    shown: &[
        "platform.position",
        "platform.orientation",
        "actuator[*].length",
        "actuator[*].force",
        "rider.specificForce",
        "rider.angularVelocity",
        "status",
    ],
};

const OUTPUTS: &[Port] = &[
    port("speed", "motorcycle", "vehicle.speed"),
    port("feltSpecificForceX", "platform", "rider.specificForce.x"),
    port("feltSpecificForceY", "platform", "rider.specificForce.y"),
    port("feltSpecificForceZ", "platform", "rider.specificForce.z"),
    port("feltAngularVelocityX", "platform", "rider.angularVelocity.x"),
    port("feltAngularVelocityY", "platform", "rider.angularVelocity.y"),
    port("feltAngularVelocityZ", "platform", "rider.angularVelocity.z"),
    port("actuatorLength1", "platform", "actuator[1].length"),
    port("actuatorLength2", "platform", "actuator[2].length"),
    port("actuatorLength3", "platform", "actuator[3].length"),
    port("actuatorLength4", "platform", "actuator[4].length"),
    port("actuatorLength5", "platform", "actuator[5].length"),
    port("actuatorLength6", "platform", "actuator[6].length"),
    port("strokeMargin", "washout", "status.strokeMargin"),
    port("tiltLimited", "washout", "status.tiltLimited"),
    port("safetyActive", "washout", "status.safetyActive"),
    port("actuatorLimited", "washout", "status.actuatorLimited"),
    port("commandRefused", "platform", "status.commandRefused"),
    port("driveLimited", "platform", "status.driveLimited"),
    port("forceLimited", "platform", "status.forceLimited"),
    port("atStop", "platform", "status.atStop"),
];

const fn port(name: &'static str, component: &'static str, variable: &'static str) -> Port {
    Port { name, component, variable }
}

/// Connections of the preview: none without a path, where there is no preview.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Preview {
    No,
    Connected,
}

/// The motorcycle to the washout, name by name; the washout's legs to the platform's; the rider's
/// lean to both.
fn simulator_connections(preview: Preview) -> Vec<Connection> {
    let connect = |(from, output): (&'static str, String), (to, input): (&'static str, String)| Connection {
        from: (from, output),
        to: (to, input),
    };
    let delivered = names(&MOTORCYCLE.functions.identity, Causality::Output);
    let is_connected = |name: &String| preview == Preview::Connected || !name.starts_with("vehicle.preview.");
    let taken = names(&WASHOUT.functions.identity, Causality::Input)
        .into_iter()
        .filter(|name| delivered.contains(name) && is_connected(name));
    let mut connections: Vec<Connection> =
        taken.map(|name| connect(("motorcycle", name.clone()), ("washout", name))).collect();
    for quantity in ["length", "velocity"] {
        for i in 1..=6 {
            let (output, input) = (format!("actuator[{i}].{quantity}"), format!("command[{i}].{quantity}"));
            connections.push(connect(("washout", output), ("platform", input)));
        }
    }
    let lean = || "rider.lean".to_owned();
    connections.push(connect(("motorcycle", lean()), ("platform", lean())));
    connections
}

/// The names of a model's variables of this causality.
pub fn names(identity: &Identity, causality: Causality) -> Vec<String> {
    let is_such = |&slot: &usize| identity.row(slot).causality == causality;
    (0..identity.slots.len()).filter(is_such).map(|slot| identity.variable_name(slot)).collect()
}

impl System {
    /// The components that the parameters name, each with its table.
    ///
    /// # Errors
    /// The text is no TOML, names a component that does not exist, or has no table for one.
    pub fn parameter_tables(&self) -> Result<Vec<(&'static Component, Table)>, Error> {
        let error = |reason: String| Error::Parameters { reason };
        let tables: Table = self.parameters.parse().map_err(|reason: toml::de::Error| error(reason.to_string()))?;
        let of_component = |(name, values): (String, Value)| {
            let component = self.components.iter().find(|component| component.name == name);
            let component = component.ok_or_else(|| error(format!("there is no component {name}")))?;
            match values {
                Value::Table(own) => Ok((component, own)),
                _ => Err(error(format!("{name} must be a table of parameters"))),
            }
        };
        tables.into_iter().map(of_component).collect()
    }
}

impl Component {
    /// True for an output that is to have a connector although nothing is connected to it.
    pub fn shows(&self, name: &str) -> bool {
        self.shown.iter().any(|shown| match shown.split_once('*') {
            Some((start, end)) => name.strip_prefix(start).is_some_and(|rest| rest.ends_with(end)),
            None => name.strip_prefix(shown).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '['])),
        })
    }
}
