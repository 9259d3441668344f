//! Reduction of a curve's points without a visible change.

/// About the fewest points whose connecting lines stay within `tolerance` of all points in
/// y, by the algorithm of Ramer, Douglas and Peucker. The points ascend in x. The first
/// and the last are kept.
pub fn thin(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut kept = vec![false; points.len()];
    kept[0] = true;
    kept[points.len() - 1] = true;
    let mut open = vec![(0, points.len() - 1)];
    while let Some((first, last)) = open.pop() {
        if let Some(farthest) = farthest_beyond(points, first, last, tolerance) {
            kept[farthest] = true;
            open.push((first, farthest));
            open.push((farthest, last));
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// The point farthest from the line from `first` to `last`, if it is farther than `tolerance`.
fn farthest_beyond(points: &[(f64, f64)], first: usize, last: usize, tolerance: f64) -> Option<usize> {
    let ((x0, y0), (x1, y1)) = (points[first], points[last]);
    let deviation = |i: usize| {
        let (x, y) = points[i];
        (y - (y0 + (y1 - y0) * (x - x0) / (x1 - x0))).abs()
    };
    let farthest = (first + 1..last).max_by(|&i, &j| deviation(i).total_cmp(&deviation(j)))?;
    (deviation(farthest) > tolerance).then_some(farthest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The thinned curve's value at `x`.
    fn at(points: &[(f64, f64)], x: f64) -> f64 {
        let after = points.iter().position(|p| p.0 >= x).unwrap().max(1);
        let ((x0, y0), (x1, y1)) = (points[after - 1], points[after]);
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    }

    #[test]
    fn a_straight_line_is_its_ends() {
        let line: Vec<_> = (0..1000).map(|k| (f64::from(k), 2.0 * f64::from(k))).collect();
        assert_eq!(thin(&line, 1e-6), [line[0], line[999]]);
    }

    #[test]
    fn a_sine_keeps_its_shape_with_few_points() {
        let sine: Vec<_> = (0..10_000).map(|k| (f64::from(k) * 1e-3, (f64::from(k) * 1e-3).sin())).collect();
        let thinned = thin(&sine, 1e-3);
        assert!(thinned.len() < 150, "{} points", thinned.len());
        assert!(sine.iter().all(|&(x, y)| (at(&thinned, x) - y).abs() <= 1e-3));
    }

    #[test]
    fn a_jump_stays_a_jump() {
        let jump: Vec<_> = (0..1000).map(|k| (f64::from(k), if k < 500 { -3.5 } else { 0.0 })).collect();
        assert_eq!(thin(&jump, 1e-3), [jump[0], jump[499], jump[500], jump[999]]);
    }
}
