//! What another scale would give, for the findings.

/// A scale, and the inverted time with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative {
    /// Factor on the force of surge and sway and on the rates.
    pub factor: f64,
    /// Largest fraction of inverted time of surge and sway.
    pub inverted: f64,
}

/// Other scales at which the cues have the right sign and proportion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advice {
    /// With the same strategy and limits.
    pub scaled: Option<Alternative>,
    /// The same with a preview of so many seconds.
    pub previewed: Option<(f64, Alternative)>,
}

impl Advice {
    /// Clauses of a sentence on inverted time.
    pub(crate) fn clauses(&self) -> String {
        let scaled = self
            .scaled
            .map(|Alternative { factor, inverted }| format!("; at a scale of {factor:.2}: {:.0} %", 100.0 * inverted));
        let previewed = self.previewed.map(|(seconds, Alternative { factor, inverted })| {
            format!("; with a preview of {seconds} s at {factor:.2}: {:.0} %", 100.0 * inverted)
        });
        [scaled, previewed].into_iter().flatten().collect()
    }
}
