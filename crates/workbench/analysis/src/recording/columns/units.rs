//! Units that a recording may be in, and their spellings in the headers of loggers.

use moris_washout::interface::STANDARD_GRAVITY;

use crate::recording::conventions::choices;

/// A foot \[m\].
const METRES_PER_FOOT: f64 = 0.3048;

/// Units that only headers give.
const IN_HEADERS: [(Dimension, Unit); 9] = [
    (Dimension::Force, Unit { word: "mm/s2", in_si: 1e-3 }),
    (Dimension::Force, Unit { word: "cm/s2", in_si: 1e-2 }),
    (Dimension::Rate, Unit { word: "mdeg/s", in_si: 1e-3 * 1f64.to_radians() }),
    (Dimension::Rate, Unit { word: "mrad/s", in_si: 1e-3 }),
    (Dimension::Speed, Unit { word: "mm/s", in_si: 1e-3 }),
    (Dimension::Speed, Unit { word: "cm/s", in_si: 1e-2 }),
    (Dimension::Angle, Unit { word: "mrad", in_si: 1e-3 }),
    (Dimension::Length, Unit { word: "mm", in_si: 1e-3 }),
    (Dimension::Length, Unit { word: "cm", in_si: 1e-2 }),
];

/// A unit of one of the quantities of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Word for it on the command line.
    pub word: &'static str,
    /// Factor to the SI unit.
    pub in_si: f64,
}

/// Kinds of quantities, each with units of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dimension {
    Time,
    Force,
    Rate,
    Angle,
    Speed,
    Length,
}

