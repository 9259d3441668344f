//! Reports of a controller.

use serde_json::Value;

use super::motors::MOTOR_UNITS;

/// Six numbers of a report, and their place in [`MOTOR_UNITS`]; none for lengths \[m\].
pub type Report = (Option<usize>, [f64; 6]);

/// The numbers in the answer of a controller: the word `legs` or one of [`MOTOR_UNITS`] and six
/// numbers between commas, or an object with a list of that name. None in other packets.
pub fn report(answer: &[u8]) -> Option<Report> {
    let text = str::from_utf8(answer).ok()?.trim();
    let names = std::iter::once((None, "legs")).chain((0..).map(Some).zip(MOTOR_UNITS));
    let listed = |list: &str| {
        let numbers: Option<Vec<f64>> = list.split(',').map(|number| number.trim().parse().ok()).collect();
        numbers?.try_into().ok()
    };
    let object: Option<Value> = serde_json::from_str(text).ok();
    for (unit, name) in names {
        let numbers = match &object {
            Some(object) => object.get(name).and_then(|list| serde_json::from_value(list.clone()).ok()),
            None => text.strip_prefix(name).and_then(|rest| listed(rest.strip_prefix(',')?)),
        };
        if let Some(numbers) = numbers {
            return Some((unit, numbers));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_from_both_forms_and_from_nothing_else() {
        let numbers = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6];
        for (unit, name) in [(None, "legs"), (Some(1), "degrees"), (Some(3), "steps")] {
            let expected = Some((unit, numbers));
            assert_eq!(report(format!("{name},1.1, 1.2,1.3,1.4,1.5,1.6\n").as_bytes()), expected);
            assert_eq!(report(format!("{{\"{name}\":[1.1,1.2,1.3,1.4,1.5,1.6]}}\n").as_bytes()), expected);
        }
        for wrong in [
            &b""[..],
            b"legs?\n",
            b"legs,1,1,1,1,1",
            b"legs,1,1,1,1,1,1,1",
            b"legs,1,1,1,x,1,1",
            b"{\"legs\":[1,1,1,1,1]}",
            b"{\"arms\":[1,1,1,1,1,1]}",
            b"\xFF\xFE",
        ] {
            assert_eq!(report(wrong), None, "{wrong:?}");
        }
    }
}
