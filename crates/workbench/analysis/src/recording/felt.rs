//! Tables of the motion that another washout computed: felt forces and rates, poses, legs.

use std::array;
use std::path::Path;

use moris_simulation::foreign::{ForeignMotion, on_samples};

use super::Recording;
use super::columns::Header;
use super::columns::units::Dimension;
use super::conventions::Conventions;
use super::message::RecordingError;
use super::read::{Sheet, source};
use crate::message::Message;
use crate::texts::text;

/// Names of the columns of a quantity, each as this project's outputs have it, then shorter.
pub struct Names<const N: usize> {
    /// The argument that gives the quantity.
    pub argument: &'static str,
    /// Names with blanks between them, N of each.
    sets: &'static [&'static str],
    dimensions: [Kind; N],
    of: fn(&ForeignMotion) -> &Series<N>,
}

/// A row for each sample; none if the table has no such columns.
type Series<const N: usize> = Option<Vec<[f64; N]>>;

/// Dimension of a column.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A dimension of recordings.
    Of(Dimension),
    /// A length of the platform, which has other units than a position on the road.
    Length,
}

impl Kind {
    /// The factor of a unit to SI; none if it is no unit of this dimension.
    pub fn factor(self, unit: &str) -> Option<f64> {
        match self {
            Kind::Length => LENGTH_UNITS.iter().find(|(spelling, _)| *spelling == unit).map(|(_, factor)| *factor),
            Kind::Of(dimension) => dimension.spelled(unit).map(|unit| unit.in_si),
        }
    }

    /// The units, as messages list them.
    pub fn units(self) -> String {
        match self {
            Kind::Length => LENGTH_UNITS.map(|(spelling, _)| spelling).join(", "),
            Kind::Of(dimension) => dimension.units().map(|unit| unit.word).collect::<Vec<_>>().join(", "),
        }
    }
}

/// Felt specific force.
pub const FELT_FORCE: Names<3> = Names {
    argument: "felt_force",
    sets: &["rider.specificForce.x rider.specificForce.y rider.specificForce.z", "ax ay az", "fx fy fz"],
    dimensions: [Kind::Of(Dimension::Force); 3],
    of: |motion| &motion.force,
};
/// Felt angular velocity.
pub const FELT_RATE: Names<3> = Names {
    argument: "felt_rate",
    sets: &["rider.angularVelocity.x rider.angularVelocity.y rider.angularVelocity.z", "wx wy wz"],
    dimensions: [Kind::Of(Dimension::Rate); 3],
    of: |motion| &motion.rate,
};
/// Poses of the platform.
pub const PLATFORM_POSE: Names<6> = Names {
    argument: "pose",
    sets: &[
        "platform.position.x platform.position.y platform.position.z platform.orientation.roll \
         platform.orientation.pitch platform.orientation.yaw",
        "x y z roll pitch yaw",
    ],
    dimensions: {
        let (length, angle) = (Kind::Length, Kind::Of(Dimension::Angle));
        [length, length, length, angle, angle, angle]
    },
    of: |motion| &motion.pose,
};
/// Lengths of the actuators.
pub const LEG_LENGTHS: Names<6> = Names {
    argument: "legs",
    sets: &[
        "actuator[1].length actuator[2].length actuator[3].length actuator[4].length actuator[5].length \
         actuator[6].length",
        "leg1 leg2 leg3 leg4 leg5 leg6",
    ],
    dimensions: [Kind::Length; 6],
    of: |motion| &motion.legs,
};

/// Spellings of units of length, and their factors to SI.
const LENGTH_UNITS: [(&str, f64); 4] = [("m", 1.0), ("dm", 0.1), ("cm", 0.01), ("mm", 1e-3)];

/// The columns of such a table, in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FeltTable {
    /// The file's name without directory and extension.
    pub name: String,
    /// Times \[s\]; none if the table has no times.
    time: Option<Vec<f64>>,
    /// The motion at the table's times.
    motion: ForeignMotion,
    /// Titles of all columns.
    titles: Vec<String>,
}

