//! Search variables: logarithms of break frequencies, dampings and scales, and orders.

use cmaes::DVector;
use moris_interface::slots_of;
use moris_washout::Parameters;
use moris_washout::interface::StrategyKind;
use moris_washout::motion::orientation::RollPitchYaw;
use moris_washout::nalgebra::Vector3;

/// A group of parameters that may be tuned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Group {
    /// The splitter's break frequencies and dampings, twelve in all
    Splitter,
    /// The angular channel's, twelve in all
    Angular,
    /// The scales of specific force and angular velocity, six in all
    Scale,
    /// The low-passes on the input and on its rates, for recordings with strong vibration
    Cutoff,
    /// Tilt's limits of rate (to 3 deg/s), acceleration and angle
    Tilt,
    /// Weights, gains and poles of the strategy in use; the classical one has none
    Strategy,
    /// The orders of the splitter's and the angular channel's high-passes, 2 to 4
    Order,
}

impl Group {
    /// All groups, in the order in which they are listed.
    pub const ALL: [Group; 7] =
        [Group::Splitter, Group::Angular, Group::Scale, Group::Cutoff, Group::Tilt, Group::Strategy, Group::Order];

    /// The group's name.
    pub fn name(self) -> &'static str {
        match self {
            Group::Splitter => "splitter",
            Group::Angular => "angular",
            Group::Scale => "scale",
            Group::Cutoff => "cutoff",
            Group::Tilt => "tilt",
            Group::Strategy => "strategy",
            Group::Order => "order",
        }
    }

    /// The group of this name, in letters of any case.
    pub fn named(name: &str) -> Option<Group> {
        Group::ALL.into_iter().find(|group| group.name().eq_ignore_ascii_case(name))
    }
}

/// The orders that may be tuned: of the splitter's high-passes and of the angular channel's.
pub type Orders = [i32; 2];

/// The orders in parameters.
pub fn orders(parameters: &Parameters) -> Orders {
    [parameters.structure.splitter_order, parameters.structure.angular_order]
}

/// The parameters with these orders.
pub fn with_orders(parameters: &Parameters, orders: Orders) -> Parameters {
    let mut parameters = *parameters;
    [parameters.structure.splitter_order, parameters.structure.angular_order] = orders;
    parameters
}

/// Usual break frequencies \[rad/s\].
const FREQUENCIES: Range = Range { role: Role::Frequency, min: 0.05, max: 20.0 };
/// Usual damping ratios.
const DAMPINGS: Range = Range { role: Role::Other, min: 0.3, max: 2.0 };
/// Usual frequencies of the input's low-passes \[rad/s\].
const CUTOFFS: Range = Range { role: Role::Cutoff, min: 5.0, max: 200.0 };
/// Usual scales; one above 1 would exceed the vehicle's motion.
const SCALES: Range = Range { role: Role::Scale, min: 0.01, max: 1.0 };

/// Weights of a strategy's cost, and rates at which gains follow its gradient.
const WEIGHTS: Range = Range { role: Role::Other, min: 1e-5, max: 1e3 };
/// Gains of the adaptive strategy: a fraction of the force as travel, and a tilt rate for it.
const GAINS: Range = Range { role: Role::Other, min: 1e-3, max: 2.0 };
const ATTENUATIONS: Range = Range { role: Role::Other, min: 1.01, max: 10.0 };
const FAST_POLES: Range = Range { role: Role::Other, min: 0.05, max: 100.0 };
const DISTURBANCES: Range = Range { role: Role::Other, min: 1.0, max: 1e4 };
const SPLIT_TIMES: Range = Range { role: Role::Other, min: 0.01, max: 2.0 };

/// Tilt that riders hardly perceive, but not too slow to be of use.
const TILT_RATES: Range = Range { role: Role::Other, min: 0.02, max: 0.053 };
const TILT_ACCELERATIONS: Range = Range { role: Role::Other, min: 0.05, max: 0.5 };
const TILT_ANGLES: Range = Range { role: Role::Other, min: 0.1, max: 0.38 };

/// Use that the search makes of a parameter, whatever its range.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Frequency,
    Cutoff,
    Scale,
    Other,
}

/// Range of a parameter that makes sense for a washout, with the parameter's role.
#[derive(Clone, Copy)]
struct Range {
    role: Role,
    min: f64,
    max: f64,
}

