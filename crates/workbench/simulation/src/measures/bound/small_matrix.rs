//! Matrices of a few rows, as arrays whose sizes the compiler knows.

/// Adds the terms, each times the same factor.
pub fn add<const M: usize>(sum: &mut [f64; M], times: f64, terms: &[f64; M]) {
    sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += times * term);
}

/// The product left right.
pub fn product<const R: usize, const K: usize, const C: usize>(
    left: &[[f64; K]; R],
    right: &[[f64; C]; K],
) -> [[f64; C]; R] {
    let mut result = [[0.0; C]; R];
    for r in 0..R {
        for k in 0..K {
            add(&mut result[r], left[r][k], &right[k]);
        }
    }
    result
}

/// The product left' right, without transposing.
pub fn transposed_product<const R: usize, const K: usize, const C: usize>(
    left: &[[f64; R]; K],
    right: &[[f64; C]; K],
) -> [[f64; C]; R] {
    let mut result = [[0.0; C]; R];
    for k in 0..K {
        for r in 0..R {
            add(&mut result[r], left[k][r], &right[k]);
        }
    }
    result
}

/// The lower factor L with L L' = `matrix`; on its diagonal stand the inverses.
pub fn cholesky<const M: usize>(mut matrix: [[f64; M]; M]) -> [[f64; M]; M] {
    // Least part of a diagonal element that stays in its pivot: rounding cannot make it negative.
    const PIVOT_ROUNDING: f64 = 1e-14;
    let diagonal: [f64; M] = std::array::from_fn(|j| matrix[j][j]);
    for j in 0..M {
        let pivot = matrix[j][j].max(PIVOT_ROUNDING * diagonal[j]);
        let inverse = 1.0 / pivot.sqrt();
        matrix[j + 1..].iter_mut().for_each(|row| row[j] *= inverse);
        matrix[j][j] = inverse;
        for i in j + 1..M {
            for k in j + 1..=i {
                matrix[i][k] -= matrix[i][j] * matrix[k][j];
            }
        }
    }
    matrix
}

/// right becomes the solution x of L x = right.
pub fn forward_substitute<const M: usize>(factor: &[[f64; M]; M], right: &mut [f64; M]) {
    for i in 0..M {
        for j in 0..i {
            right[i] -= factor[i][j] * right[j];
        }
        right[i] *= factor[i][i];
    }
}

/// Forward substitution for each column of `right`.
pub fn forward_substitute_columns<const M: usize, const C: usize>(factor: &[[f64; M]; M], right: &mut [[f64; C]; M]) {
    for i in 0..M {
        for j in 0..i {
            let row = right[j];
            add(&mut right[i], -factor[i][j], &row);
        }
        right[i].iter_mut().for_each(|value| *value *= factor[i][i]);
    }
}

/// right becomes the solution x of L' x = right.
pub fn backward_substitute<const M: usize>(factor: &[[f64; M]; M], right: &mut [f64; M]) {
    for i in (0..M).rev() {
        right[i] *= factor[i][i];
        for j in 0..i {
            right[j] -= factor[i][j] * right[i];
        }
    }
}
