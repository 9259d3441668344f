//! Spans of time in which a limit was active.

use moris_washout::Output;

use crate::Simulation;

/// The spans of a simulation in which a flag was set.
#[derive(Clone, Debug, PartialEq)]
pub struct Spans {
    /// Begin and end of each \[s\].
    spans: Vec<[f64; 2]>,
    /// Time with the flag, without gaps within spans \[s\].
    pub total: f64,
}

impl Spans {
    /// The spans in which `is_active` holds of the outputs. Each output tells of the step before
    /// it.
    pub fn of(simulation: &Simulation, is_active: impl Fn(&Output) -> bool) -> Self {
        // Spans closer to each other than this are one [s].
        const MAX_JOINED_GAP: f64 = 0.1;
        let step = simulation.step;
        let mut spans: Vec<[f64; 2]> = Vec::new();
        let mut count = 0;
        for (index, _) in simulation.outputs.iter().enumerate().skip(1).filter(|(_, output)| is_active(output)) {
            count += 1;
            let [begin, end] = [index - 1, index].map(|index| index as f64 * step);
            match spans.last_mut() {
                Some([_, last]) if begin - *last <= MAX_JOINED_GAP => *last = end,
                _ => spans.push([begin, end]),
            }
        }
        Spans { spans, total: count as f64 * step }
    }

    /// Number of spans.
    pub fn count(&self) -> usize {
        self.spans.len()
    }

    /// Begin and end of the first \[s\]; none without any.
    pub fn first(&self) -> Option<[f64; 2]> {
        self.spans.first().copied()
    }

    /// Begin and end of the longest, the first of equal ones \[s\]; none without any.
    pub fn longest(&self) -> Option<[f64; 2]> {
        let longer = |longest: [f64; 2], span: [f64; 2]| {
            if span[1] - span[0] > longest[1] - longest[0] { span } else { longest }
        };
        self.spans.iter().copied().reduce(longer)
    }
}

#[cfg(test)]
mod tests {
    use moris_washout::{Input, Parameters};

    use super::*;

    #[test]
    fn spans_join_over_short_gaps_and_begin_with_the_step() {
        let flagged = [3, 4, 5, 9, 30, 31, 60];
        let outputs: Vec<Output> = (0..=80)
            .map(|index| Output { soft_limited: index == 0 || flagged.contains(&index), ..Output::default() })
            .collect();
        let simulation = Simulation {
            step: 0.02,
            parameters: Parameters::default(),
            inputs: vec![Input::default(); outputs.len()].into(),
            outputs,
            felt_within_steps: Vec::new(),
            foreign: None,
        };
        let spans = Spans::of(&simulation, |output| output.soft_limited);
        // 5 and 9 have 60 ms between them. The first output belongs to no step.
        assert_eq!(spans.count(), 3);
        assert!((spans.total - 0.14).abs() < 1e-12, "{}", spans.total);
        let near = |found: [f64; 2], expected: [f64; 2]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(spans.first().unwrap(), [0.04, 0.18]) && near(spans.longest().unwrap(), [0.04, 0.18]));
        let late = Spans { spans: vec![[0.0, 0.1], [1.0, 1.5], [2.0, 2.5]], total: 0.6 };
        assert_eq!((late.first(), late.longest()), (Some([0.0, 0.1]), Some([1.0, 1.5])));
        let none = Spans::of(&simulation, |output| output.safety_active);
        assert_eq!((none.count(), none.first(), none.longest(), none.total), (0, None, None, 0.0));
    }
}
