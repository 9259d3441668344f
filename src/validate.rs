//! Validation of parameters: each alone, and in combination.

use alloc::{borrow::ToOwned, format, string::String, vec, vec::Vec};
use core::ops::RangeInclusive;

use moris_interface::{
    Condition, Group, Kind, ParameterError, Row, Shown, check_fixed, four_decimals, refuse, shown, slot_count, slots_of,
};
use nalgebra::Vector2;

use crate::interface::{GravityRemoval, Input, Parameters, Rig, RollPitchYaw, STANDARD_GRAVITY};
use crate::platform::reach::{Axis, pace_within_stroke, single_axis_range, stroke_clearance};
use crate::platform::{Cranks, Geometry, Pose, check_torso, known_survey, leg_lengths, numbering, step_margin};

/// Checks parameters; the rig with a survey of all its legs' lengths, unless it is the default rig.
///
/// ```
/// use moris_washout::{Parameters, check};
///
/// let mut parameters = Parameters::default();
/// assert!(check(&parameters).is_ok());
/// parameters.tilt.rate_limit = -1.0;
/// assert!(check(&parameters).unwrap_err().to_string().contains("tilt.rateLimit"));
/// ```
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check(parameters: &Parameters) -> Result<(), ParameterError> {
    parameters.check_ranges()?;
    let Parameters { structure, rig, .. } = parameters;
    check_torso(structure.torso_length, structure.head_height, "platform")?;
    check_rig(rig, structure.max_step)
}

/// Doubts about parameters that can be used, in sentences; [`check`] accepts them.
///
/// - Limits of the safety units farther from neutral than the rig reaches along their axis alone.
///   The legs come to the ends of their stroke before.
/// - A leg that is near an end of its stroke at neutral.
/// - Actuators too weak to brake from their speed at the pace of the soft limits.
/// - Parameters that are not at their start and have no effect, because of another one.
/// - Values beyond the range that is usual in practice. 0 switches off, and is usual.
///
/// ```
/// use moris_washout::{Parameters, warnings};
///
/// let mut parameters = Parameters::default();
/// assert!(warnings(&parameters).is_empty());
/// parameters.safety.position_limit.z = 0.4;
/// assert!(warnings(&parameters)[0].starts_with("safety.z.positionLimit is 0.4 m, but in heave the rig reaches only 0.344 m"));
/// parameters.splitter.omega1.x = 2.0;
/// assert!(warnings(&parameters)[1].starts_with("splitter.x.omega1 has no effect with strategy predictive"));
/// ```
pub fn warnings(parameters: &Parameters) -> Vec<String> {
    let limits = parameters.safety.position_limit;
    let beyond = |(place, axis): (usize, Axis)| {
        let reach = single_axis_range(&parameters.rig, axis).min_reach();
        (limits[place] > reach).then(|| {
            format!(
                "safety.{}.positionLimit is {} m, but in {} the rig reaches only {reach:.3} m from neutral: this limit never \
                 acts, the ends of the actuators' stroke come first; reduce it",
                ["x", "y", "z"][place],
                four_decimals(limits[place]),
                axis.name()
            )
        })
    };
    let beyond = [Axis::Surge, Axis::Sway, Axis::Heave].into_iter().enumerate().filter_map(beyond);
    let doubtful_rig = near_an_end(&parameters.rig).into_iter().chain(soft_limit_warning(parameters));
    beyond.chain(doubtful_rig).chain(Changed::of(parameters).warnings()).collect()
}

/// Clearance of a leg at neutral, relative to the stroke, below which a rig is warned of. In the
/// middle of the stroke it is a half.
const MIN_CLEARANCE_FRACTION: f64 = 0.1;

fn near_an_end(rig: &Rig) -> Option<String> {
    let (clearance, stroke) = (stroke_clearance(rig, &Pose::neutral(rig)), rig.stroke_length());
    (clearance < MIN_CLEARANCE_FRACTION * stroke).then(|| {
        format!(
            "rig.neutralHeight is {} m, where a leg is only {clearance:.4} m from an end of its stroke of {stroke:.3} m: the \
             platform can move by little more than that; choose a height at which the legs are near the middle of their stroke",
            rig.neutral_height
        )
    })
}

