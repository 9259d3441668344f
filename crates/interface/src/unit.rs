//! Units, in SI, with their base units as FMI asks for them.

/// Exponents of the SI base units that a unit is made of (FMI 2.0, 2.2.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BaseUnit {
    pub kg: i8,
    pub m: i8,
    pub s: i8,
    pub rad: i8,
}

/// A unit by the name that the interface shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Unit {
    pub name: &'static str,
    pub base: BaseUnit,
}

/// The units that the interfaces use. A dimensionless real has none: [`units::ONE`] stands for that.
pub mod units {
    use super::{BaseUnit, Unit};

    const fn unit(name: &'static str, m: i8, s: i8, rad: i8) -> Unit {
        Unit { name, base: BaseUnit { kg: 0, m, s, rad } }
    }

    const fn unit_with_mass(name: &'static str, kg: i8, m: i8, s: i8, rad: i8) -> Unit {
        Unit { name, base: BaseUnit { kg, m, s, rad } }
    }

    pub static ONE: Unit = unit("", 0, 0, 0);
    pub static M: Unit = unit("m", 1, 0, 0);
    pub static M_PER_S: Unit = unit("m/s", 1, -1, 0);
    pub static M_PER_S2: Unit = unit("m/s2", 1, -2, 0);
    pub static RAD: Unit = unit("rad", 0, 0, 1);
    pub static RAD_PER_S: Unit = unit("rad/s", 0, -1, 1);
    pub static RAD_PER_S2: Unit = unit("rad/s2", 0, -2, 1);
    pub static S: Unit = unit("s", 0, 1, 0);

    pub static M2: Unit = unit("m2", 2, 0, 0);
    pub static PER_RAD: Unit = unit("1/rad", 0, 0, -1);

    pub static KG: Unit = unit_with_mass("kg", 1, 0, 0, 0);
    pub static KG_M2: Unit = unit_with_mass("kg.m2", 1, 2, 0, 0);
    pub static KG_PER_M3: Unit = unit_with_mass("kg/m3", 1, -3, 0, 0);
    pub static N: Unit = unit_with_mass("N", 1, 1, -2, 0);
    pub static N_M: Unit = unit_with_mass("N.m", 1, 2, -2, 0);
    pub static N_PER_M: Unit = unit_with_mass("N/m", 1, 0, -2, 0);
    pub static N_S_PER_M: Unit = unit_with_mass("N.s/m", 1, 0, -1, 0);
    pub static N_M_S_PER_RAD: Unit = unit_with_mass("N.m.s/rad", 1, 2, -1, -1);
    pub static W: Unit = unit_with_mass("W", 1, 2, -3, 0);
}
