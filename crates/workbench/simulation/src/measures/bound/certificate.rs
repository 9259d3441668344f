//! The value of a dual solution: a lower bound that does not rely on the solver.

use nalgebra::SVector;

use super::interior_point::Solution;
use super::program::Program;

/// The dual value of these errors and multipliers. No motion within the program's limits has a
/// smaller value.
///
/// Let y be any numbers, one for each error, and z any multipliers that are not negative. Half the
/// sum of the squared errors e is at least
///
/// sum of y (e - y/2) + z (what exceeds a limit),
///
/// which is linear in the motion. Its coefficients for the states are taken back to the inputs by
/// the motion's equations, from the last interval to the first. The start is at rest. An input u
/// with the coefficient c then adds at least the lesser of c times its least and c times its
/// greatest value.
///
/// Slightly inexact multipliers, such as a solver's, give a slightly lower bound that is still
/// valid.
pub fn lower_bound<const N: usize, const U: usize, const R: usize>(
    program: &Program<N, U, R>,
    solution: &Solution<N, U, R>,
) -> f64 {
    let Solution { states, inputs, multipliers } = solution;
    let Program { felt, limited, min, max, desired } = program;
    let motion = program.motion();
    // None below 0, and none of the inputs, whose limits count by themselves.
    let admitted = |multipliers: &SVector<f64, R>| {
        let mut multipliers = multipliers.map(|z| z.max(0.0));
        multipliers.fixed_rows_mut::<U>(N).fill(0.0);
        multipliers
    };
    let mut value = 0.0;
    let mut costate = SVector::<f64, N>::zeros();
    for (k, desired) in desired.iter().enumerate().rev() {
        let y = program.error(k, &states[k], &inputs[k]);
        let [lower, upper] = multipliers[k].each_ref().map(admitted);
        value -= y.dot(&(desired + 0.5 * y)) + upper.dot(max) - lower.dot(min);
        let of = [motion.weighted(&costate), felt.weighted(&y), limited.weighted(&(upper - lower))];
        let coefficients = of.iter().map(|(_, of_input)| of_input).sum::<SVector<f64, U>>();
        value += coefficients.iter().enumerate().map(|(n, c)| (c * min[N + n]).min(c * max[N + n])).sum::<f64>();
        costate = of.iter().map(|(of_state, _)| of_state).sum();
    }
    value
}

#[cfg(test)]
mod tests {
    use super::super::AxisLimits;
    use super::super::interior_point::{Solution, solve};
    use super::super::program::{Program, relaxed};
    use super::super::projection::Projection;
    use super::lower_bound;

    const HEAVE: AxisLimits = AxisLimits { min: -0.3, max: 0.3, velocity: 1.0, acceleration: 5.0, tilt: None };

    /// Program for a force that demands more travel than the limits permit.
    fn program() -> Program<2, 2, 5> {
        let force = |k| 2.0 * (0.05 * f64::from(k)).sin();
        let desired: Vec<_> = (0..100).map(|k| Projection::of_line(&[force(k), force(k + 1)])).collect();
        relaxed(&desired, 0.05, &HEAVE)
    }

    fn value(program: &Program<2, 2, 5>, solution: &Solution<2, 2, 5>) -> f64 {
        let errors = (0..100).map(|k| program.error(k, &solution.states[k], &solution.inputs[k]));
        0.5 * errors.map(|error| error.norm_squared()).sum::<f64>()
    }

    #[test]
    fn the_solver_s_multipliers_leave_no_gap() {
        let program = program();
        let solution = solve(&program).unwrap();
        let (least, found) = (lower_bound(&program, &solution), value(&program, &solution));
        assert!(found > 1.0, "{found}");
        assert!(least <= found && found - least < 1e-5 * found, "{least} {found}");
    }

    #[test]
    fn no_multipliers_at_all_claim_more_than_the_optimum() {
        let program = program();
        let found = value(&program, &solve(&program).unwrap());
        for (seed, size) in [(1, 1e-3), (2, 0.1), (3, 1.0), (4, 100.0)] {
            let mut number = seed;
            let mut noise = || {
                number = (number * 2_654_435_761_u64 + 1) % 1_000_003;
                (number as f64 / 500_001.5 - 1.0) * size
            };
            let mut disturbed = solve(&program).unwrap();
            disturbed.multipliers.iter_mut().flatten().flatten().for_each(|z| *z += noise());
            assert!(lower_bound(&program, &disturbed) < found);
            // The errors are multipliers, too: those of inputs that do not fit the states.
            disturbed.inputs.iter_mut().flatten().for_each(|input| *input += noise());
            assert!(lower_bound(&program, &disturbed) < found);
        }
    }
}
