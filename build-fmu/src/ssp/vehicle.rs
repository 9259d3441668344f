//! A package with a vehicle's FMU of one's own in the place of the motorcycle.

use std::fmt::Write;
use std::path::Path;

use quick_xml::de::from_str;
use quick_xml::escape::escape;
use serde::Deserialize;

use super::MOTORCYCLE_SIMULATOR;
use crate::Error;
use crate::base::Unpacked;

/// Name of the component that is replaced, as it stands in the system's description.
const REPLACED_COMPONENT: &str = "motorcycle";
/// Path of the vehicle's FMU in the package.
pub const VEHICLE_FMU: &str = "resources/Vehicle.fmu";

/// A vehicle's FMU of FMI 2.0, and what it is connected to.
pub struct Vehicle {
    /// The FMU.
    pub bytes: Vec<u8>,
    /// The description of the system, with the vehicle in it.
    pub description: String,
    /// The connections, as `output -> input`.
    pub connections: Vec<String>,
}

#[derive(Deserialize)]
struct Model {
    #[serde(rename = "@fmiVersion")]
    fmi_version: String,
    #[serde(rename = "CoSimulation")]
    co_simulation: Option<serde::de::IgnoredAny>,
    #[serde(rename = "ModelVariables", default)]
    variables: Variables,
}

#[derive(Default, Deserialize)]
struct Variables {
    #[serde(rename = "ScalarVariable", default)]
    all: Vec<Variable>,
}

#[derive(Deserialize)]
struct Variable {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@causality")]
    causality: Option<String>,
    #[serde(rename = "Real")]
    real: Option<Real>,
}

#[derive(Deserialize)]
struct Real {
    #[serde(rename = "@unit")]
    unit: Option<String>,
}

impl Vehicle {
    /// The vehicle in this file. Outputs are connected to the washout's inputs of the same name,
    /// and as `connected` says by `OUTPUT=INPUT`.
    ///
    /// # Errors
    /// The file is no FMU of FMI 2.0 for co-simulation, lacks a variable, or leaves a specific
    /// force without an output.
    pub fn open(file: &Path, connected: &[String]) -> Result<Self, Error> {
        // Inputs of the washout without which nothing is felt.
        const REQUIRED_INPUTS: [&str; 3] =
            ["vehicle.specificForce.x", "vehicle.specificForce.y", "vehicle.specificForce.z"];
        let refused = |reason: String| Error::Base { file: file.to_owned(), reason };
        let unpacked = Unpacked::open(file)?;
        let text = unpacked.model_description().map_err(refused)?;
        let model: Model = from_str(&text).map_err(|error| refused(format!("is no FMU: {error}")))?;
        if !model.fmi_version.starts_with('2') || model.co_simulation.is_none() {
            return Err(refused("is not of FMI 2.0 for co-simulation, as SSP 1.0 needs; export it so".to_owned()));
        }
        let is_real_output =
            |variable: &&Variable| variable.causality.as_deref() == Some("output") && variable.real.is_some();
        let outputs: Vec<&Variable> = model.variables.all.iter().filter(is_real_output).collect();
        let is_output = |name: &str| outputs.iter().any(|output| output.name == name);
        let (_, base) = MOTORCYCLE_SIMULATOR.flat[0];
        let links = vehicle_links(base);
        let washout_inputs: Vec<&str> =
            links.iter().filter(|(element, _)| *element == "washout").map(|(_, input)| *input).collect();
        let mut connections: Vec<(&str, &str)> = Vec::new();
        for pair in connected {
            let Some((output, input)) = pair.split_once('=').filter(|(output, _)| is_output(output)) else {
                let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
                let reason = format!("has no output for {pair}; write OUTPUT=INPUT with one of {}", names.join(", "));
                return Err(refused(reason));
            };
            if !washout_inputs.contains(&input) {
                let reason = format!("cannot be connected to {input}; write one of {}", washout_inputs.join(", "));
                return Err(refused(reason));
            }
            connections.push((output, input));
        }
        for &input in &washout_inputs {
            if is_output(input) && connections.iter().all(|(_, connected)| *connected != input) {
                connections.push((input, input));
            }
        }
        let is_open = |input: &&&str| connections.iter().all(|(_, connected)| connected != *input);
        if let Some(open) = REQUIRED_INPUTS.iter().find(is_open) {
            return Err(refused(format!("has no output {open}; name its own with --connect OUTPUT={open}")));
        }
        let description = vehicle_description(base, &links, &outputs, &connections);
        let connections = connections.iter().map(|(output, input)| format!("{output} -> {input}")).collect();
        Ok(Vehicle { bytes: unpacked.bytes, description, connections })
    }
}

