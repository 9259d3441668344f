//! Place of the legs at a start: a report of the controller, what the operator has seen, or a slow
//! start.

use moris_live::Legs;
use moris_live::frame::{Encoder, Frames};

/// Time for which a report holds \[s\].
const REPORT_VALIDITY: f64 = 1.0;

/// Words of the operator for the place, beside the options.
pub const PLACE_COMMANDS: &str = "settled, slow";

/// All that is known of the legs' place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LegPosition {
    /// The device goes to the first frame by itself, or has no actuators, or nobody follows.
    is_own: bool,
    /// The place that the operator has given for the next start.
    given: Option<Legs>,
    /// True if the position was given before this session.
    is_given_before: bool,
    /// Time at which the operator was asked to look again \[s\].
    doubted: Option<f64>,
    /// Speed with which the controller goes to its first length by itself \[m/s\].
    slow_speed: Option<f64>,
    /// Length of the actuators' stroke \[m\].
    stroke: f64,
    /// The controller is asked.
    asks: bool,
    /// The last report and its time \[s\].
    report: Option<(f64, [f64; 6])>,
    /// The first report since which the legs have been at rest.
    rest: Option<(f64, [f64; 6])>,
}

impl LegPosition {
    /// A device that goes to the first frame by itself, or frames that nobody follows.
    pub fn own() -> Self {
        LegPosition { is_own: true, ..LegPosition::default() }
    }

    /// The place with a controller that a template describes. The operator may have seen the
    /// platform settled, or may know the speed with which it starts from anywhere.
    pub fn of(template: &Frames, encoder: &Encoder, settled: bool, slow_start: Option<f64>) -> Self {
        LegPosition {
            is_own: !encoder.moves_actuators(),
            given: settled.then_some(Legs::Settled),
            is_given_before: settled,
            slow_speed: slow_start.or(template.slow_start),
            stroke: encoder.stroke_length(),
            asks: encoder.asks(),
            ..LegPosition::default()
        }
    }

    /// True if the legs are at the settled pose at first, as far as the device needs it.
    pub fn starts_settled(&self) -> bool {
        self.is_own
    }

    /// Speed of a leg in a slow start \[m/s\].
    pub fn slow_speed(&self) -> f64 {
        // Speed of a leg in a slow start, without another one [m/s].
        const SLOW_SPEED: f64 = 0.02;
        self.slow_speed.unwrap_or(SLOW_SPEED)
    }

    /// True if a session that engages by itself may begin: the operator or the controller can say
    /// where the legs are.
    pub fn can_start(&self) -> bool {
        self.is_own || self.given.is_some() || self.slow_speed.is_some() || self.asks
    }

    /// True if the controller is to be asked.
    pub fn wants_report(&self) -> bool {
        self.asks && !self.is_own && !self.is_given_before
    }

    /// True if a start by itself at this time \[s\] has nothing to wait for.
    pub fn is_ready(&self, now: f64) -> bool {
        // Time for which a start by itself waits for the first report [s].
        const FIRST_REPORT_TIMEOUT: f64 = 0.5;
        let waits = if self.report.is_some() { !self.is_at_rest() } else { now < FIRST_REPORT_TIMEOUT };
        !self.wants_report() || !waits
    }

    /// True if the reports say that the legs are at rest.
    fn is_at_rest(&self) -> bool {
        // Time for which legs that hardly change must be reported to be at rest [s].
        const AT_REST_TIME: f64 = 0.3;
        // With rounding of the times.
        self.report.zip(self.rest).is_some_and(|((last, _), (first, _))| last - first >= 0.999 * AT_REST_TIME)
    }

    /// True if the operator has given the place for the next start.
    pub fn is_given(&self) -> bool {
        self.given.is_some()
    }

    /// True if the operator or the controller says at this time \[s\] where the legs are.
    pub fn is_known_anew(&self, now: f64) -> bool {
        self.is_given() || self.fresh(now).is_some()
    }

    fn fresh(&self, now: f64) -> Option<[f64; 6]> {
        self.report.filter(|(at, _)| now - at <= REPORT_VALIDITY).map(|(_, lengths)| lengths)
    }

