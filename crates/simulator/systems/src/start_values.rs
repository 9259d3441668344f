//! From a system's parameters in TOML to the start values of its FMUs.

use moris_setup::{NamedValues, parameter_file};

use crate::system::{Component, Place, System};
use moris_build_fmu::{Error, Start};

/// The start values of each component's FMU, in the components' order.
///
/// # Errors
/// The text is no TOML, or names a component, a parameter or a value that does not exist.
pub fn read(system: &System) -> Result<Vec<Start>, Error> {
    let tables = match system.place {
        Place::Sets => Vec::new(),
        Place::StartValues => system.parameter_tables()?,
    };
    let start = |component: &Component| {
        let rows = component.model.functions.identity.rows;
        let values = match tables.iter().find(|(of, _)| of.name == component.name) {
            Some((_, own)) => parameter_file::read(&own.to_string(), component.name, rows)?,
            None => NamedValues::new(),
        };
        Start::with(component.model, &values)
    };
    system.components.iter().map(start).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MOTORCYCLE_LAP, MOTORCYCLE_SIMULATOR};
    use moris_build_fmu::model::{MOTORCYCLE, WASHOUT};
    use moris_setup::load_set;

    #[test]
    fn a_system_with_parameter_sets_has_the_models_own_start_values() {
        assert!(read(&MOTORCYCLE_SIMULATOR).unwrap().iter().all(Start::is_own));
    }

    #[test]
    fn the_motorcycle_has_the_lap_and_the_washout_the_preview() {
        let [motorcycle, washout, platform] = read(&MOTORCYCLE_LAP).unwrap().try_into().unwrap();
        assert!(platform.is_own() && motorcycle.count() == 1);
        let course = MOTORCYCLE.functions.identity.slot("path.course").unwrap();
        assert_eq!(motorcycle.slots()[course], 6.0, "the last item of the courses");
        let preset = load_set("preview", WASHOUT.functions.identity.rows).unwrap();
        let preset = Start::with(&WASHOUT, &preset).unwrap();
        let others: Vec<String> = (0..preset.slots().len())
            .filter(|&slot| washout.slots()[slot] != preset.slots()[slot])
            .map(|slot| WASHOUT.functions.identity.variable_name(slot))
            .collect();
        assert_eq!(others, ["scale.angularVelocity.x"]);
    }

    #[test]
    fn a_path_of_one_s_own_can_take_the_lap_s_place() {
        let parameters = r#"
            [motorcycle]
            "path.course" = "custom"
            "path.point.count" = 2
            "path.point.distance[2]" = 400.0
            "path.point.speed[1]" = 20.0
            "path.point.speed[2]" = 20.0
        "#;
        let starts = read(&System { parameters, ..MOTORCYCLE_LAP }).unwrap();
        assert_eq!(starts[0].count(), 5);
    }

    #[test]
    fn what_cannot_be_a_start_value_is_named() {
        for (parameters, named) in [
            ("[car]\na = 1.0", "there is no component car"),
            ("[washout]\n\"tilt.rate\" = 1.0", "tilt.rate"),
            ("[motorcycle]\n\"path.course\" = \"mountain\"", "hairpin"),
            ("[washout", "TOML"),
        ] {
            let reason = read(&System { parameters, ..MOTORCYCLE_LAP }).unwrap_err().to_string();
            assert!(reason.contains(named), "{reason}");
        }
    }
}
