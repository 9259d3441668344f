//! Search variables: orders, and logarithms of the parameters whose rows have a group and a usual
//! range.

use cmaes::DVector;
use moris_interface::{Group as _, Kind, Reader, Row, slots_of};
use moris_washout::Parameters;
use moris_washout::interface::TuningGroup;

use super::cost::{Channels, Objective, still_channels};

/// The group of this name, in letters of any case.
pub fn group_named(name: &str) -> Option<TuningGroup> {
    TuningGroup::ALL.iter().copied().find(|group| group.name().eq_ignore_ascii_case(name))
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

/// A tuned parameter.
#[derive(Clone, Copy, Debug)]
struct Tuned {
    slot: usize,
    row: &'static Row,
    /// Channels 0 to 2 act on the specific force along x, y and z, channels 3 to 5 on roll, pitch
    /// and yaw. None for a parameter that acts on all.
    channel: Option<usize>,
    /// The usual range.
    range: (f64, f64),
}

impl Tuned {
    fn is_in(&self, group: TuningGroup) -> bool {
        self.row.tuning_group == Some(group.name())
    }

    /// True for a frequency of one channel.
    fn is_frequency(&self) -> bool {
        matches!(self.row.kind, Kind::Real(unit) if unit.quantity == "AngularFrequency") && self.channel.is_some()
    }

    /// Initial value in place of 0, which has no logarithm. A scale starts at its least value, a
    /// low-pass that is off at its highest frequency.
    fn instead_of_none(&self) -> f64 {
        if self.is_in(TuningGroup::Cutoff) { self.range.1 } else { self.range.0 }
    }
}

/// The parameters of these groups that have an effect with this strategy. Splitter and scales come
/// first: the order decides what a seed finds.
fn tuned_parameters(parameters: &Parameters, groups: &[TuningGroup]) -> Vec<Tuned> {
    let strategy = parameters.structure.strategy.name();
    let has_effect = |row: &Row, element| {
        row.conditions(element).all(|needed| needed.variable != "strategy" || needed.values.contains(&strategy))
    };
    let mut tuned: Vec<Tuned> = Parameters::SLOTS
        .iter()
        .enumerate()
        .map(|(slot, at)| (slot, &Parameters::ROWS[usize::from(at.row)], usize::from(at.element)))
        .filter(|&(_, row, element)| has_effect(row, element))
        .filter_map(|(slot, row, element)| {
            Some(Tuned { slot, row, channel: scalar_channel(row, element), range: row.usual? })
        })
        .filter(|tuned| groups.iter().any(|group| tuned.is_in(*group)))
        .collect();
    tuned.sort_by_key(|tuned| !(tuned.is_in(TuningGroup::Splitter) || tuned.is_in(TuningGroup::Scale)));
    tuned
}

/// The channel that a row's scalar acts on.
fn scalar_channel(row: &Row, element: usize) -> Option<usize> {
    let is_of_rates = row.name.starts_with("angular.") || row.name.starts_with("scale.angularVelocity.");
    (row.slots() == 3).then_some(if is_of_rates { 3 + element } else { element })
}

/// The parameters that are tuned, as a box of logarithms about those that the search starts from.
///
/// A point of the space is a vector of logarithms of the ratios to the start: 0 is the start
/// itself.
#[derive(Clone, Debug)]
pub struct Space {
    start: Parameters,
    tuned: Vec<Tuned>,
    has_orders: bool,
    lower: DVector<f64>,
    upper: DVector<f64>,
}

impl Space {
    /// The space about these parameters. If a parameter is outside its usual range, the
    /// range is extended to it.
    pub fn new(start: &Parameters, groups: &[TuningGroup]) -> Self {
        let tuned = tuned_parameters(start, groups);
        let mut slots = slots_of(start);
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for one in &tuned {
            let (value, (least, greatest)) = (&mut slots[one.slot], one.range);
            if *value <= 0.0 {
                *value = one.instead_of_none();
            }
            lower.push((least.min(*value) / *value).ln());
            upper.push((greatest.max(*value) / *value).ln());
        }
        let has_orders = groups.contains(&TuningGroup::Order);
        Space {
            start: Parameters::read(&mut Reader::new(&slots)),
            tuned,
            has_orders,
            lower: lower.into(),
            upper: upper.into(),
        }
    }

    /// The space of a search on these recordings: parameters of channels on which none of them
    /// desires a motion stay as they are, as far as others remain.
    pub fn of_recordings(start: &Parameters, groups: &[TuningGroup], tuned_on: &[Objective]) -> Self {
        Space::new(start, groups).without_channels(still_channels(tuned_on.iter().map(Objective::desired_rms)))
    }

    fn without_channels(self, is_still: Channels<bool>) -> Self {
        let is_kept = |k: &usize| self.tuned[*k].channel.is_none_or(|channel| !is_still[channel]);
        let kept: Vec<usize> = (0..self.tuned.len()).filter(is_kept).collect();
        if kept.is_empty() {
            return self;
        }
        let bounds = |all: &DVector<f64>| DVector::from_iterator(kept.len(), kept.iter().map(|&k| all[k]));
        let (lower, upper) = (bounds(&self.lower), bounds(&self.upper));
        Space { tuned: kept.iter().map(|&k| self.tuned[k]).collect(), lower, upper, ..self }
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
        self.tuned.iter().any(|tuned| tuned.is_in(TuningGroup::Scale))
    }

    /// The start with all scales that are tuned multiplied by this factor, as far as the box goes.
    pub fn scaled_start(&self, factor: f64) -> DVector<f64> {
        self.moved(&DVector::zeros(self.dimension()), |tuned| tuned.is_in(TuningGroup::Scale).then_some(factor))
    }

    /// A point with other frequencies and another scale on one channel, 0 to 5: those of the start
    /// times these factors, as far as the box goes.
    pub fn with_channel(&self, point: &DVector<f64>, channel: usize, frequency: f64, scale: f64) -> DVector<f64> {
        self.moved(point, |tuned| match tuned.channel {
            Some(of) if of != channel => None,
            Some(_) if tuned.is_frequency() => Some(frequency),
            Some(_) if tuned.is_in(TuningGroup::Scale) => Some(scale),
            _ => None,
        })
    }

    /// A point with other scales of surge, sway and all rates, and other frequencies of surge and
    /// sway. All are those of the start times these factors, as far as the box goes.
    pub fn with_all_channels(&self, point: &DVector<f64>, frequency: f64, scale: f64) -> DVector<f64> {
        self.moved(point, |tuned| match tuned.channel {
            Some(0 | 1 | 3..) if tuned.is_in(TuningGroup::Scale) => Some(scale),
            Some(0 | 1) if tuned.is_frequency() => Some(frequency),
            _ => None,
        })
    }

    /// A point with other coordinates where `factor` gives the ratio to the start, as far as the
    /// box goes.
    fn moved(&self, point: &DVector<f64>, factor: impl Fn(&Tuned) -> Option<f64>) -> DVector<f64> {
        let coordinates = point.iter().zip(&self.tuned);
        let moved = coordinates.map(|(coordinate, tuned)| factor(tuned).map_or(*coordinate, f64::ln));
        self.clamped(&DVector::from_iterator(point.len(), moved)).0
    }

    /// The spaces in which the order number `k` of [`Orders`] has its other values; none unless
    /// orders are tuned.
    pub fn with_other_order(&self, k: usize) -> Vec<Space> {
        if !self.has_orders {
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
        let (ends, start) = (slots_of(found), with_orders(&self.start, orders(found)));
        self.changed(&start, |k, value| {
            let end = ends[self.tuned[k].slot];
            if end > 0.0 { value * (end / value).powf(fraction) } else { end }
        })
    }

    /// The parameters with all scales that are tuned times a factor.
    pub fn with_scales_times(&self, parameters: &Parameters, factor: f64) -> Parameters {
        self.changed(parameters, |k, value| value * if self.tuned[k].is_in(TuningGroup::Scale) { factor } else { 1.0 })
    }

    /// The parameters at a point.
    pub fn parameters(&self, point: &DVector<f64>) -> Parameters {
        self.changed(&self.start, |k, value| value * point[k].exp())
    }

    /// Parameters with other tuned values. `value` receives the number of each and its value.
    fn changed(&self, parameters: &Parameters, value: impl Fn(usize, f64) -> f64) -> Parameters {
        let mut slots = slots_of(parameters);
        for (k, tuned) in self.tuned.iter().enumerate() {
            slots[tuned.slot] = value(k, slots[tuned.slot]);
        }
        Parameters::read(&mut Reader::new(&slots))
    }
}

#[cfg(test)]
mod tests {
    use moris_washout::interface::StrategyKind;

    use super::*;

    const DEFAULT: [TuningGroup; 3] = [TuningGroup::Splitter, TuningGroup::Angular, TuningGroup::Scale];

    /// The default with the strategy that every group has a part in.
    fn classical() -> Parameters {
        let mut classical = Parameters::default();
        classical.structure.strategy = StrategyKind::Classical;
        classical
    }

    #[test]
    fn a_strategy_without_a_splitter_tunes_that_of_heave_alone() {
        let of = |start: &Parameters| Space::new(start, &[TuningGroup::Splitter]).dimension();
        assert_eq!((of(&classical()), of(&Parameters::default())), (12, 4));
        let space = Space::new(&Parameters::default(), &[TuningGroup::Splitter]);
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

    #[test]
    fn channels_on_which_nothing_is_desired_stay_as_they_are() {
        let start = classical();
        let still = still_channels([[2.0, 0.0, 0.05, 0.3, 0.0, 0.0], [0.0, 0.09, 0.0, 0.0, 0.0, 0.0]].iter());
        assert_eq!(still, [false, true, true, false, true, true]);
        let space = Space::new(&start, &DEFAULT).without_channels(still);
        let moved = space.parameters(&DVector::from_element(space.dimension(), -0.5));
        let changed = moris_setup::differing(&moved, &start);
        // Four filter parameters and a scale of surge and of the roll rate.
        assert_eq!((space.dimension(), changed.len()), (10, 10));
        let is_kept = |name: &str| [".x.", ".roll."].iter().any(|part| name.contains(part)) || name.ends_with(".x");
        assert!(changed.iter().all(|(name, _)| is_kept(name)), "{changed:?}");
        let scaled = moris_setup::differing(&space.with_scales_times(&start, 0.5), &start);
        let names: Vec<&str> = scaled.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["scale.specificForce.x", "scale.angularVelocity.x"]);
        assert_eq!(Space::new(&start, &DEFAULT).without_channels([true; 6]).dimension(), 30);
    }

    #[test]
    fn a_groups_name_may_have_capitals_and_others_are_none() {
        assert_eq!(group_named("Splitter"), Some(TuningGroup::Splitter));
        assert_eq!(group_named("gains"), None);
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
    fn each_channel_has_its_frequencies_and_its_scale() {
        let of = |channel| {
            let of_channel = |tuned: &&Tuned| tuned.channel == Some(channel);
            let names = |tuned: &Tuned| Parameters::ROWS[usize::from(Parameters::SLOTS[tuned.slot].row)].name;
            tuned_parameters(&classical(), TuningGroup::ALL).iter().filter(of_channel).map(names).collect::<Vec<_>>()
        };
        let [filter, scale] = [["omega1", "zeta1", "omega2", "zeta2"], ["specificForce", "angularVelocity", "", ""]];
        let splitter =
            [&filter.map(|name| format!("splitter.@.{name}"))[..], &[format!("scale.{}.@", scale[0])]].concat();
        assert_eq!([of(0), of(1), of(2)], [(); 3].map(|()| splitter.clone()));
        let angular =
            [&[format!("scale.{}.@", scale[1])], &filter.map(|name| format!("angular.@.{name}"))[..]].concat();
        assert_eq!([of(3), of(4), of(5)], [(); 3].map(|()| angular.clone()));
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
        let space = Space::new(&start, &[TuningGroup::Order, TuningGroup::Splitter]);
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
            let space = Space::new(&start, &[TuningGroup::Strategy]);
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
        let space = Space::new(&start, &[TuningGroup::Scale, TuningGroup::Cutoff]);
        assert_eq!(space.dimension(), 8);
        let conditioning = space.parameters(&DVector::zeros(8)).conditioning;
        assert_eq!((conditioning.rate_scale.x, conditioning.cutoff), (0.01, 200.0));
    }
}
