//! Units, in SI, with their base units as FMI asks for them.

/// Exponents of the SI base units that a unit is made of (FMI 2.0, 2.2.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BaseUnit {
    pub kg: i8,
    pub m: i8,
    pub s: i8,
    pub rad: i8,
}

/// A unit by the name that the interface shows, and the quantity that is given in it.
///
/// Two units may have one name where the quantities differ: angular velocities and break
/// frequencies are both in rad/s, but only angular velocities are shown in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    pub name: &'static str,
    pub base: BaseUnit,
    /// The quantity's name; empty for a dimensionless real.
    pub quantity: &'static str,
    /// A typical magnitude of the quantity.
    pub nominal: f64,
    pub display: Option<DisplayUnit>,
}

/// The unit in which users like to see a quantity: a value in it is `factor` times
/// the value in the unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    pub name: &'static str,
    pub factor: f64,
}

/// The units that the interfaces use. A dimensionless real has none:
/// [`units::ONE`] stands for that.
pub mod units {
    use super::{BaseUnit, DisplayUnit, Unit};

    /// A unit of the powers of m, s and rad.
    const fn unit(name: &'static str, quantity: &'static str, m: i8, s: i8, rad: i8) -> Unit {
        unit_with_mass(name, quantity, 1.0, 0, m, s, rad)
    }

    /// A unit of the powers of kg, m, s and rad, with the nominal value of its quantity.
    const fn unit_with_mass(
        name: &'static str,
        quantity: &'static str,
        nominal: f64,
        kg: i8,
        m: i8,
        s: i8,
        rad: i8,
    ) -> Unit {
        Unit { name, base: BaseUnit { kg, m, s, rad }, quantity, nominal, display: None }
    }

    /// The unit of a quantity that is shown in degrees; a radian is much of it.
    const fn in_degrees(unit: Unit, display: &'static str) -> Unit {
        let display = DisplayUnit { name: display, factor: 180.0 / core::f64::consts::PI };
        Unit { nominal: 0.1, display: Some(display), ..unit }
    }

    pub static ONE: Unit = unit("", "", 0, 0, 0);
    pub static M: Unit = unit("m", "Length", 1, 0, 0);
    pub static M_PER_S: Unit = unit("m/s", "Velocity", 1, -1, 0);
    pub static M_PER_S2: Unit = unit("m/s2", "Acceleration", 1, -2, 0);
    pub static RAD: Unit = in_degrees(unit("rad", "Angle", 0, 0, 1), "deg");
    pub static RAD_PER_S: Unit = in_degrees(unit("rad/s", "AngularVelocity", 0, -1, 1), "deg/s");
    pub static RAD_PER_S2: Unit = in_degrees(unit("rad/s2", "AngularAcceleration", 0, -2, 1), "deg/s2");
    /// Of break frequencies, bandwidths and natural frequencies.
    pub static ANGULAR_FREQUENCY: Unit = unit("rad/s", "AngularFrequency", 0, -1, 1);
    pub static S: Unit = unit("s", "Time", 0, 1, 0);

    pub static M2: Unit = unit("m2", "Area", 2, 0, 0);
    /// Of tyres: force for a small angle, divided by the load.
    pub static PER_RAD: Unit = unit("1/rad", "StiffnessCoefficient", 0, 0, -1);
    pub static PER_M: Unit = unit("1/m", "Curvature", -1, 0, 0);

    pub static KG: Unit = unit_with_mass("kg", "Mass", 100.0, 1, 0, 0, 0);
    pub static KG_M2: Unit = unit_with_mass("kg.m2", "MomentOfInertia", 10.0, 1, 2, 0, 0);
    pub static KG_PER_M3: Unit = unit_with_mass("kg/m3", "Density", 1.0, 1, -3, 0, 0);
    pub static N: Unit = unit_with_mass("N", "Force", 1e3, 1, 1, -2, 0);
    pub static N_M: Unit = unit_with_mass("N.m", "Torque", 10.0, 1, 2, -2, 0);
    pub static N_PER_M: Unit = unit_with_mass("N/m", "TranslationalSpringConstant", 1e4, 1, 0, -2, 0);
    pub static N_S_PER_M: Unit = unit_with_mass("N.s/m", "TranslationalDampingConstant", 1e3, 1, 0, -1, 0);
    pub static N_M_S_PER_RAD: Unit = unit_with_mass("N.m.s/rad", "RotationalDampingConstant", 10.0, 1, 2, -1, -1);
    pub static W: Unit = unit_with_mass("W", "Power", 1e3, 1, 2, -3, 0);
}
