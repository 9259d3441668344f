//! The shipped rigs, by name.

/// The rig files of these names.
macro_rules! rigs {
    ($($name:literal)*) => {
        [$( ($name, include_str!(concat!("../../../examples/rigs/", $name, ".toml"))), )*]
    };
}

/// The texts of the rig files that are shipped, by the names that users write: legs
/// by stroke, then cranks.
pub const SHIPPED_RIGS: [(&str, &str); 17] = rigs! {
    "hobby100" "hobby150" "hobby200" "diy283" "compact" "dim330" "moog-like450" "narrow" "default" "flight091" "flight125"
    "long-stroke" "crank-servo" "crank-person" "crank-hobby20" "crank-hobby25" "crank-stepper50"
};