impl FeltTable {
    /// Reads a CSV file with the columns `time` and those of at least one quantity:
    ///
    /// - `rider.specificForce.x` to `.z`, or `ax ay az`, or `fx fy fz`;
    /// - `rider.angularVelocity.x` to `.z`, or `wx wy wz`;
    /// - `platform.position.x` to `.z` and `platform.orientation.roll` to `.yaw`, or
    ///   `x y z roll pitch yaw`;
    /// - `actuator[1].length` to `actuator[6].length`, or `leg1` to `leg6`.
    ///
    /// # Errors
    /// The file cannot be read, a value is no number, or a unit is unknown.
    pub fn read(file: &Path) -> Result<Self, RecordingError> {
        let conventions = Conventions::default();
        let sheet = Sheet::open(file, &conventions)?;
        let places = used_places(&sheet.header);
        let samples = sheet.samples(&places, &conventions)?;
        let column = |place: usize| {
            let found = samples.columns.iter().find(|(other, _)| *other == place);
            found.map(|(_, values)| values.clone()).unwrap_or_default()
        };
        let unit = sheet.time.as_ref().map(|terms| sheet.time_unit(terms, &conventions)).transpose()?;
        let time = unit.map(|(unit, _)| samples.time.iter().map(|time| time * unit.in_si).collect());
        Self::of(source::name(file), &sheet.header, time, column).map_err(|reason| sheet.refused(reason))
    }

    /// The table of columns in memory, each a title and its values.
    ///
    /// # Errors
    /// Columns differ in length, or a unit is unknown.
    pub fn of_columns(name: &str, columns: &[(String, Vec<f64>)]) -> Result<Self, RecordingError> {
        let refused = |reason| RecordingError::whole(Path::new(name), reason);
        let header = Header::new(columns.iter().map(|(title, _)| title.as_str()));
        let conventions = Conventions::default();
        let time = match header.terms("time").map_err(refused)? {
            Some(terms) => {
                let (unit, _) = header.time_unit(&terms, &conventions).map_err(refused)?;
                let place = terms.first().map_or(0, |term| term.place);
                Some(columns[place].1.iter().map(|time| time * unit.in_si).collect())
            }
            None => None,
        };
        Self::of(name.to_owned(), &header, time, |place| columns[place].1.clone()).map_err(refused)
    }

    fn of(
        name: String,
        header: &Header,
        time: Option<Vec<f64>>,
        column: impl Fn(usize) -> Vec<f64>,
    ) -> Result<Self, Message> {
        let motion = ForeignMotion {
            force: FELT_FORCE.rows(header, &column)?,
            rate: FELT_RATE.rows(header, &column)?,
            pose: PLATFORM_POSE.rows(header, &column)?,
            legs: LEG_LENGTHS.rows(header, &column)?,
        };
        let titles = (0..header.width()).map(|place| header.shown(place)).collect();
        Ok(FeltTable { name, time, motion, titles })
    }

    /// The motion at the samples of a recording, and sentences about interpolations. A table
    /// without times has a row for each sample, or for each of equal parts of a step.
    ///
    /// # Errors
    /// There is nothing to judge, or the times do not cover the recording.
    pub fn motion(&self, recording: &Recording) -> Result<(ForeignMotion, Vec<String>), String> {
        if self.motion.force.is_none() && self.motion.pose.is_none() && self.motion.legs.is_none() {
            let [force, pose, legs] = [FELT_FORCE.shown(), PLATFORM_POSE.shown(), LEG_LENGTHS.shown()];
            let titles = self.titles.join(", ");
            return Err(text!["no-felt-columns", force, pose, legs, titles].to_string());
        }
        let mut notes = Vec::new();
        let motion = ForeignMotion {
            force: self.placed(&FELT_FORCE, recording, &mut notes)?,
            rate: self.placed(&FELT_RATE, recording, &mut notes)?,
            pose: self.placed(&PLATFORM_POSE, recording, &mut notes)?,
            legs: self.placed(&LEG_LENGTHS, recording, &mut notes)?,
        };
        Ok((motion, notes))
    }