fn soft_limit_warning(Parameters { rig, soft_limit, .. }: &Parameters) -> Option<String> {
    let Rig { velocity_limit, acceleration_limit, .. } = *rig;
    let pace = pace_within_stroke(soft_limit.pace, rig);
    let (needed, fastest) = (pace * velocity_limit, acceleration_limit / pace);
    (acceleration_limit < needed * (1.0 - 1e-9)).then(|| {
        format!(
            "actuator.accelerationLimit is {acceleration_limit} m/s2, but braking from {velocity_limit} m/s at the \
             pace of {pace:.2} rad/s takes {needed:.1} m/s2: only {fastest:.2} m/s are used; if the limit is in g, \
             give {:.1} m/s2, else reduce softLimit.pace for more",
            STANDARD_GRAVITY * acceleration_limit
        )
    })
}

/// Parameters that are not at their start.
struct Changed {
    slots: Vec<f64>,
    /// Row, element and slot of each.
    places: Vec<(&'static Row, usize, usize)>,
}

/// A parameter and the value at which it changes nothing by itself: files of a fit have it for
/// those who switch the automatic scale on.
const NEUTRAL_VALUE: (&str, f64) = ("automaticScale.start", 1.0);

/// Names of a list that are written out.
const MAX_NAMES: usize = 3;

impl Changed {
    fn of(parameters: &Parameters) -> Self {
        let (slots, start) = (slots_of(parameters), slots_of(&Parameters::default()));
        let places = Self::places().filter(|&(.., slot)| slots[slot] != start[slot]).collect();
        Changed { slots, places }
    }

    fn places() -> impl Iterator<Item = (&'static Row, usize, usize)> {
        let elements = |row: &'static Row| (0..row.slots()).map(move |element| (row, element));
        Parameters::ROWS.iter().flat_map(elements).enumerate().map(|(slot, (row, element))| (row, element, slot))
    }

    fn warnings(&self) -> Vec<String> {
        let mut idle: Vec<(&Condition, Vec<String>)> = Vec::new();
        let mut unusual = Vec::new();
        for &(row, element, slot) in &self.places {
            let name = row.variable_name(element);
            if (name.as_str(), self.slots[slot]) == NEUTRAL_VALUE {
                continue;
            }
            match row.conditions(element).find(|condition| !condition.values.contains(&&*self.text(condition.variable)))
            {
                Some(unmet) => match idle.iter_mut().find(|(condition, _)| condition.is_same(unmet)) {
                    Some((_, names)) => names.push(name),
                    None => idle.push((unmet, vec![name])),
                },
                None => unusual.extend(row.unusual_value(&name, self.slots[slot])),
            }
        }
        let without_effect = |(condition, names): (&Condition, Vec<String>)| {
            let Condition { variable, values, .. } = condition;
            let more = names.len().saturating_sub(MAX_NAMES);
            let verb = if names.len() == 1 { "has" } else { "have" };
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let (names, value) = (names[..names.len().min(MAX_NAMES)].join(", "), self.text(variable));
            format!("{names}{more} {verb} no effect with {variable} {value}, only with {}", values.join(" or "))
        };
        idle.into_iter().map(without_effect).chain(unusual).collect()
    }

