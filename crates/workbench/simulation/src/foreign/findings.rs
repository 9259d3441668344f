//! Findings on a foreign motion: its limits, and what is wrong with what was given.

use crate::measures::Row;

use super::Foreign;
use crate::findings::stroke_used;
use crate::spans::Spans;
use crate::{Evaluated, Finding, Weight, sentence};

impl Foreign {
    /// Fit to the rig, and what was given.
    pub(crate) fn findings(&self, outcome: &Evaluated, is_good: bool) -> Vec<Finding> {
        let finding = |weight, text: String| Finding { weight, text };
        let mut findings = vec![self.fit(outcome, is_good)];
        findings.extend(self.suspicions.iter().map(|text| finding(Weight::Warning, text.clone())));
        findings.extend(self.notes.iter().map(|text| finding(Weight::Note, text.clone())));
        if !self.has_rate {
            findings.push(finding(Weight::Note, sentence!["no-felt-rate"]));
        }
        findings
    }

    fn fit(&self, outcome: &Evaluated, is_good: bool) -> Finding {
        if !self.has_legs {
            return Finding { weight: Weight::Note, text: sentence!["no-legs"] };
        }
        let spans = Spans::of(outcome.simulation, |output| output.actuator_limited);
        if let Some([first, _]) = spans.first() {
            let worst = self.excesses.join(", ");
            let text = sentence!["motion-exceeds", total = spans.total, first, worst];
            return Finding { weight: Weight::Warning, text };
        }
        let text = sentence!["motion-fits", used = stroke_used(outcome)];
        Finding { weight: if is_good { Weight::Good } else { Weight::Note }, text }
    }

    /// The rows without values that are not known.
    pub(crate) fn known(&self, row: Row) -> Row {
        // Measures that need the washout itself: what of a tilt is coordination, and which of its
        // own limits acted.
        const OF_THE_WASHOUT: [&str; 4] =
            ["largest tilt rate", "tilt limited", "soft limits active", "safety units active"];
        let is_of_rates = row.subject.contains("angular velocity");
        let is_of_platform = row.subject == "platform";
        let is_unknown =
            is_of_rates && !self.has_rate || is_of_platform && (!self.has_legs || OF_THE_WASHOUT.contains(&row.name));
        if is_unknown { Row { value: None, ..row } } else { row }
    }
}