    /// The controller has reported these lengths \[m\].
    pub fn report(&mut self, now: f64, lengths: [f64; 6]) {
        // Change of the legs from which on they are not at rest [m], and as a part of their stroke.
        const AT_REST_DISTANCE: f64 = 0.003;
        const AT_REST_PART: f64 = 0.02;
        let least = AT_REST_DISTANCE.min(AT_REST_PART * self.stroke);
        let moved = |from: &[f64; 6]| lengths.iter().zip(from).any(|(to, from)| (to - from).abs() > least);
        let was_long_ago = self.report.is_some_and(|(at, _)| now - at > REPORT_VALIDITY);
        if was_long_ago || self.rest.is_none_or(|(_, from)| moved(&from)) {
            self.rest = Some((now, lengths));
        }
        self.report = Some((now, lengths));
    }

    /// Sets the place for the next start, as the operator has given it at a time \[s\]. Legs that
    /// the last frames have left `away` \[m\] from their lowest pose are settled if the operator
    /// says so twice: false the first time.
    pub fn give(&mut self, legs: Legs, now: f64, away: f64) -> bool {
        // Way from the last frame to the lowest pose [m], or part of the stroke, from which on the
        // operator is asked to look again, and the time for it [s].
        const RECHECK_DISTANCE: f64 = 0.02;
        const RECHECK_PART: f64 = 0.1;
        const SECOND_LOOK: f64 = 20.0;
        let was_doubted = self.doubted.take().is_some_and(|at| now - at <= SECOND_LOOK);
        let is_away = away > RECHECK_DISTANCE.min(RECHECK_PART * self.stroke);
        if legs == Legs::Settled && is_away && !was_doubted && !self.is_own {
            self.doubted = Some(now);
            return false;
        }
        (self.given, self.is_given_before) = ((!self.is_own).then_some(legs), false);
        true
    }

    /// The controller was lost: what was known before does not hold.
    pub fn forget(&mut self) {
        (self.given, self.report, self.rest) = (None, None, None);
        self.is_given_before = false;
    }

    /// The place for a start at this time \[s\]. A controller that reports knows better than the
    /// operator, whose word holds once.
    pub fn take(&mut self, now: f64) -> Legs {
        if self.is_own {
            return Legs::Settled;
        }
        let legs = match (self.given, self.fresh(now)) {
            (_, Some(lengths)) if self.is_at_rest() => Legs::Reported(lengths),
            (Some(given), None) => given,
            (None, None) if self.slow_speed.is_some() => return Legs::Slow,
            _ => return Legs::Unknown,
        };
        (self.given, self.is_given_before) = (None, false);
        legs
    }

