//! The value of a dual solution: a lower bound that does not rely on the solver.

use clarabel::solver::SupportedConeT::ZeroConeT;

use super::quadratic_program::QuadraticProgram;

/// The dual value of these multipliers. No point within the program's constraints
/// has a smaller objective.
///
/// Let z be any multipliers, with those of inequalities not negative. The objective x'Px/2
/// is at least the minimum over x of x'Px/2 + z'(Ax - b). The minimum separates by
/// variable. With c = A'z:
///
/// - an error e adds c e + e^2/2, which is at least -c^2/2;
/// - any other variable x adds c x, which is at least -|c| times the largest |x|.
///
/// Slightly inexact multipliers, such as a solver's, give a slightly lower bound that is still
/// valid.
pub fn dual_value(program: &QuadraticProgram, multipliers: &[f64]) -> f64 {
    let equalities = match program.cones[0] {
        ZeroConeT(count) => count,
        _ => 0,
    };
    let admitted: Vec<f64> =
        multipliers.iter().enumerate().map(|(row, &z)| if row < equalities { z } else { z.max(0.0) }).collect();
    let constant: f64 = admitted.iter().zip(&program.right).map(|(z, b)| z * b).sum();
    let least = |(column, &largest): (usize, &f64)| {
        let c = column_dot(program, column, &admitted);
        if largest.is_infinite() { -0.5 * c * c } else { -c.abs() * largest }
    };
    program.largest.iter().enumerate().map(least).sum::<f64>() - constant
}

/// One component of A'z.
fn column_dot(program: &QuadraticProgram, column: usize, z: &[f64]) -> f64 {
    let matrix = &program.matrix;
    let entries = matrix.colptr[column]..matrix.colptr[column + 1];
    entries.map(|entry| matrix.nzval[entry] * z[matrix.rowval[entry]]).sum()
}

#[cfg(test)]
mod tests {
    use super::super::quadratic_program::{Kind, Projection, QuadraticProgram};
    use super::super::{AxisLimits, solve};
    use super::dual_value;

    const HEAVE: AxisLimits = AxisLimits { min: -0.3, max: 0.3, velocity: 1.0, acceleration: 5.0, tilt: None };

    /// Program for the means of a force that demands more travel than the limits permit.
    fn program() -> QuadraticProgram {
        let force = |k| 2.0 * (0.05 * f64::from(k)).sin();
        let projections: Vec<_> = (0..100).map(|k| Projection::of_line(&[force(k), force(k + 1)])).collect();
        QuadraticProgram::new(&projections, 0.05, &HEAVE, Kind::Relaxed)
    }

    fn objective(program: &QuadraticProgram, x: &[f64]) -> f64 {
        let errors = x.iter().zip(&program.largest).filter(|(_, largest)| largest.is_infinite());
        0.5 * errors.map(|(x, _)| x * x).sum::<f64>()
    }

    #[test]
    fn the_solver_s_multipliers_leave_no_gap() {
        let program = program();
        let solution = solve(&program).unwrap();
        let (least, found) = (dual_value(&program, &solution.z), objective(&program, &solution.x));
        assert!(found > 1.0, "{found}");
        assert!((least - found).abs() < 1e-4 * found, "{least} {found}");
    }

    #[test]
    fn no_multipliers_at_all_claim_more_than_the_optimum() {
        let program = program();
        let solution = solve(&program).unwrap();
        let found = objective(&program, &solution.x);
        for (seed, size) in [(1, 1e-3), (2, 0.1), (3, 1.0), (4, 100.0)] {
            let noise = |row: usize| (((row as u64 * 2_654_435_761 + seed) % 1009) as f64 / 504.5 - 1.0) * size;
            let arbitrary: Vec<f64> = (0..solution.z.len()).map(noise).collect();
            let disturbed: Vec<f64> = solution.z.iter().zip(&arbitrary).map(|(z, noise)| z + noise).collect();
            assert!(dual_value(&program, &arbitrary) <= found);
            assert!(dual_value(&program, &disturbed) <= found);
        }
    }
}
