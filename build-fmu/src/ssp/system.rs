//! The systems of which there are packages.

use moris_interface::{Causality, Identity};

use crate::model::{MOTORCYCLE, Model, STEWART_PLATFORM, WASHOUT};

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
    /// Inputs that the system has itself: the component and its variable, by whose name they go.
    pub inputs: &'static [(&'static str, &'static str)],
    /// Parameters that the components start with: a table in TOML for each component.
    pub parameters: &'static str,
    /// Where the default experiment ends \[s\].
    pub stop_time: f64,
}

/// An FMU in a system.
pub struct Component {
    pub name: &'static str,
    pub model: &'static Model,
    /// Outputs to be seen from outside besides the connected ones: these variables, and those whose names begin so and go
    /// on with a dot or an index.
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
        Component {
            name: "motorcycle",
            model: &MOTORCYCLE,
            shown: &["vehicle.position", "vehicle.acceleration", "steer.angle"],
        },
        Component {
            name: "washout",
            model: &WASHOUT,
            shown: &["rider.specificForce", "rider.angularVelocity", "tilt", "status"],
        },
        Component {
            name: "platform",
            model: &STEWART_PLATFORM,
            shown: &[
                "platform.position",
                "platform.orientation",
                "actuator[1].length",
                "actuator[2].length",
                "actuator[3].length",
                "actuator[4].length",
                "actuator[5].length",
                "actuator[6].length",
                "actuator[1].force",
                "actuator[2].force",
                "actuator[3].force",
                "actuator[4].force",
                "actuator[5].force",
                "actuator[6].force",
                "rider.specificForce",
                "rider.angularVelocity",
                "status",
            ],
        },
    ],
    connections: simulator_connections,
    inputs: &[("motorcycle", "command.throttle"), ("motorcycle", "command.brake"), ("motorcycle", "command.lean")],
    parameters: include_str!("../../ssp/MotorcycleSimulator.toml"),
    stop_time: 45.0,
};

/// The motorcycle to the washout, name by name; the washout's legs to the platform's; the rider's lean to both.
fn simulator_connections() -> Vec<Connection> {
    let connect = |(from, output): (&'static str, String), (to, input): (&'static str, String)| Connection {
        from: (from, output),
        to: (to, input),
    };
    let delivered = names(&MOTORCYCLE.made.identity, Causality::Output);
    let taken = names(&WASHOUT.made.identity, Causality::Input).into_iter().filter(|name| delivered.contains(name));
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

impl Component {
    /// True for an output that is a connector of the system.
    pub fn shows(&self, name: &str) -> bool {
        self.shown
            .iter()
            .any(|shown| name.strip_prefix(shown).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '['])))
    }
}