/// Initial value for a parameter that is 0, which has no logarithm. A scale starts at its least
/// value, a low-pass that is off at its highest frequency.
fn instead_of_none(range: Range) -> f64 {
    if range.role == Role::Cutoff { range.max } else { range.min }
}

/// The parameters that are tuned, as a box of logarithms about those that the search starts from.
///
/// A point of the space is a vector of logarithms of the ratios to the start: 0 is the start
/// itself.
#[derive(Clone, Debug)]
pub struct Space {
    start: Parameters,
    groups: Vec<Group>,
    lower: DVector<f64>,
    upper: DVector<f64>,
}

impl Space {
    /// The space about these parameters. If a parameter is outside its usual range, the
    /// range is extended to it.
    pub fn new(start: &Parameters, groups: &[Group]) -> Self {
        let mut start = *start;
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for Tuned { value, range, .. } in tuned(&mut start, groups) {
            if *value <= 0.0 {
                *value = instead_of_none(range);
            }
            lower.push((range.min.min(*value) / *value).ln());
            upper.push((range.max.max(*value) / *value).ln());
        }
        Space { start, groups: groups.to_vec(), lower: lower.into(), upper: upper.into() }
    }

    /// Number of tuned parameters.
    pub fn dimension(&self) -> usize {
        self.lower.len()
    }

    /// The point of the box that is nearest to this one, and how far away it is.
    pub fn clamped(&self, point: &DVector<f64>) -> (DVector<f64>, f64) {
        let inside = point.sup(&self.lower).inf(&self.upper);
        let distance = (point - &inside).norm();
        (inside, distance)
    }

    /// True if scales are tuned.
    pub fn has_scales(&self) -> bool {
        self.groups.contains(&Group::Scale)
    }

    /// The start with all scales that are tuned multiplied by this factor, as far as the box goes.
    pub fn scaled_start(&self, factor: f64) -> DVector<f64> {
        let logarithm = |range: Range| if range.role == Role::Scale { factor.ln() } else { 0.0 };
        let logarithms =
            tuned(&mut self.start.clone(), &self.groups).iter().map(|tuned| logarithm(tuned.range)).collect();
        self.clamped(&DVector::from_vec(logarithms)).0
    }

    /// A point with other frequencies and another scale on one channel, 0 to 5: those of the start
    /// times these factors, as far as the box goes.
    pub fn with_channel(&self, point: &DVector<f64>, channel: usize, frequency: f64, scale: f64) -> DVector<f64> {
        let mut moved = point.clone();
        for (coordinate, tuned) in moved.iter_mut().zip(tuned(&mut self.start.clone(), &self.groups)) {
            if tuned.channel == Some(channel) && tuned.range.role == Role::Frequency {
                *coordinate = frequency.ln();
            } else if tuned.channel == Some(channel) && tuned.range.role == Role::Scale {
                *coordinate = scale.ln();
            }
        }
        self.clamped(&moved).0
    }

    /// A point with other scales of surge, sway and all rates, and other frequencies of surge and
    /// sway. They are those of the start times these factors, as far as the box goes.
    pub fn with_all_channels(&self, point: &DVector<f64>, frequency: f64, scale: f64) -> DVector<f64> {
        let mut moved = point.clone();
        for (coordinate, tuned) in moved.iter_mut().zip(tuned(&mut self.start.clone(), &self.groups)) {
            match (tuned.range.role, tuned.channel) {
                (Role::Scale, Some(0 | 1 | 3..)) => *coordinate = scale.ln(),
                (Role::Frequency, Some(0 | 1)) => *coordinate = frequency.ln(),
                _ => {}
            }
        }
        self.clamped(&moved).0
    }

    /// The spaces in which the order number `k` of [`Orders`] has its other values; none unless
    /// orders are tuned.
    pub fn with_other_order(&self, k: usize) -> Vec<Space> {
        if !self.groups.contains(&Group::Order) {
            return Vec::new();
        }
        let own = orders(&self.start);
        let with = |order: i32| {
            let mut orders = own;
            orders[k] = order;
            Space { start: with_orders(&self.start, orders), ..self.clone() }
        };
        (2..=4).filter(|order| *order != own[k]).map(with).collect()
    }