    /// One quantity of the motion alone; adds sentences about interpolations to `notes`.
    ///
    /// # Errors
    /// The table has no such columns, or as [`FeltTable::motion`].
    pub fn part<const N: usize>(
        &self,
        names: &Names<N>,
        recording: &Recording,
        notes: &mut Vec<String>,
    ) -> Result<Vec<[f64; N]>, String> {
        self.placed(names, recording, notes)?.ok_or_else(|| {
            let titles = self.titles.join(", ");
            format!("{}: there are no columns {}; there are {titles}", names.argument, names.shown())
        })
    }

    /// As [`FeltTable::part`], by the names of this project's outputs alone. In a recording the
    /// shorter ones are the vehicle's.
    ///
    /// # Errors
    /// There are no such columns, or they do not cover the recording.
    pub fn measured_part<const N: usize>(
        &self,
        names: &Names<N>,
        recording: &Recording,
        notes: &mut Vec<String>,
    ) -> Result<Vec<[f64; N]>, String> {
        let outputs = names.sets[0];
        let is_there = |name: &str| self.titles.iter().any(|title| title.split([' ', '[']).next() == Some(name));
        if outputs.split(' ').all(is_there) {
            return self.part(names, recording, notes);
        }
        Err(format!("there are no columns {}; there are {}", first_to_last(outputs), self.titles.join(", ")))
    }

    fn placed<const N: usize>(
        &self,
        names: &Names<N>,
        recording: &Recording,
        notes: &mut Vec<String>,
    ) -> Result<Series<N>, String> {
        let series = (names.of)(&self.motion);
        let (Some(series), Some(time)) = (series, &self.time) else { return Ok(series.clone()) };
        let samples = recording.inputs().len();
        let placed = on_samples(names.argument, time, series, recording.start, recording.step(), samples);
        let (series, note) = placed.map_err(|reason| reason.to_string())?;
        notes.extend(note);
        Ok(Some(series))
    }
}

/// The places of all columns that are used, each once.
fn used_places(header: &Header) -> Vec<usize> {
    let mut places: Vec<usize> =
        [FELT_FORCE.places(header), FELT_RATE.places(header)].into_iter().flatten().flatten().collect();
    places.extend([PLATFORM_POSE.places(header), LEG_LENGTHS.places(header)].into_iter().flatten().flatten());
    places.sort_unstable();
    places.dedup();
    places
}

impl<const N: usize> Names<N> {
    /// The places of the columns, of the first names that are all there.
    fn places(&self, header: &Header) -> Option<[usize; N]> {
        let place = |name: &str| header.place(name).ok().flatten();
        let places = |names: &&str| names.split(' ').filter_map(place).collect::<Vec<usize>>();
        self.sets.iter().map(places).find_map(|found| found.try_into().ok())
    }

    fn rows(&self, header: &Header, column: impl Fn(usize) -> Vec<f64>) -> Result<Option<Vec<[f64; N]>>, String> {
        let Some(places) = self.places(header) else { return Ok(None) };
        let mut columns = Vec::with_capacity(N);
        for (&place, kind) in places.iter().zip(self.dimensions) {
            let factor = unit_factor(header, place, kind)?;
            columns.push(column(place).into_iter().map(|value| value * factor).collect::<Vec<f64>>());
        }
        let count = columns[0].len();
        if let Some(k) = columns.iter().position(|column| column.len() != count) {
            let [first, other] = [places[0], places[k]].map(|place| header.shown(place));
            return Err(format!("column {other} has {} values, but {first} {count}", columns[k].len()));
        }
        Ok(Some((0..count).map(|row| array::from_fn(|k| columns[k][row])).collect()))
    }

    /// The names, as messages list them.
    fn shown(&self) -> String {
        self.sets.iter().map(|names| first_to_last(names)).collect::<Vec<_>>().join(" or ")
    }
}

/// The first and the last of names between blanks.
fn first_to_last(names: &str) -> String {
    let ends = [names.split(' ').next(), names.split(' ').next_back()];
    ends.map(Option::unwrap_or_default).join(" to ")
}

/// The factor of a column to SI, by the unit in its title.
fn unit_factor(header: &Header, place: usize, kind: Kind) -> Result<f64, String> {
    let Some(unit) = header.unit_text(place) else { return Ok(1.0) };
    kind.factor(unit)
        .ok_or_else(|| format!("column {} has the unit {unit}; write one of {}", header.shown(place), kind.units()))
}