/// Components and their inputs that take the vehicle's motion.
fn vehicle_links(base: &str) -> Vec<(&str, &str)> {
    let of_vehicle = base.lines().filter(|line| line.contains(&format!("startElement=\"{REPLACED_COMPONENT}\"")));
    of_vehicle
        .filter_map(|line| Some((attribute_value(line, "endElement")?, attribute_value(line, "endConnector")?)))
        .collect()
}

/// The value of an attribute in a line of the system's description.
fn attribute_value<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    line.split_once(&format!(" {name}=\""))?.1.split('"').next()
}

/// The system's description with the vehicle in the place of the motorcycle, without the parameters
/// that are made for a motorcycle. Inputs that nothing is connected to lose their connectors: FMPy
/// takes none.
fn vehicle_description(
    base: &str,
    links: &[(&str, &str)],
    outputs: &[&Variable],
    connections: &[(&str, &str)],
) -> String {
    let (mut text, mut skipped) = (String::new(), None);
    let mut is_connected = false;
    let is_open = |line: &str| {
        attribute_value(line, "kind") == Some("input")
            && attribute_value(line, "name").is_some_and(|name| {
                links.iter().any(|(_, input)| *input == name) && connections.iter().all(|(_, input)| *input != name)
            })
    };
    for line in base.lines() {
        let trimmed = line.trim();
        if let Some(end) = skipped {
            skipped = (trimmed != end).then_some(end);
        } else if trimmed.starts_with(&format!("<ssd:Component name=\"{REPLACED_COMPONENT}\"")) {
            text += &vehicle_component(outputs);
            skipped = Some("</ssd:Component>");
        } else if is_open(trimmed) {
            skipped = Some("</ssd:Connector>");
        } else if trimmed == "<ssd:ParameterBindings>" {
            skipped = Some("</ssd:ParameterBindings>");
        } else if !trimmed.contains(&format!("Element=\"{REPLACED_COMPONENT}\"")) {
            text += &format!("{line}\n");
        } else if !std::mem::replace(&mut is_connected, true) {
            for (output, input) in connections {
                for (element, _) in links.iter().filter(|(_, other)| other == input) {
                    let _ = writeln!(
                        text,
                        "      <ssd:Connection startElement=\"vehicle\" startConnector=\"{}\" endElement=\"{element}\" \
                         endConnector=\"{input}\"/>",
                        escape(*output)
                    );
                }
            }
        }
    }
    text
}

fn vehicle_component(outputs: &[&Variable]) -> String {
    let connector = |variable: &&Variable| {
        let unit = variable.real.as_ref().and_then(|real| real.unit.as_deref());
        let unit = unit.map_or_else(String::new, |unit| format!(" unit=\"{}\"", escape(unit)));
        format!(
            "          <ssd:Connector name=\"{}\" kind=\"output\">\n            <ssc:Real{unit}/>\n          \
             </ssd:Connector>\n",
            escape(variable.name.as_str())
        )
    };
    let connectors: String = outputs.iter().map(connector).collect();
    format!(
        "      <ssd:Component name=\"vehicle\" type=\"application/x-fmu-sharedlibrary\" source=\"{VEHICLE_FMU}\" \
         implementation=\"CoSimulation\">\n        <ssd:Connectors>\n{connectors}        </ssd:Connectors>\n        \
         <ssd:ElementGeometry x1=\"0\" y1=\"0\" x2=\"60\" y2=\"60\"/>\n      </ssd:Component>\n"
    )
}
