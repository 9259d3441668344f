//! Curvature and speed limit by distance.

use moris_interface::{ParameterError, refuse};
use serde::{Deserialize, Serialize};

use crate::interface::{Course, PATH_POINTS, Path, PathColumn};

/// Curvature and speed limit of a path, linear between its rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Distance from the beginning \[m\], ascending from 0.
    distance: PathColumn,
    /// Curvature \[1/m\], positive to the right.
    curvature: PathColumn,
    /// Speed \[m/s\].
    speed: PathColumn,
    /// Number of rows, two at least.
    count: usize,
    repeat: bool,
}

/// A place between two rows: the first of them, and the fraction of the way to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    pub row: usize,
    pub fraction: f64,
}

/// The paths that come with the model.
const SHIPPED_PATHS: [(Course, &str, bool); 4] = [
    (Course::LaneChange, include_str!("../../paths/lane-change.csv"), false),
    (Course::Slalom, include_str!("../../paths/slalom.csv"), false),
    (Course::Hairpin, include_str!("../../paths/hairpin.csv"), false),
    (Course::Lap, include_str!("../../paths/lap.csv"), true),
];

/// The custom path of a CSV file, as parameters.
///
/// The first line has the names `distance`, `curvature` and `speed`, in any order; each further
/// line has the three numbers \[m, 1/m, m/s\], comma-separated. The curvature is positive to the
/// left. Empty lines and lines that begin with `#` are skipped.
///
/// # Errors
/// The line that cannot be read, and why. The values themselves are checked by the model.
///
/// ```
/// use moris_motorcycle::path::table::from_csv;
///
/// let path = from_csv("distance,curvature,speed\n0,0,20\n100,0.01,20\n")?;
/// assert_eq!((path.count, path.curvature[1]), (2, 0.01));
/// # Ok::<(), String>(())
/// ```
pub fn from_csv(text: &str) -> Result<Path, String> {
    let mut lines = text
        .lines()
        .zip(1..)
        .map(|(line, number)| (line.trim(), number))
        .filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    let (names, _) = lines.next().ok_or("is empty; it must begin with the line distance,curvature,speed")?;
    let names: Vec<&str> = names.split(',').map(str::trim).collect();
    let column = |name: &str| {
        let found = names.iter().position(|known| *known == name);
        found.ok_or_else(|| format!("has no column {name}; its first line must be distance,curvature,speed"))
    };
    let columns = [column("distance")?, column("curvature")?, column("speed")?];
    let mut path = Path { course: Course::Custom, ..Path::default() };
    let mut rows = 0;
    for (line, number) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let mut values = [0.0; 3];
        for (value, (&column, name)) in values.iter_mut().zip(columns.iter().zip(["distance", "curvature", "speed"])) {
            let cell = cells.get(column).ok_or_else(|| format!("line {number}: has no {name}"))?;
            *value = cell.parse().map_err(|_| format!("line {number}: {name} is {cell:?}, which is no number"))?;
        }
        if rows < PATH_POINTS {
            [path.distance[rows], path.curvature[rows], path.speed_limit[rows]] = values;
        }
        rows += 1;
    }
    if rows > PATH_POINTS {
        return Err(format!(
            "has {rows} rows, and a path has {PATH_POINTS} at most; curvature and speed are linear between rows, so keep only \
             the rows at which their slopes change"
        ));
    }
    path.count = rows as i32;
    Ok(path)
}

impl Table {
    /// The path that the parameters choose; `None` without one.
    ///
    /// # Errors
    /// The first row of the custom path that cannot be used, and why.
    pub fn new(parameters: &Path) -> Result<Option<Table>, ParameterError> {
        let course = parameters.course;
        let custom = |path: &Path, repeat: bool| Table {
            distance: path.distance,
            curvature: -path.curvature,
            speed: path.speed_limit,
            count: path.count as usize,
            repeat,
        };
        if course == Course::Custom {
            check_path(parameters)?;
            return Ok(Some(custom(parameters, parameters.repeat)));
        }
        let shipped = SHIPPED_PATHS.iter().find(|(of, ..)| *of == course);
        Ok(shipped
            .map(|(_, text, repeat)| custom(&from_csv(text).expect("the model's own paths are readable"), *repeat)))
    }

