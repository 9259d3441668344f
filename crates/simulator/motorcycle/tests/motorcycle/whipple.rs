//! The benchmark bicycle of Meijaard et al. (2007): its published matrices, eigenvalues and speeds.

use nalgebra::Matrix2;

use crate::common::{GRAVITY, assert_near, benchmark};

const TOLERANCE: f64 = 1e-9;

#[track_caller]
fn assert_matrix(matrix: &Matrix2<f64>, rows: [[f64; 2]; 2], name: &str) {
    for (i, row) in rows.iter().enumerate() {
        for (j, &expected) in row.iter().enumerate() {
            assert_near(matrix[(i, j)], expected, TOLERANCE, &format!("{name}({i}, {j})"));
        }
    }
}

#[test]
fn the_matrices_are_the_published_ones() {
    let equations = benchmark().equations();
    assert_matrix(&equations.m, [[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]], "M");
    assert_matrix(&equations.k0, [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]], "K0");
    assert_matrix(&equations.k2, [[0.0, 76.59734589573222], [0.0, 2.65431523794604]], "K2");
    assert_matrix(&equations.c1, [[0.0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]], "C1");
}

/// Real and imaginary parts at a speed, by growing real part.
fn eigenvalues(speed: f64) -> Vec<(f64, f64)> {
    let matrix = benchmark().equations().state_matrix(GRAVITY, speed).unwrap();
    let mut values: Vec<_> = matrix.complex_eigenvalues().iter().map(|value| (value.re, value.im)).collect();
    values.sort_by(|a, b| a.partial_cmp(b).unwrap());
    values
}

#[test]
fn the_eigenvalues_at_5_m_per_s_are_the_published_ones() {
    let expected = [
        (-14.07838969279822, 0.0),
        (-0.77534188219585, -4.46486771378823),
        (-0.77534188219585, 4.46486771378823),
        (-0.32286642900409, 0.0),
    ];
    for (value, expected) in eigenvalues(5.0).iter().zip(expected) {
        assert_near(value.0, expected.0, TOLERANCE, "real part");
        assert_near(value.1, expected.1, TOLERANCE, "imaginary part");
    }
}

#[test]
fn the_eigenvalues_at_rest_are_the_published_ones() {
    let standing = eigenvalues(0.0);
    for (value, expected) in
        standing.iter().zip([-5.53094371765393, -3.13164324790656, 3.13164324790656, 5.53094371765393])
    {
        assert_near(value.0, expected, TOLERANCE, "standing");
        assert_near(value.1, 0.0, TOLERANCE, "standing");
    }
}

/// The speed between two at which the largest real part of the eigenvalues chosen changes its sign.
fn crossing(mut low: f64, mut high: f64, real_part: impl Fn(f64) -> f64) -> f64 {
    let sign = real_part(low).signum();
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if real_part(middle).signum() == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn weave_ends_and_capsize_begins_at_the_published_speeds() {
    let weave = |speed: f64| {
        eigenvalues(speed).iter().filter(|value| value.1 != 0.0).map(|value| value.0).fold(f64::MIN, f64::max)
    };
    let capsize = |speed: f64| {
        eigenvalues(speed).iter().filter(|value| value.1 == 0.0).map(|value| value.0).fold(f64::MIN, f64::max)
    };
    assert_near(crossing(3.0, 5.0, weave), 4.29238253634111, TOLERANCE, "weave speed");
    assert_near(crossing(5.0, 7.0, capsize), 6.02426201538837, TOLERANCE, "capsize speed");
}
