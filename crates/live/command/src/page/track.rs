//! Places of the road that is known at first, for the page.

use moris_laps::Laps;

/// Largest number of places kept.
const MAX_TRACK_PLACES: usize = 6000;

/// Places of the road along x and y \[m\]; none where it is interrupted.
pub type Track = Vec<Option<[f64; 2]>>;

/// The latest places of the road that these laps know.
pub fn track(laps: &Laps) -> Track {
    // Distance of the places, at least [m].
    const MIN_PLACE_DISTANCE: f64 = 5.0;
    let mut places = Track::new();
    let mut before: Option<(u32, [f64; 2])> = None;
    for point in laps.points() {
        let [x, y, _] = point.position.map(|number| (10.0 * number).round() / 10.0);
        match before {
            Some((run, _)) if run != point.run => places.push(None),
            Some((_, [last_x, last_y])) if (x - last_x).hypot(y - last_y) < MIN_PLACE_DISTANCE => continue,
            _ => (),
        }
        before = Some((point.run, [x, y]));
        places.push(Some([x, y]));
    }
    places.split_off(places.len().saturating_sub(MAX_TRACK_PLACES))
}

#[cfg(test)]
mod tests {
    use moris_laps::Sample;

    use super::*;

    #[test]
    fn places_are_apart_and_the_latest_ones_are_kept() {
        let mut laps = Laps::new();
        assert_eq!(track(&laps), Track::new());
        for k in 0..32_000 {
            // A jump in the middle.
            let x = f64::from(k) + if k < 16_000 { 0.0 } else { 900.0 };
            laps.step(&Sample { step: 0.05, position: [x, 0.0, 0.0], speed: Some(20.0), force: [0.0; 2] });
        }
        let places = track(&laps);
        assert_eq!((places.len(), places.iter().filter(|place| place.is_none()).count()), (MAX_TRACK_PLACES, 1));
        let last = places.last().copied().flatten().unwrap();
        assert!((32_880.0..32_900.0).contains(&last[0]), "{last:?}");
        assert!(places.windows(2).all(|pair| pair[0].zip(pair[1]).is_none_or(|(one, other)| other[0] - one[0] >= 5.0)));
    }
}
