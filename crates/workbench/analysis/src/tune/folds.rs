//! Which recordings are left out together.

/// Divides `count` recordings into `folds` groups of as equal size as can be: every recording is in
/// exactly one. Neighbours are in different groups, for they are often alike. One recording cannot
/// be left out of itself: there are no groups then.
pub fn folds(count: usize, folds: usize) -> Vec<Vec<usize>> {
    if count < 2 || folds == 0 {
        return Vec::new();
    }
    // A single group would leave nothing to tune on.
    let folds = folds.clamp(2, count);
    (0..folds).map(|fold| (fold..count).step_by(folds).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ride_is_left_out_once_and_never_all_of_them() {
        for count in 2..12 {
            for asked in 1..15 {
                let groups = folds(count, asked);
                let mut all: Vec<usize> = groups.concat();
                all.sort_unstable();
                assert_eq!(all, (0..count).collect::<Vec<_>>());
                assert!(groups.iter().all(|group| !group.is_empty() && group.len() < count));
            }
        }
    }

    #[test]
    fn one_ride_or_no_folds_leave_nothing_out() {
        assert!(folds(1, 5).is_empty());
        assert!(folds(5, 0).is_empty());
    }
}
