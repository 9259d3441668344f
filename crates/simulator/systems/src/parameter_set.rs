//! From a system's parameters in TOML to a parameter set.

use moris_interface::{Causality, Identity, Kind};
use moris_model_description::Element;
use toml::{Table, Value};

use crate::system::{Component, System};
use moris_build_fmu::Error;

/// A parameter's name and the element of its value.
pub type Parameter = (String, Element);
/// Parameters by the name of their component.
pub type ByComponent = Vec<(String, Vec<Parameter>)>;

/// The parameters of a system's components.
///
/// # Errors
/// The text is no TOML, or names a component, a parameter or a value that does not exist.
pub fn read(system: &System) -> Result<ByComponent, Error> {
    let parameters = |(component, values): (&Component, Table)| {
        let (name, identity) = (component.name, &component.model.functions.identity);
        let parameter = |(variable, value): (String, Value)| {
            let value = typed(identity, &variable, &value)
                .map_err(|reason| Error::Parameters { reason: format!("{name}.{variable} {reason}") })?;
            Ok((variable, value))
        };
        Ok((name.to_owned(), values.into_iter().map(parameter).collect::<Result<_, Error>>()?))
    };
    system.parameter_tables()?.into_iter().map(parameters).collect()
}

/// All parameters, each with its component's name before its own.
pub fn of_all(parameters: &ByComponent) -> Vec<Parameter> {
    let named = |component: &str, (name, value): &Parameter| (format!("{component}.{name}"), value.clone());
    parameters.iter().flat_map(|(name, own)| own.iter().map(move |parameter| named(name, parameter))).collect()
}

/// A value as the model's variable has it, or why it cannot be one.
fn typed(identity: &Identity, variable: &str, value: &Value) -> Result<Element, String> {
    let slot = identity.slot(variable).ok_or_else(|| format!("is no variable of {}", identity.name))?;
    let row = identity.row(slot);
    if !matches!(row.causality, Causality::Parameter | Causality::Input) {
        return Err("cannot be set".to_owned());
    }
    match (row.kind, value) {
        (Kind::Real(unit), Value::Float(value)) => {
            Ok(Element::new("ssv:Real").with("value", value).with_text("unit", unit.name))
        }
        (Kind::Integer, Value::Integer(value)) => Ok(Element::new("ssv:Integer").with("value", value)),
        (Kind::Boolean, Value::Boolean(value)) => Ok(Element::new("ssv:Boolean").with("value", value)),
        (Kind::Enumeration(kind), Value::String(item)) if kind.items.iter().any(|known| known.name == item) => {
            Ok(Element::new("ssv:Enumeration").with("value", item))
        }
        (Kind::Enumeration(kind), _) => {
            let items: Vec<&str> = kind.items.iter().map(|item| item.name).collect();
            Err(format!("is {value}, but must be one of {}", items.join(", ")))
        }
        (Kind::Real(_), _) => Err(format!("is {value}, but must be a number with a decimal point")),
        (Kind::Integer, _) => Err(format!("is {value}, but must be a whole number")),
        (Kind::Boolean, _) => Err(format!("is {value}, but must be true or false")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MOTORCYCLE_SIMULATOR;

    fn reason(parameters: &'static str) -> String {
        read(&System { parameters, ..MOTORCYCLE_SIMULATOR }).unwrap_err().to_string()
    }

    #[test]
    fn what_cannot_be_a_parameter_is_named() {
        for (parameters, named) in [
            ("[car]\na = 1.0", "there is no component car"),
            ("[washout]\n\"tilt.rate\" = 1.0", "washout.tilt.rate is no variable of MorisWashout"),
            ("[washout]\n\"tilt.roll\" = 1.0", "washout.tilt.roll cannot be set"),
            ("[washout]\n\"tilt.rateLimit\" = 1", "is 1, but must be a number with a decimal point"),
            ("[washout]\ngravityRemoval = \"some\"", "must be one of head_vertical, full, none"),
            ("[washout]\n\"splitter.order\" = 2.5", "is 2.5, but must be a whole number"),
            ("washout = 3", "washout must be a table"),
            ("[washout", "TOML"),
        ] {
            assert!(reason(parameters).contains(named), "{}", reason(parameters));
        }
    }
}