    /// The parameters at this fraction of the distance from the start to parameters found in this
    /// space, in logarithms. A parameter found to be 0 is 0, and the orders are those found.
    pub fn towards(&self, found: &Parameters, fraction: f64) -> Parameters {
        let mut found = *found;
        let mut parameters = with_orders(&self.start, orders(&found));
        let ends = tuned(&mut found, &self.groups);
        for (Tuned { value, .. }, end) in tuned(&mut parameters, &self.groups).into_iter().zip(ends) {
            let end = *end.value;
            *value = if end > 0.0 { *value * (end / *value).powf(fraction) } else { end };
        }
        parameters
    }

    /// The parameters at a point.
    pub fn parameters(&self, point: &DVector<f64>) -> Parameters {
        let mut parameters = self.start;
        for (tuned, logarithm) in tuned(&mut parameters, &self.groups).into_iter().zip(point) {
            *tuned.value *= logarithm.exp();
        }
        parameters
    }
}

/// Slots of the parameters in these groups that may be tuned, each with the range that makes sense
/// for a washout. Of the strategies, it is the one in use.
pub fn ranges(parameters: &Parameters, groups: &[Group]) -> Vec<(usize, [f64; 2])> {
    let range_of_slot = |index: usize| {
        let mut marked = *parameters;
        let Tuned { value, range, .. } = tuned(&mut marked, groups).swap_remove(index);
        *value = f64::NAN;
        Some((slots_of(&marked).iter().position(|value| value.is_nan())?, [range.min, range.max]))
    };
    (0..tuned(&mut parameters.clone(), groups).len()).filter_map(range_of_slot).collect()
}

/// A tuned parameter.
struct Tuned<'a> {
    value: &'a mut f64,
    range: Range,
    /// Channels 0 to 2 act on the specific force along x, y and z, channels 3 to 5 on roll, pitch
    /// and yaw. None for a parameter that acts on all.
    channel: Option<usize>,
}