    /// The value of a variable as conditions have it: an item's name, or a whole number.
    fn text(&self, variable: &str) -> String {
        let place = Self::places().find(|(row, element, _)| row.variable_name(*element) == variable);
        let Some((row, _, slot)) = place else { return String::new() };
        match row.kind {
            Kind::Enumeration(enumeration) => {
                let item = (self.slots[slot] as usize).saturating_sub(1);
                enumeration.items.get(item).map_or_else(String::new, |item| item.name.to_owned())
            }
            _ => shown(self.slots[slot]),
        }
    }
}

/// Vertical specific forces that a vehicle on its wheels may have as the first one \[g\].
const PLAUSIBLE_GRAVITY: RangeInclusive<f64> = 0.3..=1.8;
/// Forces in units of g, and those with gravity although none is to be removed.
const ABOUT_ONE: RangeInclusive<f64> = 0.9..=1.1;
/// Steepest attitude of a vehicle at the beginning: beyond it an angle may be in degrees \[rad\].
const MAX_FIRST_ANGLE: f64 = 1.6;
/// Fastest rotation of a vehicle at the beginning \[rad/s\].
const MAX_FIRST_RATE: f64 = 5.0;

/// Doubts about the first step's input, in sentences; the washout uses it unchanged.
///
/// - The washout is not engaged.
/// - Gravity is missing, has the wrong sign, is there twice or in units of g; or it is there
///   although [`GravityRemoval::None`] removes none.
/// - Angles or rates that may be in degrees: roll or pitch beyond 1.6 rad, rates beyond 5 rad/s.
///
/// ```
/// use moris_washout::{Input, Parameters, input_warnings};
///
/// let mut input = Input::default();
/// assert!(input_warnings(&Parameters::default(), &input).is_empty());
/// input.specific_force.z = 1.0;
/// let [doubt] = input_warnings(&Parameters::default(), &input).try_into().unwrap();
/// assert!(doubt.ends_with("give m/s2 instead of g"));
/// ```
pub fn input_warnings(parameters: &Parameters, input: &Input) -> Vec<String> {
    let disengaged = "engaged is false: the platform stays at rest; set it to true to cue the vehicle's motion";
    let mut found = Vec::new();
    if !input.engaged {
        found.push(disengaged.to_owned());
    }
    found.extend(gravity_warning(parameters, input.specific_force.z));
    let RollPitchYaw { roll, pitch, .. } = input.orientation;
    let rate = |axis: &'static str, value: f64| ("angularVelocity", axis, value, MAX_FIRST_RATE, "rad/s");
    let [x, y, z]: [f64; 3] = input.angular_velocity.into();
    let angle = |axis: &'static str, value: f64| ("orientation", axis, value, MAX_FIRST_ANGLE, "rad");
    let angles = [angle("roll", roll), angle("pitch", pitch), rate("x", x), rate("y", y), rate("z", z)];
    found.extend(angles.into_iter().filter(|(.., value, greatest, _)| value.abs() > *greatest).map(
        |(quantity, axis, value, _, unit)| {
            let radians = shown(four_decimals(value.to_radians()));
            format!(
                "vehicle.{quantity}.{axis} is {} {unit}, more than a vehicle has; if it is in degrees, give {radians} {unit}",
                shown(four_decimals(value))
            )
        },
    ));
    found
}

/// A sentence about a vertical specific force with which no ride begins.
fn gravity_warning(parameters: &Parameters, vertical: f64) -> Option<String> {
    let gravity = parameters.structure.gravity;
    let relative = vertical / gravity;
    let is_removed = parameters.conditioning.gravity_removal != GravityRemoval::None;
    let remedy = match relative {
        _ if !is_removed => {
            ABOUT_ONE.contains(&relative).then_some("take gravity out, or set gravityRemoval to head_vertical (1)")
        }
        _ if PLAUSIBLE_GRAVITY.contains(&relative) => None,
        _ if ABOUT_ONE.contains(&vertical) => Some("give m/s2 instead of g"),
        ..0.0 => Some("z points up, so correct its sign"),
        ..1.0 => Some("add gravity, or set gravityRemoval to none (3) for accelerations without it"),
        _ => Some("gravity may have been added twice"),
    }?;
    let vertical = shown(four_decimals(vertical));
    Some(if !is_removed {
        format!(
            "vehicle.specificForce.z is {vertical} m/s2, gravity, which gravityRemoval none (3) leaves in: {remedy}"
        )
    } else if vertical == "0" {
        format!("vehicle.specificForce.z is 0 m/s2, as in free fall: at rest on level ground it is {gravity}; {remedy}")
    } else {
        format!("vehicle.specificForce.z is {vertical} m/s2, but at rest on level ground it is {gravity}; {remedy}")
    })
}

/// Checks parameters that are to follow others, of which the tunable ones may change. No
/// survey: the rig is the same.
///
/// # Errors
/// The first parameter that cannot be used or must not change, and why.
pub fn check_change(from: &Parameters, to: &Parameters) -> Result<(), ParameterError> {
    to.check_ranges()?;
    check_fixed::<_, { slot_count(Parameters::ROWS) }>(Parameters::ROWS, from, to)
}

/// Checks a rig that is stepped in internal steps of `max_step` \[s\] at most: the order of the
/// stroke's ends, the pose at neutral, and that no pose is singular.
///
/// ```
/// use moris_washout::{Rig, check_rig};
///
/// let rig = Rig { neutral_height: 1.6, ..Rig::default() };
/// assert!(check_rig(&rig, 0.001).unwrap_err().to_string().contains("rig.neutralHeight"));
/// ```
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check_rig(rig: &Rig, max_step: f64) -> Result<(), ParameterError> {
    if let Some(cranks) = Cranks::of(rig) {
        check_cranks(rig, &cranks)?;
    }
    // A rig's file has a key for each, in `RigFile::rig` of the crate `setup`.
    #[rustfmt::skip]
    let Rig {
        neutral_height: _, min_length, max_length, base: _, platform: _, velocity_limit: _, acceleration_limit: _,
        crank_arm: _, crank_rod: _, crank_heading: _, crank_min_angle: _, crank_max_angle: _, crank_least_transmission: _,
    } = *rig;
    if min_length >= max_length {
        return refuse(
            "actuator.minLength",
            format!("is {} m; it must be below actuator.maxLength, {} m", Shown(min_length), Shown(max_length)),
        );
    }
    let neutral = leg_lengths(&Geometry::from(rig), &Pose::neutral(rig));
    for (i, length) in neutral.iter().enumerate() {
        if !(rig.has_cranks() || min_length < *length && *length < max_length) {
            return refuse(
                "rig.neutralHeight",
                format!(
                    "is {height}, and there actuator {leg} would be {length:.4} m long, outside its stroke from {min_length} to \
                     {max_length} m; correct it, or rig.base[{leg}], rig.platform[{leg}], actuator.minLength or .maxLength{numbering}",
                    numbering = numbering_advice(rig),
                    height = Shown(rig.neutral_height),
                    length = Shown(*length),
                    min_length = Shown(min_length),
                    max_length = Shown(max_length),
                    leg = i + 1
                ),
            );
        }
    }
    check_step_margin(rig, max_step, &neutral)?;
    if is_default(rig) {
        return Ok(());
    }
    match known_survey(rig) {
        Ok(_) => Ok(()),
        Err(failed) => refuse(
            "rig.base, rig.platform",
            format!(
                "make the platform singular inside the stroke of its actuators, at or near {}; choose other joints, or a \
                 shorter stroke{}{}",
                positions_text(rig, &failed.lengths),
                if rig.has_cranks() { ", or correct the order of crank.heading" } else { "" },
                numbering_advice(rig)
            ),
        ),
    }
}

/// Positions of the actuators as a text: lengths of legs, or angles of cranks.
fn positions_text(rig: &Rig, positions: &[f64; 6]) -> String {
    if rig.has_cranks() {
        let angles = positions.map(|arc| format!("{:.1}", Shown((arc / rig.crank_arm).to_degrees())));
        format!("angles of [{}] degrees", angles.join(", "))
    } else {
        format!("lengths of [{}] m", positions.map(|length| format!("{:.3}", Shown(length))).join(", "))
    }
}

/// Checks cranks at neutral: the order of their angles, and that their arms do not cross. Each rod
/// must reach its joint, with the arm within its angles and away from a dead centre.
fn check_cranks(rig: &Rig, cranks: &Cranks) -> Result<(), ParameterError> {
    let Rig { crank_min_angle, crank_max_angle, crank_rod, crank_arm, .. } = *rig;
    let degrees = |angle: f64| Shown(angle.to_degrees());
    if crank_min_angle >= crank_max_angle {
        return refuse(
            "crank.minAngle",
            format!(
                "is {} rad; it must be below crank.maxAngle, {} rad",
                Shown(crank_min_angle),
                Shown(crank_max_angle)
            ),
        );
    }
    if crank_rod <= crank_arm {
        return refuse(
            "crank.rod",
            format!(
                "is {} m; it must be longer than crank.arm, {} m, or the crank passes a dead centre",
                Shown(crank_rod),
                Shown(crank_arm)
            ),
        );
    }
    if let Some([first, second]) = crossing_arms(rig) {
        return refuse(
            "crank.arm",
            format!(
                "is {} m, with which the arms of cranks {first} and {second} meet above the base; shorten the arms, or \
                 correct crank.heading[{first}], crank.heading[{second}] or the base joints",
                Shown(crank_arm)
            ),
        );
    }
    let geometry = Geometry::from(rig);
    let neutral = Pose::neutral(rig);
    for i in 0..6 {
        let joint = geometry.between(i, &neutral);
        let [shortest, longest] = cranks.reaching_rods(i, &joint);
        if !(shortest < crank_rod && crank_rod < longest) {
            return refuse(
                "crank.rod",
                format!(
                    "is {} m, but at neutral the rod of crank {} needs {:.4} to {:.4} m to reach its joint; correct crank.rod, \
                     crank.arm or rig.neutralHeight, {} m{}",
                    Shown(crank_rod),
                    i + 1,
                    Shown(shortest),
                    Shown(longest),
                    Shown(rig.neutral_height),
                    heading_advice(rig)
                ),
            );
        }
    }
    let arms = cranks.arms_in(&geometry, &neutral);
    for i in 0..6 {
        let (angle, transmission) = (arms.angles()[i], arms.transmission[i]);
        if !(crank_min_angle < angle && angle < crank_max_angle) {
            return refuse(
                "rig.neutralHeight",
                format!(
                    "is {} m, and there the arm of crank {} would stand at {:.2} degrees, outside its angles from {:.2} to \
                     {:.2}; correct it, or crank.heading[{}], crank.minAngle or .maxAngle{}",
                    Shown(rig.neutral_height),
                    i + 1,
                    degrees(angle),
                    degrees(crank_min_angle),
                    degrees(crank_max_angle),
                    i + 1,
                    heading_advice(rig)
                ),
            );
        }
        if transmission <= cranks.least_transmission {
            return refuse(
                "crank.leastTransmission",
                format!(
                    "is {}, but at neutral crank {} has only {:.3}: it is near a dead centre, where rod and arm are in line; reduce \
                     it, or choose another crank.rod, crank.heading[{}] or rig.neutralHeight{}",
                    Shown(cranks.least_transmission),
                    i + 1,
                    Shown(transmission),
                    i + 1,
                    heading_advice(rig)
                ),
            );
        }
    }
    Ok(())
}

/// The first two cranks, from 1, whose arms cross each other as seen from above while both are
/// level. Both may then be at the same height.
fn crossing_arms(rig: &Rig) -> Option<[usize; 2]> {
    let arm = |i: usize| {
        let (sin, cos) = libm::sincos(rig.crank_heading[i]);
        (rig.base[i].xy(), rig.crank_arm * Vector2::new(cos, sin))
    };
    let pairs = (0..6).flat_map(|i| (i + 1..6).map(move |j| [i, j]));
    pairs.into_iter().find_map(|[i, j]| {
        let [(from, first), (to, second)] = [arm(i), arm(j)];
        let turn = first.perp(&second);
        let apart = to - from;
        let [along_first, along_second] = [apart.perp(&second) / turn, apart.perp(&first) / turn];
        let cross = (0.0..=1.0).contains(&along_first) && (0.0..=1.0).contains(&along_second);
        let high = (rig.base[i].z - rig.base[j].z).abs() <= 2.0 * rig.crank_arm;
        (cross && high).then_some([i + 1, j + 1])
    })
}

/// Advice as the end of a message, where the cranks would stand at neutral with their arms
/// turned by half a circle.
fn heading_advice(rig: &Rig) -> String {
    let turned = Rig { crank_heading: rig.crank_heading.map(|angle| angle + core::f64::consts::PI), ..*rig };
    if stroke_clearance(&turned, &Pose::neutral(&turned)) > 0.0 {
        return ". With the headings turned by 180 degrees it would fit".to_owned();
    }
    numbering_advice(rig)
}

/// Advice as the end of a message, for joints whose lists go opposite ways round.
fn numbering_advice(rig: &Rig) -> String {
    if numbering::is_opposite(rig) { format!(". {}", numbering::NUMBERING_ADVICE) } else { String::new() }
}

/// Rest at neutral is certified only if no leg can leave its stroke from there
/// between two ends of a step.
fn check_step_margin(rig: &Rig, max_step: f64, neutral: &[f64; 6]) -> Result<(), ParameterError> {
    let margin = step_margin(rig, max_step);
    let [start, end] = rig.stroke();
    let least = neutral.iter().map(|length| (length - start).min(end - length));
    let clearance = least.fold(f64::INFINITY, f64::min);
    if clearance > margin {
        return Ok(());
    }
    refuse(
        "solver.maxStep",
        format!(
            "is {} s: in half of it an actuator within its limits moves by up to {:.4} m, but at neutral one is only {:.4} m \
             from an end of its stroke; reduce solver.maxStep or the actuators' limits, or lengthen the stroke",
            Shown(max_step),
            Shown(margin),
            Shown(clearance)
        ),
    )
}

/// True for the default rig's legs and joints, which are known to be free of singularities.
fn is_default(rig: &Rig) -> bool {
    let default = Rig::default();
    let speeds_aside =
        Rig { velocity_limit: default.velocity_limit, acceleration_limit: default.acceleration_limit, ..*rig };
    speeds_aside == default
}
