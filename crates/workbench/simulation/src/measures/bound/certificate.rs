//! The value of a dual solution: a lower bound that does not rely on the solver.

use super::barrier::Multipliers;
use super::interior_point::Solution;
use super::program::{Program, Range};

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
pub fn lower_bound<const N: usize, const U: usize, const E: usize>(
    program: &Program<N, U, E>,
    solution: &Solution<N, U, E>,
) -> f64 {
    let Solution { states, inputs, multipliers } = solution;
    let mut value = 0.0;
    let mut costate = [0.0; N];
    for (k, desired) in program.desired.iter().enumerate().rev() {
        let y = program.error(k, &states[k], &inputs[k]);
        let of_states = admitted_multipliers(&multipliers[k].states);
        let of_limits = admitted_multipliers(&multipliers[k].limits);
        value -= y.iter().zip(desired).map(|(y, desired)| y * (desired + 0.5 * y)).sum::<f64>();
        value -= at_limits(&of_states, &program.states) + at_limits(&of_limits, &program.limits);
        costate.iter_mut().zip(of_states.net()).for_each(|(sum, net)| *sum += net);

        let (mut of_state, mut of_input) = ([0.0; N], [0.0; U]);
        program.motion.add_transposed(&costate, &mut of_state, &mut of_input);
        program.felt.add_transposed(&y, &mut of_state, &mut of_input);
        program.limited.add_transposed(&of_limits.net(), &mut of_state, &mut of_input);
        let Range { min, max } = &program.inputs;
        value += of_input.iter().enumerate().map(|(n, c)| (c * min[n]).min(c * max[n])).sum::<f64>();
        costate = of_state;
    }
    value
}

/// The multipliers, none below 0.
fn admitted_multipliers<const M: usize>(multipliers: &Multipliers<M>) -> Multipliers<M> {
    let Multipliers { lower, upper } = multipliers;
    Multipliers { lower: lower.map(|z| z.max(0.0)), upper: upper.map(|z| z.max(0.0)) }
}

/// Sum of the multipliers times the limits.
fn at_limits<const M: usize>(multipliers: &Multipliers<M>, range: &Range<M>) -> f64 {
    (0..M).map(|k| multipliers.upper[k] * range.max[k] - multipliers.lower[k] * range.min[k]).sum()
}

#[cfg(test)]
mod tests {
    use super::super::AxisLimits;
    use super::super::barrier::Multipliers;
    use super::super::interior_point::{Solution, solve};
    use super::super::program::{Program, relaxed};
    use super::super::projection::Projection;
    use super::lower_bound;

    const HEAVE: AxisLimits = AxisLimits { min: -0.3, max: 0.3, velocity: 1.0, acceleration: 5.0, tilt: None };

    /// Program for a force that demands more travel than the limits permit.
    fn program() -> Program<2, 2, 1> {
        let force = |k| 2.0 * (0.05 * f64::from(k)).sin();
        let desired: Vec<_> = (0..100).map(|k| Projection::of_line(&[force(k), force(k + 1)])).collect();
        relaxed(&desired, 0.05, &HEAVE)
    }

    fn value(program: &Program<2, 2, 1>, solution: &Solution<2, 2, 1>) -> f64 {
        let errors = (0..100).flat_map(|k| program.error(k, &solution.states[k], &solution.inputs[k]));
        0.5 * errors.map(|error| error * error).sum::<f64>()
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
            for multipliers in &mut disturbed.multipliers {
                disturb(&mut multipliers.states, &mut noise);
                disturb(&mut multipliers.limits, &mut noise);
            }
            assert!(lower_bound(&program, &disturbed) < found);
            // The errors are multipliers, too: those of inputs that do not fit the states.
            disturbed.inputs.iter_mut().flatten().for_each(|input| *input += noise());
            assert!(lower_bound(&program, &disturbed) < found);
        }
    }

    fn disturb<const M: usize>(multipliers: &mut Multipliers<M>, noise: &mut impl FnMut() -> f64) {
        multipliers.lower.iter_mut().chain(&mut multipliers.upper).for_each(|z| *z += noise());
    }
}
