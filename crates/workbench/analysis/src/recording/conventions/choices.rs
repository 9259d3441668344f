//! Words of which options choose one.

/// Declares an enumeration whose items users write, on the command line and in TOML alike.
macro_rules! choices {
    ($(#[$attribute:meta])* $name:ident { $( $(#[doc = $text:literal])+ $word:literal $item:ident, )+ }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, schemars::JsonSchema)]
        #[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
        pub enum $name {
            $( $(#[doc = $text])+ #[cfg_attr(feature = "clap", value(name = $word))] #[serde(rename = $word)] $item, )+
        }

        impl $name {
            /// All items, in their order.
            pub const ALL: &[$name] = &[$( $name::$item, )+];

            /// The item's meaning, in its first line.
            pub fn meaning(self) -> &'static str {
                match self { $( $name::$item => [$($text),+][0].trim(), )+ }
            }

            /// Word for it on the command line.
            pub fn word(self) -> &'static str {
                match self { $( $name::$item => $word, )+ }
            }
        }
    };
}
pub(in crate::recording) use choices;

choices! {
    /// Presence of gravity's reaction in the accelerations.
    Gravity {
        /// Gravity's reaction is in: (0, 0, +9.81) at rest, what an accelerometer reads
        "included" Included,
        /// Gravity has been taken out: (0, 0, 0) at rest
        "removed" Removed,
    }
}

choices! {
    /// Directions of x, y and z.
    Axes {
        /// x forward, y left, z up (ISO 8855)
        "forward-left-up" ForwardLeftUp,
        /// x forward, y right, z down (aviation, SAE J670)
        "forward-right-down" ForwardRightDown,
        /// x forward, y right, z up; rotations follow the left hand, as in game engines
        "forward-right-up" ForwardRightUp,
    }
}

choices! {
    /// The axes in which a vector is given.
    Frame {
        /// The vehicle's own: what sensors measure
        "body" Body,
        /// The world's
        "world" World,
    }
}

choices! {
    /// Fields that are empty.
    EmptyFields {
        /// An error
        "error" Error,
        /// Interpolated between their neighbours: the channels are
        /// sampled at different rates
        "interpolate" Interpolate,
    }
}

choices! {
    /// Columns of specific force and angular velocity that a recording lacks.
    Missing {
        /// An error
        "error" Error,
        /// Values at rest: zero, and g along z
        "rest" Rest,
    }
}

impl Axes {
    /// Factors that turn forces along x, y and z into those along x forward, y left, z up.
    pub fn force_signs(self) -> [f64; 3] {
        match self {
            Axes::ForwardLeftUp => [1.0, 1.0, 1.0],
            Axes::ForwardRightDown => [1.0, -1.0, -1.0],
            Axes::ForwardRightUp => [1.0, -1.0, 1.0],
        }
    }

    /// The same for rates and angles about these axes. Left-handed axes turn the other way round.
    pub fn rotation_signs(self) -> [f64; 3] {
        match self {
            Axes::ForwardRightUp => [-1.0, 1.0, -1.0],
            _ => self.force_signs(),
        }
    }
}