    /// Advice before a start with this stroke \[m\]; none if the place is known.
    pub fn advice(&self, stroke: f64) -> Option<String> {
        let asked = if self.asks { "; the controller is asked for it" } else { "" };
        match (self.is_own, self.given, self.slow_speed) {
            (true, ..) | (_, Some(_), _) => None,
            (_, _, Some(speed)) => Some(format!(
                "the legs' place is unknown{asked}. Without an answer the first lengths are held for {:.0} s: the \
                 controller must go there by itself at {speed} m/s. --settled: the platform is at its lowest pose",
                stroke / speed
            )),
            (_, _, None) => Some(format!(
                "the legs' place is unknown{asked}. Before start, say settled if the platform is at its lowest pose, \
                 or slow if the controller limits its own speed (--settled, --slow-start)"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use moris_live::frame::SHIPPED_FRAMES;
    use moris_live::shipped;
    use moris_washout::Rig;

    use super::*;

    fn of(name: &str, settled: bool, slow_start: Option<f64>) -> LegPosition {
        let template = shipped(SHIPPED_FRAMES, name).unwrap().parse().unwrap();
        LegPosition::of(&template, &Encoder::new(&template, &Rig::default()).unwrap(), settled, slow_start)
    }

    #[test]
    fn a_start_needs_a_report_a_person_or_a_controller_that_is_slow() {
        for name in ["amc-aasd15a", "bff", "motion4sim", "simtools"] {
            let mut place = of(name, false, None);
            assert!(!place.can_start() && place.advice(0.6).unwrap().contains("say settled"), "{name}");
            assert_eq!(place.take(5.0), Legs::Unknown, "{name}");
            assert!(place.give(Legs::Settled, 4.0, 0.0));
            assert_eq!([place.take(5.0), place.take(5.0)], [Legs::Settled, Legs::Unknown], "{name}");
            let mut place = of(name, false, Some(0.05));
            assert!(place.can_start() && place.advice(0.6).unwrap().contains("held for 12 s"), "{name}");
            assert_eq!(place.take(5.0), Legs::Slow, "{name}");
        }
        for name in ["csv", "json"] {
            let mut place = of(name, false, None);
            assert!(place.advice(0.6).unwrap().contains("held for 4 s"), "{name}");
            assert_eq!(place.take(5.0), Legs::Slow, "{name}");
        }
        let mut place = of("vr-pose", false, None);
        assert!(place.starts_settled() && place.advice(0.6).is_none());
        assert_eq!([place.take(0.0), place.take(5.0)], [Legs::Settled; 2]);
    }

    #[test]
    fn a_report_holds_for_a_moment() {
        let mut place = of("csv", false, None);
        assert!(place.wants_report() && !place.is_ready(0.4) && place.is_ready(0.5));
        place.report(0.0, [1.2; 6]);
        place.report(0.3, [1.2; 6]);
        assert!(place.is_ready(0.3));
        assert_eq!([place.take(1.2), place.take(1.4)], [Legs::Reported([1.2; 6]), Legs::Slow]);
        place.report(2.0, [1.2; 6]);
        place.forget();
        assert_eq!(place.take(2.1), Legs::Slow);
        place.give(Legs::Settled, 2.1, 0.0);
        place.forget();
        assert_eq!(place.take(2.2), Legs::Slow);
        let mut place = of("csv", true, None);
        assert!(place.is_given() && !place.wants_report() && place.is_ready(0.0) && place.advice(0.6).is_none());
        assert_eq!([place.take(0.0), place.take(9.0)], [Legs::Settled, Legs::Slow]);
    }

    /// Reports of before a loss say nothing of where the legs are after it.
    #[test]
    fn a_loss_begins_the_reports_anew() {
        let mut place = of("csv", false, None);
        for now in [0.0, 0.3] {
            place.report(now, [1.2; 6]);
        }
        assert_eq!(place.take(0.3), Legs::Reported([1.2; 6]));
        place.forget();
        place.report(0.4, [1.2; 6]);
        assert_eq!(place.take(0.4), Legs::Unknown);
        place.report(0.7, [1.2; 6]);
        assert_eq!(place.take(0.7), Legs::Reported([1.2; 6]));
        // A second after the last one a report goes on, later it begins anew.
        place.report(1.7, [1.2; 6]);
        assert_eq!(place.take(1.7), Legs::Reported([1.2; 6]));
        place.report(2.8, [1.2; 6]);
        assert_eq!(place.take(2.8), Legs::Unknown);
    }

    #[test]
    fn legs_far_from_the_lowest_pose_are_settled_if_a_person_says_so_twice() {
        let mut place = of("simtools", false, None);
        assert!(!place.give(Legs::Settled, 5.0, 0.248) && !place.is_given());
        assert!(place.give(Legs::Settled, 8.0, 0.248) && place.is_given());
        assert_eq!([place.take(9.0), place.take(9.0)], [Legs::Settled, Legs::Unknown]);
        // Neither a word of long ago nor another one is the first of two.
        assert!(!place.give(Legs::Settled, 30.0, 0.248) && !place.give(Legs::Settled, 60.0, 0.248));
        assert!(place.give(Legs::Slow, 61.0, 0.248) && !place.give(Legs::Settled, 62.0, 0.248));
        assert!(place.give(Legs::Settled, 90.0, 0.019) && !place.give(Legs::Settled, 91.0, 0.021));
        // A controller that reports knows better than the operator.
        let mut place = of("csv", false, None);
        place.give(Legs::Settled, 0.0, 0.0);
        assert!(place.wants_report());
        place.report(0.0, [1.3; 6]);
        assert_eq!(place.take(0.1), Legs::Unknown);
        place.report(0.3, [1.3; 6]);
        assert_eq!([place.take(0.4), place.take(9.0)], [Legs::Reported([1.3; 6]), Legs::Slow]);
    }

    #[test]
    fn legs_that_go_down_by_themselves_are_nowhere_until_they_rest() {
        let mut place = of("csv", false, None);
        let length = |k: u32| 1.5 - 0.02 * 0.2 * f64::from(k.min(20));
        for k in 0..24 {
            let now = 0.2 * f64::from(k);
            place.report(now, [length(k); 6]);
            let rests = k >= 22;
            assert_eq!(place.is_ready(now), rests, "{now}");
            assert_eq!(place.take(now), if rests { Legs::Reported([length(k); 6]) } else { Legs::Unknown });
        }
        // One report after a pause says nothing about speed.
        place.report(20.0, [length(30); 6]);
        assert_eq!(place.take(20.0), Legs::Unknown);
    }
}
