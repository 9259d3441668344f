//! Options with start values, which several commands have.

use std::path::PathBuf;

use moris_setup::{NamedValues, load_rig, load_set};

use crate::model::{MOTORCYCLE, WASHOUT, path_values};
use crate::{Error, FmuModel, Start};

/// A rig, parameters and a path that replace the models' own start values.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct StartOptions {
    /// Rig file, or shipped rig (hobby150, ...), to embed in the FMUs of models with a rig
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE|NAME"))]
    pub rig: Option<PathBuf>,

    /// Parameter file, or preset (classical, paper, ...), to embed in the washout's FMU; in another
    /// model's if that one alone is chosen. May be given several times: later ones override
    /// earlier ones, and all of them the rig
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE|NAME"))]
    pub parameters: Vec<String>,

    /// CSV file of a path (distance, curvature, speed) that the motorcycle's FMU rides
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    pub path: Option<PathBuf>,
}

impl StartOptions {
    /// The start values of each of the chosen models.
    ///
    /// # Errors
    /// An option applies to none of the models, a file cannot be used, or a model cannot
    /// start with its values.
    pub fn of_models(&self, models: &[&FmuModel]) -> Result<Vec<Start>, Error> {
        self.check_used(models)?;
        models.iter().map(|model| Start::with(model, &self.values(model, models.len() == 1)?)).collect()
    }

    /// Checks that each option applies to one of the models.
    fn check_used(&self, models: &[&FmuModel]) -> Result<(), Error> {
        if self.rig.is_some() && !models.iter().any(|model| model.has_rig()) {
            return Err(Error::NotApplicable { option: "rig", who: "only models with a platform have a rig" });
        }
        if self.path.is_some() && !models.iter().any(|model| model.name == MOTORCYCLE.name) {
            return Err(Error::NotApplicable { option: "path", who: "only the motorcycle follows one" });
        }
        if !self.parameters.is_empty() && !models.iter().any(|model| accepts_parameters(model, models.len() == 1)) {
            let who = "with several models they are the washout's; choose another model alone";
            return Err(Error::NotApplicable { option: "parameters", who });
        }
        Ok(())
    }

    /// Start values that replace a model's own: the rig where it has one, and over it the
    /// parameters where they are its own.
    fn values(&self, model: &FmuModel, alone: bool) -> Result<NamedValues, Error> {
        let mut values = NamedValues::new();
        if let Some(file) = self.rig.as_ref().filter(|_| model.has_rig()) {
            values.extend(load_rig(file)?.values());
        }
        if let Some(file) = self.path.as_ref().filter(|_| model.name == MOTORCYCLE.name) {
            values.extend(path_values(file)?);
        }
        if accepts_parameters(model, alone) {
            for set in &self.parameters {
                values.extend(load_set(set, model.functions.identity.rows)?);
            }
        }
        Ok(values)
    }
}

/// Parameters are the washout's, or those of a model that is chosen alone.
fn accepts_parameters(model: &FmuModel, alone: bool) -> bool {
    alone || model.name == WASHOUT.name
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FMU_MODELS;
    use crate::model::STEWART_PLATFORM;

    fn rig() -> StartOptions {
        StartOptions { rig: Some("rig.toml".into()), ..Default::default() }
    }

    fn parameters(set: &str) -> StartOptions {
        StartOptions { parameters: vec![set.to_owned()], ..Default::default() }
    }

    fn path(file: &str) -> StartOptions {
        StartOptions { path: Some(file.into()), ..Default::default() }
    }

    #[test]
    fn values_that_no_chosen_model_takes_are_refused() {
        let refused = rig().check_used(&[&MOTORCYCLE]).unwrap_err().to_string();
        assert!(refused.contains("--rig applies to none"), "{refused}");
        let refused = path("bend.csv").check_used(&[&STEWART_PLATFORM]).unwrap_err().to_string();
        assert!(refused.contains("--path applies to none"), "{refused}");
        let refused = parameters("mine.toml").check_used(&[&MOTORCYCLE, &STEWART_PLATFORM]).unwrap_err().to_string();
        assert!(refused.contains("--parameters applies to none"), "{refused}");
    }

    #[test]
    fn values_that_one_of_the_models_takes_are_not() {
        let all: Vec<&FmuModel> = FMU_MODELS.iter().collect();
        let both = StartOptions { parameters: vec!["paper".to_owned()], ..rig() };
        assert!(both.check_used(&all).is_ok());
        assert!(parameters("mine.toml").check_used(&[&MOTORCYCLE]).is_ok());
        assert!(rig().check_used(&[&MOTORCYCLE, &STEWART_PLATFORM]).is_ok());
    }

    #[test]
    fn a_path_becomes_start_values_of_the_motorcycle_alone() {
        let options = path(concat!(env!("CARGO_MANIFEST_DIR"), "/../crates/simulator/motorcycle/paths/hairpin.csv"));
        let values = options.values(&MOTORCYCLE, false).unwrap();
        let value = |name: &str| values.iter().find(|(known, _)| known == name).unwrap().1;
        assert_eq!((value("path.course"), value("path.point.count")), (2.0, 6.0));
        assert_eq!(value("path.point.distance[2]"), 150.0);
        assert!(Start::with(&MOTORCYCLE, &values).is_ok());
        assert_eq!(options.values(&WASHOUT, false).unwrap(), []);
        assert!(path("no-such.csv").values(&MOTORCYCLE, true).unwrap_err().to_string().contains("no-such.csv"));
    }
}
