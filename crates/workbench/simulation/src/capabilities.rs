//! Capabilities of a rig: each axis alone, singularities, and the clearance of its legs.

use std::fmt;

use moris_washout::platform::reach::{Axis, Range, displaced, single_axis_range, stroke_clearance};
use moris_washout::platform::{self, Geometry, Pose, jacobian, leg_lengths};
use moris_washout::{ParameterError, Parameters, Rig, check, warnings};

use crate::clearance::Clearance;
use crate::sentence;

/// Capabilities of a rig.
#[derive(Clone, Debug)]
pub struct Capabilities {
    /// The washout's parameters on it.
    pub parameters: Parameters,
    /// Capabilities along each axis alone.
    pub axes: [AxisAlone; 6],
    /// Result of the search for singularities.
    pub singularities: Singularities,
    /// Least distances between the legs.
    pub clearance: Clearance,
}

/// Capabilities of the platform along one axis alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisAlone {
    pub axis: Axis,
    /// Reach from neutral \[m or rad\].
    pub range: Range,
    /// Speed through neutral, by the legs' speed \[m/s or rad/s\]; none where the
    /// legs do not limit it.
    pub speed: Option<f64>,
    /// Acceleration at rest at neutral, by the legs' acceleration \[m/s2 or rad/s2\]; none as the
    /// speed.
    pub acceleration: Option<f64>,
}

/// Speed of a leg for a unit of speed along an axis, below which the legs do not set the platform's
/// speed: the platform is singular there.
const SINGULAR_LEG_SPEED: f64 = 1e-6;

/// Result of the survey over all leg lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Singularities {
    /// None, and this is how far from one it is.
    None(platform::Survey),
    /// One at or near these leg lengths \[m\].
    At([f64; 6]),
}

impl Capabilities {
    /// Of the rig of these parameters, with legs of this diameter \[m\].
    ///
    /// # Errors
    /// A value of the rig is out of its range, or the legs do not reach neutral. Singular
    /// rigs are surveyed, too.
    pub fn of(parameters: &Parameters, diameter: Option<f64>) -> Result<Self, ParameterError> {
        let rig = &parameters.rig;
        let singularities = match (check(parameters), platform::survey(rig)) {
            (Ok(()), Ok(survey)) => Singularities::None(survey),
            (Err(_), Err(failed)) if can_stand(rig) => Singularities::At(failed.lengths),
            (Err(error), _) => return Err(error),
            (Ok(()), Err(failed)) => Singularities::At(failed.lengths),
        };
        Ok(Capabilities {
            axes: Axis::ALL.map(|axis| AxisAlone::of(rig, axis)),
            singularities,
            clearance: Clearance::of(rig, diameter),
            parameters: *parameters,
        })
    }

    /// True for a rig that can be built and used.
    pub fn is_sound(&self) -> bool {
        matches!(self.singularities, Singularities::None(_)) && self.clearance.collisions().next().is_none()
    }

    /// The legs' lengths and limits as a line.
    pub fn legs(&self) -> String {
        let rig = &self.parameters.rig;
        let neutral = leg_lengths(&Geometry::from(rig), &Pose::neutral(rig)).map(|length| format!("{length:.3}"));
        let neutral = if neutral.iter().all(|length| *length == neutral[0]) { &neutral[..1] } else { &neutral };
        if rig.has_cranks() {
            return self.cranks();
        }
        let (shortest, longest, neutral) = (rig.min_length, rig.max_length, neutral.join(", "));
        let (speed, acceleration) = (rig.velocity_limit, rig.acceleration_limit);
        sentence!["legs", shortest, longest, neutral, speed, acceleration]
    }

    /// The cranks' sizes and limits as lines, with the smallest transmission where the platform
    /// can go along one axis.
    fn cranks(&self) -> String {
        let rig = &self.parameters.rig;
        let geometry = Geometry::from(rig);
        let degrees = |angle: f64| format!("{:.1}°", angle.to_degrees());
        let at_neutral = geometry.transmission(&Pose::neutral(rig));
        let ends = self.axes.iter().flat_map(|axis| [(axis.axis, axis.range.min), (axis.axis, axis.range.max)]);
        let smallest =
            ends.map(|(axis, end)| geometry.transmission(&displaced(rig, axis, end))).fold(at_neutral, f64::min);
        let rates = [rig.velocity_limit, rig.acceleration_limit].map(|limit| limit / rig.crank_arm);
        let (arm, rod, limit) = (rig.crank_arm, rig.crank_rod, rig.crank_least_transmission);
        let [low, high] = [rig.crank_min_angle, rig.crank_max_angle].map(degrees);
        let ([rate, acceleration], times) = (rates, 1.0 / smallest);
        sentence!["cranks", arm, rod, low, high, rate, acceleration, at_neutral, smallest, limit, times]
    }

    /// The safety units' limits, and warnings about them and the rig, as lines.
    pub fn safety(&self) -> Vec<String> {
        let limits = self.parameters.safety.position_limit;
        let texts: Vec<String> =
            ["x", "y", "z"].iter().enumerate().map(|(i, name)| format!("±{:.3} m in {name}", limits[i])).collect();
        let warnings = warnings(&self.parameters).into_iter().map(|warning| format!("  {warning}"));
        std::iter::once(format!("safety units: {}", texts.join(", "))).chain(warnings).collect()
    }
}

/// True if the legs reach neutral.
fn can_stand(rig: &Rig) -> bool {
    stroke_clearance(rig, &Pose::neutral(rig)) > 0.0
}

impl AxisAlone {
    /// Heads of the columns of [`AxisAlone::row`].
    pub const HEADS: [&str; 5] = ["alone, from neutral", "from", "to", "speed", "acceleration"];

    fn of(rig: &Rig, axis: Axis) -> Self {
        let jacobian = jacobian(&Geometry::from(rig), &Pose::neutral(rig));
        let fastest_leg = jacobian.column(axis as usize).amax();
        AxisAlone {
            axis,
            range: single_axis_range(rig, axis),
            speed: (fastest_leg > SINGULAR_LEG_SPEED).then(|| rig.velocity_limit / fastest_leg),
            acceleration: (fastest_leg > SINGULAR_LEG_SPEED).then(|| rig.acceleration_limit / fastest_leg),
        }
    }

    /// The cells of a table.
    pub fn row(&self) -> Vec<String> {
        let (factor, unit, decimals, rates) =
            if self.axis.is_rotation() { (1f64.to_degrees(), "°", 1, 0) } else { (1.0, " m", 3, 1) };
        let signed = |value: f64| format!("{:+.decimals$}{unit}", factor * value);
        let rate = |value: Option<f64>, per: &str| {
            value.map_or_else(|| "singular".to_owned(), |value| format!("{:.rates$}{unit}{per}", factor * value))
        };
        vec![
            self.axis.name().to_owned(),
            signed(self.range.min),
            signed(self.range.max),
            rate(self.speed, "/s"),
            rate(self.acceleration, "/s²"),
        ]
    }
}

impl fmt::Display for Singularities {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&match self {
            Singularities::None(platform::Survey { smallest_singular_value: smallest, worst_condition: worst }) => {
                sentence!["regular", smallest, worst]
            }
            Singularities::At(lengths) => {
                sentence!["singular", lengths = lengths.map(|length| format!("{length:.3}")).join(", ")]
            }
        })
    }
}
