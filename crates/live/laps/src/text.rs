//! The memory as text: a line for each point.

use alloc::{format, string::String, vec::Vec};

use crate::laps::Laps;
use crate::line::{MAX_POINTS, Point};

/// First line of the text, and the names of the columns.
const FORMAT_LINE: &str = "moris-laps,1";
const COLUMN_NAMES: &str = "run,x,y,z,direction_x,direction_y,direction_z,speed,surge,sway";

/// Reason for which a text is no memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoMemory {
    /// The first line that is none of a memory, from 1.
    pub line: usize,
}

impl core::fmt::Display for NoMemory {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        write!(f, "line {} is none of a road that moris has learned", self.line)
    }
}

impl core::error::Error for NoMemory {}

impl Laps {
    /// The remembered points as text, rounded to millimetres. [`Laps::of_text`] reads it.
    pub fn text(&self) -> String {
        let mut text = format!("{FORMAT_LINE}\n{COLUMN_NAMES}\n");
        let (mut before, mut count) = (None, 0);
        for Point { position: [x, y, z], direction: [a, b, c], speed, force: [surge, sway], run } in self.points() {
            count += u32::from(before.replace(*run).is_some_and(|before| before != *run));
            text += &format!("{count},{x:.3},{y:.3},{z:.3},{a:.4},{b:.4},{c:.4},{speed:.3},{surge:.3},{sway:.3}\n");
        }
        text
    }

    /// The memory of a text. Its points are known, and must prove themselves anew.
    ///
    /// # Errors
    /// The text is none of [`Laps::text`].
    ///
    /// ```
    /// use moris_laps::Laps;
    ///
    /// let text = Laps::new().text();
    /// assert_eq!(Laps::of_text(&text)?.text(), text);
    /// assert_eq!(Laps::of_text("x,y").unwrap_err().to_string(), "line 1 is none of a road that moris has learned");
    /// # Ok::<(), moris_laps::NoMemory>(())
    /// ```
    pub fn of_text(text: &str) -> Result<Laps, NoMemory> {
        let mut lines = text.lines().enumerate().map(|(place, line)| (place + 1, line));
        for expected in [FORMAT_LINE, COLUMN_NAMES] {
            lines.next().filter(|(_, line)| *line == expected).ok_or(NoMemory { line: 1 })?;
        }
        let mut points = Vec::with_capacity(MAX_POINTS.min(text.len() / 40));
        for (line, fields) in lines {
            points.push(point(fields).ok_or(NoMemory { line })?);
        }
        Ok(Laps::remembering(&points))
    }
}

/// The point of a line.
fn point(line: &str) -> Option<Point> {
    // Largest position [m], speed [m/s] and force [m/s2].
    const MAX_VALUES: [f64; 3] = [1e9, 1e4, 1e3];
    let mut fields = line.split(',');
    let run = fields.next()?.parse().ok()?;
    let mut number = |largest: f64| {
        let number: f64 = fields.next()?.parse().ok()?;
        (number.abs() <= largest).then_some(number)
    };
    let [place, speed, force] = MAX_VALUES;
    let point = Point {
        position: [number(place)?, number(place)?, number(place)?],
        direction: [number(1.0)?, number(1.0)?, number(1.0)?],
        speed: number(speed)?,
        force: [number(force)?, number(force)?],
        run,
    };
    fields.next().is_none().then_some(point)
}
