//! The macros that declare an interface: a struct and its rows from the same lines.

/// Declares a struct of variables.
///
/// Each field has these parts, in this order:
///
/// - the variability, where it differs from the struct's;
/// - the FMI name, a template, see [`Row`](crate::Row);
/// - the Rust name and type;
/// - the unit in brackets, for reals only;
/// - the range in braces, which includes both ends and which all checks use;
/// - the start value, a constant expression. The compiler evaluates it, so that no machine's
///   arithmetic changes it;
/// - the tail, separated by commas: methods of [`Row`](crate::Row) such as `usual` and `used_if`,
///   which say what the row is for. After the struct's variability they hold for all of its rows.
///
/// The doc comment is the variable's description everywhere. Write one sentence without markup.
///
/// ```
/// use moris_interface::{interface, units::*, Group, Variability};
/// interface! {
///     /// Parameters of a spring.
///     pub struct Spring: Parameter, Fixed {
///         /// Length at which the spring carries no load.
///         "spring.length" length: f64 [M] { 0.01 ..= 10.0 } = 0.3;
///         /// Damping ratio.
///         Tunable "spring.damping" damping: f64 { 0.0 ..= 2.0 } = 0.7;
///         /// Number of coils.
///         "spring.coils" coils: i32 { 1 ..= 100 } = 7, usual(3.0 ..= 20.0), heading("Shape");
///     }
/// }
/// assert_eq!(Spring::ROWS[2].variable_name(0), "spring.coils");
/// assert_eq!(Spring::ROWS[2].variability, Variability::Fixed);
/// assert_eq!((Spring::ROWS[2].usual, Spring::ROWS[2].heading), (Some((3.0, 20.0)), Some("Shape")));
/// assert_eq!(Spring::ROWS[1].variability, Variability::Tunable);
/// assert_eq!(Spring::default().length, 0.3);
/// let stretched = Spring { length: 11.0, ..Spring::default() };
/// let error = stretched.check_ranges().unwrap_err();
/// assert_eq!(error.to_string(), "spring.length: is 11, but must be from 0.01 to 10");
/// ```
///
/// A usual range beyond the row's range does not compile:
///
/// ```compile_fail
/// moris_interface::interface! {
///     /// Parameters of a spring.
///     pub struct Spring: Parameter, Fixed {
///         /// Damping ratio.
///         "spring.damping" damping: f64 { 0.0 ..= 2.0 } = 0.7, usual(0.3 ..= 3.0);
///     }
/// }
/// ```
#[macro_export]
macro_rules! interface {
    (
        $(#[$attribute:meta])*
        pub struct $group:ident: $causality:ident, $variability:ident $(, $of_all:ident ( $($of_all_value:tt)* ))* {
            $(
                $(#[doc = $text:literal])+
                $($own_variability:ident)? $name:literal $field:ident: $type:ty $([$unit:ident])? $({ $range:expr })? = $start:expr
                    $(, $tail:ident ( $($tail_value:tt)* ))*;
            )+
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, $crate::serde::Serialize, $crate::serde::Deserialize)]
        #[serde(crate = "moris_interface::serde")]
        pub struct $group {
            $( $(#[doc = $text])+ #[doc = concat!(
                "\n\nFMI: `", $name, "`", $(" \\[", $crate::interface!(@unit $unit), "\\]",)? $(", range `", stringify!($range), "`",)?
                ", start value `", stringify!($start), "`."
            )] pub $field: $type, )+
        }

        impl Default for $group {
            fn default() -> Self {
                <Self as $crate::Group>::START
            }
        }

        impl $crate::Group for $group {
            const ROWS: &'static [$crate::Row] = &{
                let mut rows = [$( $crate::Row::new(
                    $name,
                    $crate::Causality::$causality,
                    $crate::interface!(@variability $variability $($own_variability)?),
                    <$type as $crate::Field>::KIND $(.in_unit(&$unit))?,
                    <$type as $crate::Field>::COUNT,
                    <$type as $crate::Field>::COMPONENTS,
                    $crate::interface!(@range $($range)?),
                    concat!($($text),+),
                )$(.$tail($($tail_value)*))*, )+];
                let mut n = 0;
                #[allow(clippy::self_assignment)] // where the struct has no tail
                while n < rows.len() {
                    rows[n] = rows[n]$(.$of_all($($of_all_value)*))*;
                    n += 1;
                }
                rows
            };
            const SLOTS: &'static [$crate::Slot] =
                &$crate::slot_table::<{ $crate::slot_count(<$group as $crate::Group>::ROWS) }>(Self::ROWS);
            const START: Self = $group { $( $field: $start, )+ };
            #[inline]
            fn read(reader: &mut $crate::Reader) -> Self {
                let mut reader = reader.part(const { $crate::slot_count(Self::ROWS) });
                $group { $( $field: reader.take(), )+ }
            }
            #[inline]
            fn write(&self, writer: &mut $crate::Writer) {
                let mut writer = writer.part(const { $crate::slot_count(Self::ROWS) });
                $( writer.put(self.$field); )+
            }
            fn check_ranges(&self) -> Result<(), $crate::ParameterError> {
                let mut rows = Self::ROWS.iter();
                $(
                    let row = rows.next().expect("a struct has a row for each of its fields");
                    if !$crate::Field::is_within(self.$field, row.bounds()) {
                        return Err(row.range_error(self.$field));
                    }
                )+
                Ok(())
            }
            #[inline]
            fn sanitized(&self) -> Self {
                let usable = true $( & $crate::Field::is_within(self.$field, $crate::interface!(@bounds $($range)?)) )+;
                if usable { *self } else { self.forced_into_ranges() }
            }
            #[cold]
            fn forced_into_ranges(&self) -> Self {
                $group {
                    $( $field: $crate::Field::sanitized(
                        self.$field,
                        Self::START.$field,
                        $crate::interface!(@bounds $($range)?),
                    ), )+
                }
            }
        }
    };
    (@variability $of_group:ident) => { $crate::Variability::$of_group };
    (@variability $of_group:ident $own:ident) => { $crate::Variability::$own };
    // The unit's name as a literal, for the documentation.
    (@unit M) => { "m" };
    (@unit M_PER_S) => { "m/s" };
    (@unit M_PER_S2) => { "m/s2" };
    (@unit RAD) => { "rad" };
    (@unit RAD_PER_S) => { "rad/s" };
    (@unit RAD_PER_S2) => { "rad/s2" };
    (@unit ANGULAR_FREQUENCY) => { "rad/s" };
    (@unit S) => { "s" };
    (@unit M2) => { "m2" };
    (@unit PER_RAD) => { "1/rad" };
    (@unit PER_M) => { "1/m" };
    (@unit KG) => { "kg" };
    (@unit KG_M2) => { "kg.m2" };
    (@unit KG_PER_M3) => { "kg/m3" };
    (@unit N) => { "N" };
    (@unit N_M) => { "N.m" };
    (@unit N_PER_M) => { "N/m" };
    (@unit N_S_PER_M) => { "N.s/m" };
    (@unit N_M_S_PER_RAD) => { "N.m.s/rad" };
    (@unit W) => { "W" };
    (@unit $other:ident) => { stringify!($other) };
    (@range) => { None };
    (@range $range:expr) => { Some($crate::interface!(@bounds $range)) };
    (@bounds) => { (f64::MIN, f64::MAX) };
    (@bounds $range:expr) => {
        // For integers and reals.
        const { (*($range).start() as f64, *($range).end() as f64) }
    };
}

