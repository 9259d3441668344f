//! Reports of a controller.

use serde::Deserialize;

#[derive(Deserialize)]
struct Report {
    legs: [f64; 6],
}

/// The legs' lengths \[m\] in the answer of a controller: the word `legs` and six numbers between
/// commas, or an object with a list `legs`. None in other packets.
pub fn reported(answer: &[u8]) -> Option<[f64; 6]> {
    let text = str::from_utf8(answer).ok()?.trim();
    let Some(list) = text.strip_prefix("legs,") else {
        return serde_json::from_str(text).ok().map(|Report { legs }| legs);
    };
    let mut fields = list.split(',');
    let mut lengths = [0.0; 6];
    for length in &mut lengths {
        *length = fields.next()?.trim().parse().ok()?;
    }
    fields.next().is_none().then_some(lengths)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_from_both_forms_and_from_nothing_else() {
        let expected = Some([1.1, 1.2, 1.3, 1.4, 1.5, 1.6]);
        assert_eq!(reported(b"legs,1.1, 1.2,1.3,1.4,1.5,1.6\n"), expected);
        assert_eq!(reported(b"{\"legs\":[1.1,1.2,1.3,1.4,1.5,1.6]}\n"), expected);
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
            assert_eq!(reported(wrong), None, "{wrong:?}");
        }
    }
}