    /// A warning where the parameters have a table that their course does not use.
    pub fn unused(parameters: &Path) -> Option<String> {
        let Path { course, count, .. } = parameters;
        (*count > 0 && *course != Course::Custom).then(|| {
            let custom = Course::Custom.name();
            format!(
                "path.point.count is {count}, and path.course is {} ({}): the table is not used; set path.course to {} ({custom}) to ride it",
                course.name(), *course as i32 + 1, Course::Custom as i32 + 1
            )
        })
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.count.clamp(2, PATH_POINTS)
    }

    /// True if the path begins again at its end.
    pub fn repeats(&self) -> bool {
        self.repeat
    }

    /// Length of the path, of a round where it repeats \[m\].
    pub fn length(&self) -> f64 {
        self.distance[self.count() - 1]
    }

    /// True beyond the end of a path that does not repeat.
    pub fn is_over(&self, distance: f64) -> bool {
        !self.repeat && distance >= self.length()
    }

    /// The place at a distance: on the path or, beyond its ends, at them.
    pub fn find(&self, distance: f64) -> Between {
        let length = self.length();
        let within = if self.repeat { distance - length * libm::floor(distance / length) } else { distance };
        let after = self.distance.as_slice()[..self.count()].partition_point(|&row| row <= within);
        let row = after.clamp(1, self.count() - 1) - 1;
        let span = self.distance[row + 1] - self.distance[row];
        let fraction = ((within - self.distance[row]) / span).clamp(0.0, 1.0);
        Between { row, fraction: if fraction.is_nan() { 0.0 } else { fraction } }
    }

    /// Curvature at a place \[1/m\], positive to the right.
    pub fn curvature(&self, place: Between) -> f64 {
        column_between(&self.curvature, place)
    }

    /// Curvature at a distance, straight beyond the ends \[1/m\].
    pub fn curvature_at(&self, distance: f64) -> f64 {
        if !self.repeat && !(0.0..self.length()).contains(&distance) {
            0.0
        } else {
            self.curvature(self.find(distance))
        }
    }

    /// Speed limit at a place \[m/s\].
    pub fn speed(&self, place: Between) -> f64 {
        column_between(&self.speed, place)
    }

    /// Distance of a place from the beginning \[m\].
    pub fn distance(&self, place: Between) -> f64 {
        column_between(&self.distance, place)
    }
}

fn column_between(values: &PathColumn, Between { row, fraction }: Between) -> f64 {
    values[row] + fraction * (values[row + 1] - values[row])
}

/// Checks the custom path.
fn check_path(path: &Path) -> Result<(), ParameterError> {
    // Least distance between two rows [m].
    const MIN_ROW_DISTANCE: f64 = 0.1;
    // Least speed limit, except at the end of a path that does not repeat [m/s].
    const MIN_SPEED_LIMIT: f64 = 1.0;
    let count = path.count as usize;
    if count < 2 {
        return refuse("path.point.count", format!("is {count}; a custom path has two rows at least"));
    }
    if path.distance[0] != 0.0 {
        return refuse("path.point.distance[1]", format!("is {} m; the first row is at 0", path.distance[0]));
    }
    for row in 1..count {
        let (before, here) = (path.distance[row - 1], path.distance[row]);
        if here < before + MIN_ROW_DISTANCE {
            return refuse(
                format!("path.point.distance[{}]", row + 1),
                format!(
                    "is {here} m, and the row before is at {before} m; rows are {MIN_ROW_DISTANCE} m apart at least"
                ),
            );
        }
    }
    for row in 0..count {
        let is_end = row == count - 1 && !path.repeat;
        if path.speed_limit[row] < MIN_SPEED_LIMIT && !is_end {
            return refuse(
                format!("path.point.speed[{}]", row + 1),
                format!(
                    "is {} m/s; it must be {MIN_SPEED_LIMIT} m/s at least, except at the end of a path that does not repeat",
                    path.speed_limit[row]
                ),
            );
        }
    }
    let ends = [path.curvature[0], path.curvature[count - 1]];
    if path.repeat && ends[0] != ends[1] {
        return refuse(
            format!("path.point.curvature[{count}]"),
            format!("is {} 1/m; the path repeats, so it must be that of the first row, {} 1/m", ends[1], ends[0]),
        );
    }
    Ok(())
}