/// Every tuned parameter, always in the same order.
fn tuned<'a>(parameters: &'a mut Parameters, groups: &[Group]) -> Vec<Tuned<'a>> {
    let Parameters { structure, splitter, angular, conditioning, tilt, adaptive, optimal, robust, predictive, .. } =
        parameters;
    let mut tuned = Vec::new();
    let mut vector = |values: &'a mut Vector3<f64>, range, channels: std::ops::Range<usize>| {
        let tuned_part = |(value, channel)| Tuned { value, range, channel: Some(channel) };
        let first = channels.start % 3;
        tuned.extend(values.iter_mut().skip(first).zip(channels).map(tuned_part));
    };
    if groups.contains(&Group::Splitter) {
        // The other strategies divide surge and sway without the splitter.
        let first = if structure.strategy == StrategyKind::Classical { 0 } else { 2 };
        vector(&mut splitter.omega1, FREQUENCIES, first..3);
        vector(&mut splitter.zeta1, DAMPINGS, first..3);
        vector(&mut splitter.omega2, FREQUENCIES, first..3);
        vector(&mut splitter.zeta2, DAMPINGS, first..3);
    }
    if groups.contains(&Group::Scale) {
        vector(&mut conditioning.force_scale, SCALES, 0..3);
        vector(&mut conditioning.rate_scale, SCALES, 3..6);
    }
    let mut angles = |RollPitchYaw { roll, pitch, yaw }: &'a mut RollPitchYaw, range| {
        let tuned_part = |(axis, value)| Tuned { value, range, channel: Some(3 + axis) };
        tuned.extend([roll, pitch, yaw].into_iter().enumerate().map(tuned_part));
    };
    if groups.contains(&Group::Angular) {
        angles(&mut angular.omega1, FREQUENCIES);
        angles(&mut angular.zeta1, DAMPINGS);
        angles(&mut angular.omega2, FREQUENCIES);
        angles(&mut angular.zeta2, DAMPINGS);
    }
    let mut of_all = |value, range| tuned.push(Tuned { value, range, channel: None });
    if groups.contains(&Group::Cutoff) {
        of_all(&mut conditioning.cutoff, CUTOFFS);
        of_all(&mut conditioning.rate_cutoff, CUTOFFS);
    }
    if groups.contains(&Group::Tilt) {
        of_all(&mut tilt.rate_limit, TILT_RATES);
        of_all(&mut tilt.acceleration_limit, TILT_ACCELERATIONS);
        of_all(&mut tilt.angle_limit, TILT_ANGLES);
    }
    if groups.contains(&Group::Strategy) {
        match structure.strategy {
            StrategyKind::Classical => {}
            StrategyKind::Adaptive => {
                of_all(&mut adaptive.omega, FREQUENCIES);
                of_all(&mut adaptive.zeta, DAMPINGS);
                of_all(&mut adaptive.gain1, WEIGHTS);
                of_all(&mut adaptive.gain2, WEIGHTS);
                of_all(&mut adaptive.nominal1, GAINS);
                of_all(&mut adaptive.nominal2, GAINS);
                of_all(&mut adaptive.weight_position, WEIGHTS);
                of_all(&mut adaptive.weight_velocity, WEIGHTS);
                of_all(&mut adaptive.weight_tilt_rate, WEIGHTS);
                of_all(&mut adaptive.pull1, WEIGHTS);
                of_all(&mut adaptive.pull2, WEIGHTS);
            }
            StrategyKind::Optimal => {
                of_all(&mut optimal.weight_position, WEIGHTS);
                of_all(&mut optimal.weight_velocity, WEIGHTS);
                of_all(&mut optimal.weight_tilt_rate, WEIGHTS);
                of_all(&mut optimal.weight_tilt_acceleration, WEIGHTS);
                of_all(&mut optimal.slow_pole, FREQUENCIES);
                of_all(&mut optimal.fast_pole, FREQUENCIES);
                of_all(&mut optimal.split_time, SPLIT_TIMES);
            }
            StrategyKind::Robust => {
                of_all(&mut robust.attenuation, ATTENUATIONS);
                of_all(&mut robust.fast_disturbance, DISTURBANCES);
                of_all(&mut robust.weight_position, WEIGHTS);
                of_all(&mut robust.weight_velocity, WEIGHTS);
                of_all(&mut robust.weight_tilt_rate, WEIGHTS);
                of_all(&mut robust.weight_tilt_acceleration, WEIGHTS);
                of_all(&mut robust.slow_pole, FREQUENCIES);
                of_all(&mut robust.fast_pole, FAST_POLES);
                of_all(&mut robust.split_time, SPLIT_TIMES);
            }
            StrategyKind::Predictive => {
                of_all(&mut predictive.weight_position, WEIGHTS);
                of_all(&mut predictive.weight_velocity, WEIGHTS);
                of_all(&mut predictive.weight_tilt_rate, WEIGHTS);
                of_all(&mut predictive.weight_tilt_acceleration, WEIGHTS);
                of_all(&mut predictive.slow_pole, FREQUENCIES);
                of_all(&mut predictive.fast_pole, FREQUENCIES);
            }
        }
    }
    tuned
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEFAULT: [Group; 3] = [Group::Splitter, Group::Angular, Group::Scale];

    /// The default with the strategy that every group has a part in.
    fn classical() -> Parameters {
        let mut classical = Parameters::default();
        classical.structure.strategy = StrategyKind::Classical;
        classical
    }

    #[test]
    fn a_strategy_without_a_splitter_tunes_that_of_heave_alone() {
        let of = |start: &Parameters| Space::new(start, &[Group::Splitter]).dimension();
        assert_eq!((of(&classical()), of(&Parameters::default())), (12, 4));
        let space = Space::new(&Parameters::default(), &[Group::Splitter]);
        let moved = space.parameters(&DVector::from_element(4, 0.1)).splitter;
        let start = Parameters::default().splitter;
        assert!(moved.omega1.z > start.omega1.z && moved.zeta2.z > start.zeta2.z);
        assert_eq!((moved.omega1.xy(), moved.omega2.xy()), (start.omega1.xy(), start.omega2.xy()));
    }

    #[test]
    fn surge_sway_and_rates_have_other_scales_together() {
        let start = classical();
        let space = Space::new(&start, &DEFAULT);
        let moved = space.parameters(&space.with_all_channels(&DVector::zeros(30), 0.5, 0.25));
        let (scales, were) = (moved.conditioning.force_scale, start.conditioning.force_scale);
        assert!((scales.x - 0.25 * were.x).abs() < 1e-12 && (scales.y - 0.25 * were.y).abs() < 1e-12);
        assert_eq!(scales.z, were.z);
        assert!((moved.conditioning.rate_scale - 0.25 * start.conditioning.rate_scale).norm() < 1e-12);
        assert!((moved.splitter.omega1.x - 0.5 * start.splitter.omega1.x).abs() < 1e-12);
        assert_eq!((moved.splitter.omega1.z, moved.angular), (start.splitter.omega1.z, start.angular));
    }

    #[cfg(feature = "clap")]
    #[test]
    fn a_group_has_the_name_of_the_option() {
        for group in <Group as clap::ValueEnum>::value_variants() {
            let option = clap::ValueEnum::to_possible_value(group).unwrap();
            assert_eq!((group.name(), Group::named(&group.name().to_uppercase())), (option.get_name(), Some(*group)));
        }
        assert_eq!(Group::ALL, <Group as clap::ValueEnum>::value_variants());
        assert_eq!(Group::named("gains"), None);
    }

    #[test]
    fn roles_do_not_depend_on_ranges() {
        // With equal ranges a scale still starts low, and a low-pass that is off starts high.
        let scale = Range { role: Role::Scale, ..CUTOFFS };
        assert_eq!([instead_of_none(scale), instead_of_none(CUTOFFS)], [CUTOFFS.min, CUTOFFS.max]);
    }

    #[test]
    fn the_origin_is_the_start() {
        let start = classical();
        let space = Space::new(&start, &DEFAULT);
        assert_eq!(space.dimension(), 30);
        assert_eq!(space.parameters(&DVector::zeros(30)), start);
    }

    #[test]
    fn every_coordinate_moves_one_parameter_and_no_two_the_same() {
        let start = classical();
        let space = Space::new(&start, &DEFAULT);
        let before = moris_setup::all(&start);
        let mut moved = Vec::new();
        for k in 0..space.dimension() {
            let mut point = DVector::zeros(space.dimension());
            point[k] = -0.5;
            let after = moris_setup::all(&space.parameters(&point));
            let changed: Vec<&str> =
                before.iter().zip(&after).filter(|(b, a)| b.1 != a.1).map(|(b, _)| b.0.as_str()).collect();
            assert_eq!(changed.len(), 1, "{changed:?}");
            moved.push(changed[0].to_owned());
        }
        moved.sort();
        moved.dedup();
        assert_eq!(moved.len(), 30);
        assert!(moved.iter().all(|name| ["splitter", "angular", "scale"].contains(&name.split('.').next().unwrap())));
    }

    #[test]
    fn ranges_are_those_of_their_parameters() {
        let start = classical();
        let names: Vec<(String, f64)> = moris_setup::all(&start);
        let found = ranges(&start, &[Group::Scale, Group::Tilt]);
        let named: Vec<(&str, [f64; 2])> =
            found.iter().map(|(slot, range)| (names[*slot].0.as_str(), *range)).collect();
        assert_eq!(named.len(), 9);
        assert_eq!(named[4], ("scale.angularVelocity.y", [SCALES.min, SCALES.max]));
        assert_eq!(named[8], ("tilt.angleLimit", [TILT_ANGLES.min, TILT_ANGLES.max]));
    }

    #[test]
    fn a_fraction_of_the_way_is_by_logarithms_with_the_orders_found() {
        let mut start = classical();
        start.conditioning.rate_scale.x = 0.0;
        let space = Space::new(&start, &DEFAULT);
        let mut found = start;
        found.structure.splitter_order = 2;
        found.splitter.omega1.x *= 4.0;
        found.conditioning.force_scale.y *= 0.25;
        let half = space.towards(&found, 0.5);
        assert!((half.splitter.omega1.x / start.splitter.omega1.x - 2.0).abs() < 1e-12);
        assert!((half.conditioning.force_scale.y / start.conditioning.force_scale.y - 0.5).abs() < 1e-12);
        assert_eq!((half.conditioning.rate_scale.x, half.structure.splitter_order), (0.0, 2));
        let close = |(a, b): (&(String, f64), &(String, f64))| (a.1 - b.1).abs() < 1e-12;
        let all_the_way = moris_setup::all(&space.towards(&found, 1.0));
        assert!(all_the_way.iter().zip(&moris_setup::all(&found)).all(close));
    }

    #[test]
    fn orders_have_their_other_values_where_they_are_tuned() {
        let start = classical();
        assert!((0..2).all(|k| Space::new(&start, &DEFAULT).with_other_order(k).is_empty()));
        let space = Space::new(&start, &[Group::Order, Group::Splitter]);
        let others = |k: usize| {
            let others = space.with_other_order(k);
            others.iter().map(|other| orders(&other.parameters(&DVector::zeros(12)))).collect::<Vec<Orders>>()
        };
        assert_eq!((others(0), others(1)), (vec![[2, 2], [4, 2]], vec![[3, 3], [3, 4]]));
    }

    #[test]
    fn the_strategy_in_use_is_tuned_within_what_it_accepts() {
        for (strategy, prefix, count) in [
            (StrategyKind::Classical, "", 0),
            (StrategyKind::Adaptive, "adaptive.", 11),
            (StrategyKind::Optimal, "optimal.", 7),
            (StrategyKind::Robust, "robust.", 9),
            (StrategyKind::Predictive, "predictive.", 6),
        ] {
            let mut start = classical();
            start.structure.strategy = strategy;
            let space = Space::new(&start, &[Group::Strategy]);
            assert_eq!(space.dimension(), count);
            for sign in [-1.0, 1.0] {
                let (edge, _) = space.clamped(&DVector::from_element(count, 100.0 * sign));
                let moved = space.parameters(&edge);
                assert!(moris_washout::check(&moved).is_ok());
                let changed: Vec<(String, f64)> = moris_setup::all(&moved)
                    .into_iter()
                    .zip(moris_setup::all(&start))
                    .filter_map(|(after, before)| (after.1 != before.1).then_some(after))
                    .collect();
                assert_eq!(changed.len(), count);
                assert!(changed.iter().all(|(name, _)| name.starts_with(prefix)), "{changed:?}");
            }
        }
    }

    #[test]
    fn a_point_outside_comes_back_to_the_edge_where_scales_are_1_and_frequencies_can_be_used() {
        let space = Space::new(&classical(), &DEFAULT);
        for sign in [-1.0, 1.0] {
            let (inside, distance) = space.clamped(&DVector::from_element(30, 100.0 * sign));
            assert!(distance > 100.0);
            let parameters = space.parameters(&inside);
            assert!(moris_washout::check(&parameters).is_ok());
            assert!(parameters.conditioning.force_scale.max() <= 1.0 + 1e-12);
        }
    }

    #[test]
    fn a_scaled_start_has_other_scales_and_nothing_else() {
        let space = Space::new(&classical(), &DEFAULT);
        let scaled = space.parameters(&space.scaled_start(0.5));
        let start = classical().conditioning;
        assert!((scaled.conditioning.force_scale - 0.5 * start.force_scale).amax() < 1e-12);
        assert!((scaled.conditioning.rate_scale - 0.5 * start.rate_scale).amax() < 1e-12);
        assert_eq!((scaled.splitter, scaled.angular), (classical().splitter, classical().angular));
    }

    #[test]
    fn a_channel_has_its_own_frequencies_and_scale() {
        let space = Space::new(&classical(), &DEFAULT);
        let mut expected = classical();
        expected.splitter.omega1.y *= 0.5;
        expected.splitter.omega2.y *= 0.5;
        expected.conditioning.force_scale.y *= 0.2;
        expected.angular.omega1.yaw *= 2.0;
        expected.angular.omega2.yaw *= 2.0;
        let point = space.with_channel(&DVector::zeros(30), 1, 0.5, 0.2);
        let found = space.parameters(&space.with_channel(&point, 5, 2.0, 1.0));
        let close = |(a, b): (&(String, f64), &(String, f64))| (a.1 - b.1).abs() < 1e-12;
        assert!(moris_setup::all(&found).iter().zip(&moris_setup::all(&expected)).all(close));
    }

    #[test]
    fn a_scale_of_nothing_is_begun_at_next_to_nothing_and_a_low_pass_that_is_off_far_up() {
        let mut start = classical();
        start.conditioning.rate_scale.x = 0.0;
        let space = Space::new(&start, &[Group::Scale, Group::Cutoff]);
        assert_eq!(space.dimension(), 8);
        let conditioning = space.parameters(&DVector::zeros(8)).conditioning;
        assert_eq!((conditioning.rate_scale.x, conditioning.cutoff), (0.01, 200.0));
    }
}
