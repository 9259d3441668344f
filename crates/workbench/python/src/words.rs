//! Remedies in Python's words: as arguments.

use moris_analysis::message::Remedy;

/// A remedy as an argument: `force_unit="g"`.
pub fn argument(Remedy { option, value }: &Remedy) -> String {
    let name = match *option {
        "tune" => "groups".to_owned(),
        option => option.replace('-', "_"),
    };
    let Some(value) = value else { return name };
    match *option {
        "columns" => format!("{name}={}", column_dictionary(value)),
        "tune" => {
            format!("{name}=[{}]", value.split(',').map(|group| format!("\"{group}\"")).collect::<Vec<_>>().join(", "))
        }
        "mounting" if value.contains(',') => format!("{name}=[{value}]"),
        "repair" => format!("{name}={value}"),
        _ if value.parse::<f64>().is_ok() => format!("{name}={value}"),
        _ => format!("{name}=\"{value}\""),
    }
}

/// `ax=NAME,ay=NAME` as a dictionary.
fn column_dictionary(columns: &str) -> String {
    // A command line has quotation marks around names with blanks.
    let pairs = columns.split(',').filter_map(|pair| pair.trim_matches('"').split_once('='));
    let pairs: Vec<String> = pairs.map(|(key, name)| format!("\"{key}\": \"{name}\"")).collect();
    format!("{{{}}}", pairs.join(", "))
}