/// Declares the units of one dimension: word, item, factor to SI, and other spellings, as
/// [`plain_unit`] leaves them.
macro_rules! units {
    ($(#[$attribute:meta])* $name:ident {
        $( $(#[doc = $text:literal])+ $word:literal $item:ident = $in_si:expr, [$($spelling:literal)*], )+
    }) => {
        choices! { $(#[$attribute])* $name { $( $(#[doc = $text])+ $word $item, )+ } }

        impl $name {
            /// All units, in the order of the items, with their other spellings.
            const SPELLED: &[(Unit, &[&str])] =
                &[$( (Unit { word: $word, in_si: $in_si }, &[$($spelling),*]), )+];

            /// The unit with its factor to SI.
            pub fn unit(self) -> Unit {
                Self::SPELLED[self as usize].0
            }
        }
    };
}

units! {
    /// Unit of the time.
    TimeUnit {
        /// Seconds
        "s" Second = 1.0, ["unixtime" "sec" "secs" "second" "seconds"],
        /// Milliseconds
        "ms" Millisecond = 1e-3, ["msec" "msecs" "millisec" "millisecond" "milliseconds" "millis"],
        /// Microseconds
        "us" Microsecond = 1e-6, ["µs" "usec" "usecs" "microsec" "microsecond" "microseconds" "micros"],
        /// Nanoseconds
        "ns" Nanosecond = 1e-9, ["nsec" "nsecs" "nanosec" "nanosecs" "nanosecond" "nanoseconds" "nanos"],
        /// Minutes
        "min" Minute = 60.0, ["mins" "minute" "minutes"],
        /// Hours
        "h" Hour = 3600.0, ["hr" "hrs" "hour" "hours"],
        /// Days
        "d" Day = 86_400.0, ["day" "days"],
    }
}

units! {
    /// Unit of the specific force.
    ForceUnit {
        /// Metres per second squared
        "m/s2" MetrePerSecondSquared = 1.0,
            ["ms-2" "ms2" "m/s/s" "m/(s2)" "mps2" "mpss" "m/sec2" "m/sec/sec" "metre/second2" "meter/second2" "metres/second2" "meters/second2"],
        /// Standard gravity, 9.80665 m/s2
        "g" Gravity = STANDARD_GRAVITY, ["gs" "gee" "g0" "gn" "gforce" "g-force"],
        /// Thousandths of standard gravity
        "mg" MilliGravity = 1e-3 * STANDARD_GRAVITY, ["milli-g" "millig"],
        /// Feet per second squared
        "ft/s2" FootPerSecondSquared = METRES_PER_FOOT,
            ["fts-2" "fps2" "fpss" "ft/s/s" "ft/(s2)" "ft/sec2" "ft/sec/sec" "feet/s2" "feet/sec2" "feet/second2" "foot/second2"],
    }
}

units! {
    /// Unit of the angular velocity.
    RateUnit {
        /// Radians per second
        "rad/s" RadianPerSecond = 1.0, ["rads-1" "rps" "rad/sec" "rads/s" "rads/sec" "radps" "radian/s" "radians/s" "radian/second" "radians/second"],
        /// Degrees per second
        "deg/s" DegreePerSecond = 1f64.to_radians(),
            ["°/s" "°s-1" "°/sec" "dps" "degs-1" "deg/sec" "degs/s" "degps" "degree/s" "degrees/s" "degrees/sec" "degree/second" "degrees/second"],
    }
}

units! {
    /// Unit of the angles.
    AngleUnit {
        /// Radians
        "rad" Radian = 1.0, ["rads" "radian" "radians"],
        /// Degrees
        "deg" Degree = 1f64.to_radians(), ["°" "degs" "degree" "degrees"],
    }
}

units! {
    /// Unit of the speed.
    SpeedUnit {
        /// Metres per second
        "m/s" MetrePerSecond = 1.0, ["ms-1" "mps" "m/sec" "metre/second" "meter/second" "metres/second" "meters/second"],
        /// Kilometres per hour
        "km/h" KilometrePerHour = 1.0 / 3.6, ["kmh" "kmh-1" "km/hr" "km/hour" "kph" "kmph" "kilometer/hour" "kilometers/hour" "kilometres/hour"],
        /// Miles per hour
        "mph" MilePerHour = 0.44704, ["mi/h" "miles/h" "mile/hour" "miles/hour"],
        /// Knots
        "kn" Knot = 1852.0 / 3600.0, ["kt" "kts" "knot" "knots"],
        /// Feet per second
        "ft/s" FootPerSecond = METRES_PER_FOOT, ["fts-1" "fps" "ft/sec" "feet/s" "feet/sec" "feet/second"],
    }
}

units! {
    /// Unit of the position.
    LengthUnit {
        /// Metres
        "m" Metre = 1.0, ["metre" "metres" "meter" "meters"],
        /// Kilometres
        "km" Kilometre = 1e3, ["kilometre" "kilometres" "kilometer" "kilometers"],
        /// Feet
        "ft" Foot = METRES_PER_FOOT, ["foot" "feet"],
    }
}

impl Dimension {
    pub const ALL: [Dimension; 6] = {
        use Dimension::{Angle, Force, Length, Rate, Speed, Time};
        [Time, Force, Rate, Angle, Speed, Length]
    };

    /// Name of the option that gives its unit.
    pub fn option(self) -> &'static str {
        ["time-unit", "force-unit", "rate-unit", "angle-unit", "speed-unit", "length-unit"][self as usize]
    }

    /// The name in messages.
    pub fn name(self) -> &'static str {
        ["time", "specific force", "angular velocity", "angle", "speed", "position"][self as usize]
    }

    /// The units, the SI unit first, each with its other spellings.
    fn spelled_units(self) -> &'static [(Unit, &'static [&'static str])] {
        match self {
            Dimension::Time => TimeUnit::SPELLED,
            Dimension::Force => ForceUnit::SPELLED,
            Dimension::Rate => RateUnit::SPELLED,
            Dimension::Angle => AngleUnit::SPELLED,
            Dimension::Speed => SpeedUnit::SPELLED,
            Dimension::Length => LengthUnit::SPELLED,
        }
    }

    /// All units of the dimension.
    pub fn units(self) -> impl Iterator<Item = Unit> {
        self.spelled_units().iter().map(|(unit, _)| *unit)
    }

    /// The unit of a recording that gives none: the SI unit, which is the first.
    pub fn default_unit(self) -> Unit {
        self.spelled_units()[0].0
    }

    /// The unit with this spelling in a header, whatever its case and signs; none if it is no
    /// unit of this dimension.
    pub fn spelled(self, text: &str) -> Option<Unit> {
        let plain = plain_unit(text);
        let is_spelled = |(unit, others): &&(Unit, &[&str])| unit.word == plain || others.contains(&plain.as_str());
        let usual = self.spelled_units().iter().find(is_spelled).map(|(unit, _)| *unit);
        let plain = plain.replace("mdps", "mdeg/s");
        let in_headers = || IN_HEADERS.iter().find(|(of, unit)| *of == self && unit.word == plain);
        usual.or_else(|| in_headers().map(|(_, unit)| *unit))
    }
}

/// The dimension and unit with this spelling.
pub fn any_spelled(text: &str) -> Option<(Dimension, Unit)> {
    Dimension::ALL.into_iter().find_map(|dimension| Some((dimension, dimension.spelled(text)?)))
}

/// A unit in lower case, without spaces and signs of multiplication, with plain
/// exponents: `m·s⁻²` is `ms-2`, `meters per second squared` is `meters/second2`. Signs that were
/// lost on the way, as in `m/s?`, `�/s` and `m/sÂ²`, are those that fit the place.
fn plain_unit(text: &str) -> String {
    let lower = text.to_lowercase();
    let text = lower.replace(" per ", "/").replace(" squared", "2");
    let first = text.chars().find(|c| *c != 'â');
    let plain = |c: char| match c {
        '^' | '*' | '·' | '⋅' | '.' | 'â' => None,
        '?' | '\u{fffd}' if first == Some(c) => Some('°'),
        '?' | '\u{fffd}' => Some('2'),
        _ if c.is_whitespace() => None,
        '²' => Some('2'),
        '¹' => Some('1'),
        '⁻' | '−' => Some('-'),
        'º' | '˚' => Some('°'),
        'μ' => Some('µ'),
        _ => Some(c),
    };
    // The Greek letter is mapped after lowering the case, which leaves either micro sign alone.
    text.chars().filter_map(plain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_recognised_in_any_usual_spelling() {
        let spelled = |text: &str| any_spelled(text).map(|(dimension, unit)| (dimension, unit.word));
        for text in ["m/s2", "m/s^2", "m/s²", "m / s²", "m·s⁻²", "m s^-2", "m/s/s", "M/S2"] {
            assert_eq!(spelled(text), Some((Dimension::Force, "m/s2")), "{text}");
        }
        for text in ["deg/s", "°/s", "º/s", "dps", "DPS", "deg s^-1", "degrees/second"] {
            assert_eq!(spelled(text), Some((Dimension::Rate, "deg/s")), "{text}");
        }
        for text in ["µs", "μs", "us"] {
            assert_eq!(spelled(text), Some((Dimension::Time, "us")), "{text}");
        }
        for text in ["km/h", "kph", "km·h⁻¹", "KMH"] {
            assert_eq!(spelled(text), Some((Dimension::Speed, "km/h")), "{text}");
        }
        assert_eq!(spelled("G"), Some((Dimension::Force, "g")));
        assert_eq!(spelled("m s-1"), Some((Dimension::Speed, "m/s")));
        assert_eq!((spelled("counts"), spelled("")), (None, None));
        for text in ["meters per second squared", "m/s\u{fffd}", "m/s?", "m/sÂ²", "m/s**2"] {
            assert_eq!(spelled(text), Some((Dimension::Force, "m/s2")), "{text}");
        }
        for text in ["degrees per second", "\u{fffd}/s", "?/s", "Â°/s"] {
            assert_eq!(spelled(text), Some((Dimension::Rate, "deg/s")), "{text}");
        }
        let words = ["mm/s^2", "mdps", "cm/s", "kilometers per hour"].map(|text| spelled(text).map(|(_, word)| word));
        assert_eq!(words, [Some("mm/s2"), Some("mdeg/s"), Some("cm/s"), Some("km/h")]);
    }

    /// No spelling belongs to two dimensions: a unit alone says the dimension that it is of.
    #[test]
    fn every_spelling_has_one_meaning() {
        for text in
            ["s", "ms", "us", "ns", "g", "mg", "m/s2", "ms-2", "rad/s", "rps", "dps", "rad", "°", "mps", "ms-1", "kt"]
        {
            let meanings = Dimension::ALL.into_iter().filter(|dimension| dimension.spelled(text).is_some()).count();
            assert_eq!(meanings, 1, "{text}");
        }
    }
}
