//! The survey of a rig.

use moris_analysis::rig::picture;
use moris_analysis::rig::survey::{Singularities, Survey};
use moris_setup::rig_file;
use pyo3::prelude::*;

use crate::error;
use crate::parallel::on_all_cores;
use crate::setup::{Given, rig_of};

/// The washout's default rig.
const DEFAULT_RIG: &str = include_str!("../../../../examples/rigs/default.toml");

/// An axis: name, reach [m or rad], speed [m/s or rad/s], acceleration [m/s2 or rad/s2].
type AxisAlone = (&'static str, f64, f64, Option<f64>, Option<f64>);

/// Properties of a rig, in this order:
///
/// - name, and properties of each axis alone;
/// - volumes of the workspace, level and tilted, with standard errors;
/// - smallest singular value and worst condition number, or else leg lengths at a singularity;
/// - the two legs that come closest to each other, counted from 1, and their distance [m];
/// - the survey as text and as picture.
type Properties =
    (String, Vec<AxisAlone>, [(f64, f64); 2], Option<(f64, f64)>, Option<[f64; 6]>, ([usize; 2], f64), String, String);

/// Surveys a rig.
///
/// # Errors
/// `ParameterError`: the rig cannot be used.
#[pyfunction]
pub fn survey(py: Python, rig: Given, samples: u32) -> PyResult<Properties> {
    let file = match rig {
        Some(rig) => rig_of(rig)?,
        None => rig_file::read(DEFAULT_RIG, "default rig").map_err(|error| error::setup(py, &error))?,
    };
    let survey = on_all_cores(py, || Survey::of(&file, samples))?;
    let survey = survey.map_err(|error| error::refused(py, &error, &file.values()))?;
    let axes = survey.capabilities.axes.iter();
    let axes = axes.map(|axis| (axis.axis.name(), axis.range.min, axis.range.max, axis.speed, axis.acceleration));
    let (condition, singular_at) = match survey.capabilities.singularities {
        Singularities::None(found) => (Some((found.smallest_singular_value, found.worst_condition)), None),
        Singularities::At(lengths) => (None, Some(lengths)),
    };
    let volumes = [survey.workspace.level, survey.workspace.tilted].map(|volume| (volume.size, volume.standard_error));
    let axes = axes.collect();
    let closest = survey.capabilities.clearance.approaches[0];
    let closest = (closest.legs.map(|leg| leg + 1), closest.distance);
    Ok((survey.name.clone(), axes, volumes, condition, singular_at, closest, survey.to_string(), picture::svg(&survey)))
}
