//! A rig and parameters put together.

use std::path::Path;

use moris_fmu_host::files::MAX_TEXT_SIZE;
use moris_interface::{Group, Row};
use moris_washout::{Parameters, check, presets};

use crate::named_values::{all, differing, overlaid};
use crate::names::nearest;
use crate::rig_file::RigFile;
use crate::{Error, NamedValues, PARAMETER_SETS, SHIPPED_RIGS, parameter_file, rig_file};

/// A washout's parameters from files and sets, checked, and their names.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The rig's name.
    pub rig_name: String,
    /// The parameters' name: those of the files and sets, in order.
    pub parameters_name: String,
    /// All parameters, the rig's among them.
    pub parameters: Parameters,
    /// Parameters of the rig with all others at their default.
    pub rig_alone: Parameters,
    /// Diameter of the rig's legs, where its file gives it \[m\].
    pub actuator_diameter: Option<f64>,
}

impl Setup {
    /// Combines the default parameters, a rig file and parameter sets. Each overrides the values
    /// before it. A set is the name of a shipped set or a parameter file.
    ///
    /// # Errors
    /// A file cannot be read, a name or value in it is invalid, or the parameters make no washout.
    pub fn load(rig: Option<&Path>, sets: &[String]) -> Result<Self, Error> {
        let rig = rig.map(load_rig).transpose()?;
        let load = |set: &String| Ok((set_name(set), load_set(set, Parameters::ROWS)?));
        let setup = Self::unchecked(rig.clone(), &sets.iter().map(load).collect::<Result<Vec<_>, Error>>()?);
        check(&setup.parameters).map_err(|error| match rig {
            Some(rig) => rig.with_remedy(error),
            None => error,
        })?;
        Ok(setup)
    }

    /// Combines the default parameters, a rig, and sets of values by name, without a check that
    /// they make a washout.
    pub fn unchecked(rig: Option<RigFile>, sets: &[(String, NamedValues)]) -> Self {
        let rig_alone = rig.as_ref().map_or_else(Parameters::default, RigFile::parameters);
        let names: Vec<&str> = sets.iter().map(|(name, _)| name.as_str()).collect();
        Setup {
            actuator_diameter: rig.as_ref().and_then(RigFile::diameter),
            rig_name: rig.map_or_else(|| "default rig".to_owned(), |rig| rig.name),
            parameters_name: if sets.is_empty() { "default".to_owned() } else { names.join(" + ") },
            parameters: sets.iter().fold(rig_alone, |parameters, (_, values)| overlaid(&parameters, values)),
            rig_alone,
        }
    }

    /// The text of a parameter file with these parameters. The text has what differs from the rig
    /// with default parameters, and always the strategy and the scales: over another set it runs as
    /// here. Nothing of the rig is in it.
    pub fn parameter_file(&self, heading: &str) -> String {
        let is_kept = |name: &str| name == "strategy" || name.starts_with("scale.");
        let written = all(&self.parameters).into_iter().filter(|(name, _)| is_kept(name));
        let values: NamedValues = differing(&self.parameters, &self.rig_alone).into_iter().chain(written).collect();
        parameter_file::write(heading, &values, Parameters::ROWS)
    }
}

/// The shipped rig of this name, or that of the rig file of this name.
///
/// # Errors
/// There is no such rig or file, or [`rig_file::read`] rejects the file.
pub fn load_rig(file: &Path) -> Result<RigFile, Error> {
    let name = file.display().to_string();
    if let Some((_, rig)) = SHIPPED_RIGS.iter().find(|(known, _)| *known == name) {
        return rig_file::read(rig, &name);
    }
    if is_no_file(file) {
        let nearest = nearest(&name, SHIPPED_RIGS.iter().map(|(known, _)| *known));
        return Err(Error::NoSuchRig { name, nearest });
    }
    rig_file::read(&file_text(file)?, &name)
}

/// True for a name that can only be meant as that of something shipped.
fn is_no_file(name: &Path) -> bool {
    !name.exists() && name.extension().is_none()
}

/// The values of a shipped set of this name, or of the parameter file of this name, for a model
/// with these rows.
///
/// # Errors
/// There is no such set or file, or [`parameter_file::read`] rejects the file.
pub fn load_set(name: &str, rows: &[Row]) -> Result<NamedValues, Error> {
    if let Some((_, set)) = PARAMETER_SETS.iter().find(|(known, _)| *known == name) {
        return Ok(presets::values(set).into_iter().map(|(variable, value)| (variable.to_owned(), value)).collect());
    }
    let file = Path::new(name);
    if is_no_file(file) {
        let nearest = nearest(name, PARAMETER_SETS.iter().map(|(known, _)| *known));
        return Err(Error::NoSuchSet { name: name.to_owned(), nearest });
    }
    parameter_file::read(&file_text(file)?, name, rows)
}

fn file_text(file: &Path) -> Result<String, Error> {
    moris_fmu_host::files::text(file, MAX_TEXT_SIZE).map_err(|reason| Error::Read { file: file.to_owned(), reason })
}

/// The name of a set; of a file that without directory and extension.
pub fn set_name(set: &str) -> String {
    Path::new(set).file_stem().map_or_else(|| set.to_owned(), |stem| stem.to_string_lossy().into())
}