/// Declares a struct of groups, which is itself a group. Its rows are the rows of
/// its groups, in order.
#[macro_export]
macro_rules! interface_tree {
    (
        $(#[$attribute:meta])*
        pub struct $group:ident {
            $( $(#[$field_attribute:meta])* $field:ident: $type:ty, )+
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, $crate::serde::Serialize, $crate::serde::Deserialize)]
        #[serde(crate = "moris_interface::serde")]
        pub struct $group {
            $( $(#[$field_attribute])* pub $field: $type, )+
        }

        impl Default for $group {
            fn default() -> Self {
                <Self as $crate::Group>::START
            }
        }

        impl $crate::Group for $group {
            const ROWS: &'static [$crate::Row] = {
                const GROUPS: &[&[$crate::Row]] = &[ $( <$type as $crate::Group>::ROWS ),+ ];
                const ROWS: [$crate::Row; $crate::row_count(GROUPS)] = $crate::concat_rows(GROUPS);
                &ROWS
            };
            const SLOTS: &'static [$crate::Slot] =
                &$crate::slot_table::<{ $crate::slot_count(<$group as $crate::Group>::ROWS) }>(Self::ROWS);
            const START: Self = $group { $( $field: <$type as $crate::Group>::START, )+ };
            fn read(reader: &mut $crate::Reader) -> Self {
                $group { $( $field: $crate::Group::read(reader), )+ }
            }
            fn write(&self, writer: &mut $crate::Writer) {
                $( $crate::Group::write(&self.$field, writer); )+
            }
            fn check_ranges(&self) -> Result<(), $crate::ParameterError> {
                $( $crate::Group::check_ranges(&self.$field)?; )+
                Ok(())
            }
            fn sanitized(&self) -> Self {
                $group { $( $field: $crate::Group::sanitized(&self.$field), )+ }
            }
            fn forced_into_ranges(&self) -> Self {
                $group { $( $field: $crate::Group::forced_into_ranges(&self.$field), )+ }
            }
        }
    };
}

/// Declares `Variables`, the tree of a model's groups: time, inputs, outputs and parameters.
///
/// ```
/// use moris_interface::{Group, interface, variables};
/// interface! {
///     /// The signal.
///     pub struct Input: Input, Continuous {
///         /// A length.
///         "u" u: f64 = 0.0;
///     }
/// }
/// interface! {
///     /// The result.
///     pub struct Output: Output, Continuous {
///         /// A length.
///         "y" y: f64 = 0.0;
///     }
/// }
/// interface! {
///     /// Parameters.
///     pub struct Parameters: Parameter, Fixed {
///         /// A ratio.
///         "gain" gain: f64 = 1.0;
///     }
/// }
/// variables!(Input, Output, Parameters);
/// let names: Vec<_> = Variables::ROWS.iter().map(|row| row.name).collect();
/// assert_eq!(names, ["time", "u", "y", "gain"]);
/// ```
#[macro_export]
macro_rules! variables {
    ($input:ty, $output:ty, $parameters:ty) => {
        $crate::interface_tree! {
            /// All variables.
            pub struct Variables {
                time: $crate::Time,
                input: $input,
                output: $output,
                parameters: $parameters,
            }
        }
    };
}

/// Declares an enumeration that a field may have; FMI counts its items from 1.
#[macro_export]
macro_rules! enumeration {
    (
        $(#[doc = $text:literal])+
        pub enum $name:ident {
            $( $(#[doc = $item_text:literal])+ $item_name:literal $item:ident, )+
        }
    ) => {
        $(#[doc = $text])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, $crate::serde::Serialize, $crate::serde::Deserialize)]
        #[serde(crate = "moris_interface::serde")]
        pub enum $name {
            $( $(#[doc = $item_text])+ #[doc = concat!("\n\nFMI: `", $item_name, "`.")] $item, )+
        }

        impl $name {
            /// All items, in the order of their numbers.
            pub const ALL: &[$name] = &[ $( $name::$item, )+ ];

            /// The item's name.
            pub const fn name(self) -> &'static str {
                match self { $( $name::$item => $item_name, )+ }
            }

            /// The item's description.
            pub const fn text(self) -> &'static str {
                match self { $( $name::$item => concat!($($item_text),+).trim_ascii(), )+ }
            }
        }

        impl $crate::Field for $name {
            const KIND: $crate::Kind = $crate::Kind::Enumeration(&$crate::Enumeration {
                name: stringify!($name),
                text: concat!($($text),+),
                items: &[ $( $crate::Item { name: $item_name, text: concat!($($item_text),+) }, )+ ],
            });
            fn read(slots: &[f64]) -> Self {
                let last = $name::ALL.len() - 1;
                $name::ALL[(slots[0] as usize).saturating_sub(1).min(last)]
            }
            fn write(self, slots: &mut [f64]) {
                slots[0] = f64::from(self as i32 + 1);
            }
        }
    };
}
