//! Formats of public loggers: conventions by name.

use super::{ConventionOptions, Quantity, choices};

/// An enumeration of formats, and their files by the same words.
macro_rules! formats {
    ($(#[$attribute:meta])* $name:ident { $( $(#[doc = $text:literal])+ $word:literal $item:ident, )+ }) => {
        choices! { $(#[$attribute])* $name { $( $(#[doc = $text])+ $word $item, )+ } }

        const FILES: &[&str] = &[$( include_str!(concat!("../../../formats/", $word, ".toml")), )+];
    };
}

formats! {
    /// A logger or simulator whose files are read without further options.
    Format {
        /// phyphox, a directory of CSV files
        "phyphox" Phyphox,
        /// Sensor Logger on Android, a directory of CSV files
        "sensor-logger" SensorLogger,
        /// Sensor Logger on iOS, a directory of CSV files
        "sensor-logger-ios" SensorLoggerIos,
        /// SensorLog on iOS
        "sensorlog" SensorLog,
        /// AndroSensor
        "androsensor" AndroSensor,
        /// RaceChrono, CSV v3
        "racechrono" RaceChrono,
        /// AiM, CSV of Race Studio
        "aim" Aim,
        /// MoTeC i2, CSV
        "motec" Motec,
        /// Racelogic VBOX, .vbo
        "vbox" Vbox,
        /// iRacing, .ibt converted to CSV
        "iracing" IRacing,
        /// CarSim, results as CSV
        "carsim" CarSim,
        /// CarMaker, results as CSV
        "carmaker" CarMaker,
        /// PX4, sensor_combined of ulog2csv
        "px4" Px4,
    }
}

impl Format {
    /// The format's conventions as a file of conventions, with the source of its names in comments.
    pub fn file(self) -> &'static str {
        FILES[self as usize]
    }

    /// Name of the logger.
    pub fn title(self) -> &'static str {
        self.meaning().split(',').next().unwrap_or(self.word())
    }

    /// The format's name of a quantity's column.
    pub fn column(self, quantity: Quantity) -> Option<String> {
        self.options().columns.into_iter().find_map(|(named, name)| (named == quantity).then_some(name))
    }

    /// The format's conventions.
    ///
    /// # Panics
    /// Never: a test reads every file.
    pub fn options(self) -> ConventionOptions {
        toml::from_str(self.file()).expect("the formats' files are valid")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_is_the_logger_s_name() {
        assert_eq!(Format::Aim.title(), "AiM");
    }

    #[test]
    fn every_format_names_what_a_recording_needs() {
        for format in Format::ALL {
            let conventions = format.options().load().unwrap();
            assert!(conventions.columns.len() >= 7, "{}", format.word());
            assert!(!format.title().contains(',') && format.title() != "", "{}", format.word());
        }
    }
}
