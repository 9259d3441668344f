//! All there is to know of a rig.

use std::fmt;

use moris_interface::Group;
use moris_setup::rig_file::RigFile;
pub use moris_simulation::capabilities::{AxisAlone, Capabilities, Singularities};
use moris_washout::platform::mean_radius;
use moris_washout::{ParameterError, Rig};

use super::workspace::{Volume, WORKSPACE_TILT, Workspace};
use crate::text_table::TextTable;
use crate::texts::text;

/// Properties of a rig.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Name of the rig.
    pub name: String,
    /// Capabilities of the rig from neutral.
    pub capabilities: Capabilities,
    /// Where it can go.
    pub workspace: Workspace,
    /// What else is to be said of it, as lines.
    pub notes: Vec<String>,
}

impl Survey {
    /// Surveys a rig, with `samples` points for the volume of its workspace.
    ///
    /// # Errors
    /// A value of the rig is out of its range, or the legs do not reach neutral. Singular
    /// rigs are surveyed, too.
    pub fn of(file: &RigFile, samples: u32) -> Result<Self, ParameterError> {
        let parameters = file.parameters();
        parameters.check_ranges()?;
        let capabilities = Capabilities::of(&parameters, file.diameter()).map_err(|error| file.with_remedy(error))?;
        let accepted = match capabilities.singularities {
            Singularities::At(_) => file.accepted_cranks().map(|values| format!("Accepted is {values}.")),
            Singularities::None(_) => None,
        };
        Ok(Survey {
            name: file.name.clone(),
            capabilities,
            workspace: Workspace::of(&parameters.rig, samples),
            notes: larger_platform(&parameters.rig).into_iter().chain(accepted).collect(),
        })
    }
}

/// A sentence on a platform whose joints are farther apart than the base's: few are so built.
fn larger_platform(rig: &Rig) -> Option<String> {
    let [base, platform] = [&rig.base, &rig.platform].map(mean_radius);
    (platform > base).then(|| text!["larger-platform", platform, base].to_string())
}

impl fmt::Display for Survey {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Survey { name, capabilities, workspace: Workspace { level, tilted, samples, .. }, .. } = self;
        writeln!(f, "{name}\n\n{}\n", capabilities.legs())?;
        let mut table = TextTable::new(AxisAlone::HEADS);
        capabilities.axes.iter().for_each(|axis| table.push(axis.row()));
        writeln!(f, "{table}")?;
        let volume = |volume: &Volume| format!("{:.4} m³ ± {:.4}", volume.size, volume.standard_error);
        writeln!(f, "workspace of the platform's origin ({samples} points tried; ± is the standard error):")?;
        writeln!(f, "  level                           {}", volume(level))?;
        writeln!(f, "  tilted by {:.0}° in any direction  {}\n", WORKSPACE_TILT.to_degrees(), volume(tilted))?;
        writeln!(f, "{}\n", capabilities.safety().join("\n"))?;
        writeln!(f, "{}", capabilities.clearance)?;
        write!(f, "{}", capabilities.singularities)?;
        self.notes.iter().try_for_each(|note| writeln!(f, "  {note}"))
    }
}
