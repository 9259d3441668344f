//! The filter chain against closed forms, an integration of its equation, and itself.

use moris_washout::filter::chain::{Chains, Denominator};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::chain::Chain;
use crate::common::random::Random;
use crate::common::{cases, rk4};

/// D(s)'s coefficients, highest power first, multiplied out here from its factors.
fn polynomial(order: i32, omega1: f64, zeta1: f64, omega2: f64, zeta2: f64) -> Vec<f64> {
    let first = [1.0, 2.0 * zeta1 * omega1, omega1 * omega1];
    let second = match order {
        2 => vec![1.0],
        3 => vec![1.0, omega2],
        _ => vec![1.0, 2.0 * zeta2 * omega2, omega2 * omega2],
    };
    let mut product = vec![0.0; first.len() + second.len() - 1];
    for (i, a) in first.iter().enumerate() {
        for (j, b) in second.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

/// Position, velocity and acceleration of s^n/D, from x'' = s^n/D u written as an equation of its
/// own and integrated by Runge-Kutta: with D y = u, y in phase variables.
struct Integrated {
    coefficients: Vec<f64>,
    state: [f64; 4],
}

impl Integrated {
    /// Many small steps over `duration` while the input goes from `start` to `end`.
    fn advance(&mut self, start: f64, end: f64, duration: f64) {
        let order = self.coefficients.len() - 1;
        const PARTS: usize = 256;
        let h = duration / PARTS as f64;
        let coefficients = &self.coefficients;
        // state[k] is the k-th derivative of y.
        let derivative = |t: f64, y: &[f64; 4]| {
            let mut dy = [0.0; 4];
            dy[..order - 1].copy_from_slice(&y[1..order]);
            let rest: f64 = (0..order).map(|k| coefficients[order - k] * y[k]).sum();
            dy[order - 1] = start + (end - start) * t / duration - rest;
            dy
        };
        for k in 0..PARTS {
            self.state = rk4(k as f64 * h, self.state, h, derivative);
        }
    }

    /// Position, velocity and, for the input's present value, acceleration.
    fn motion(&self, input: f64) -> [f64; 3] {
        let order = self.coefficients.len() - 1;
        let rest: f64 = (0..order).map(|k| self.coefficients[order - k] * self.state[k]).sum();
        [self.state[order - 2], self.state[order - 1], input - rest]
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn agrees_with_an_integration_for_both_holds(
        order in 2..=4_i32, omega1 in 0.1..8.0, zeta1 in 0.3..1.5, omega2 in 0.1..8.0, zeta2 in 0.3..1.5,
        step in 0.001..0.05, ramp: bool, seed: u64,
    ) {
        let mut chain = Chain::new(Denominator::new(order, omega1, zeta1, omega2, zeta2));
        let coefficients = polynomial(order, omega1, zeta1, omega2, zeta2);
        let mut integrated = Integrated { coefficients, state: [0.0; 4] };
        let mut random = Random::new(seed);
        let (mut start, mut peaks) = (0.0, [1e-3_f64; 3]);
        for _ in 0..200 {
            let end = random.between(-1.0, 1.0);
            if !ramp {
                start = end;
            }
            chain.advance(start, end, step);
            integrated.advance(start, end, step);
            let ours = [chain.second_integral(), chain.first_integral(), chain.high_pass(end)];
            let theirs = integrated.motion(end);
            for k in 0..3 {
                peaks[k] = peaks[k].max(theirs[k].abs());
                prop_assert!((ours[k] - theirs[k]).abs() <= 1e-9 * peaks[k], "{k}: {} {}", ours[k], theirs[k]);
            }
            start = end;
        }
    }

    #[test]
    fn high_pass_and_low_pass_add_up_to_the_input(order in 2..=4_i32, omega in 0.05..20.0, zeta in 0.2..2.0, seed: u64) {
        let mut chain = Chain::new(Denominator::new(order, omega, zeta, 0.7 * omega, zeta));
        let mut random = Random::new(seed);
        for _ in 0..500 {
            let input = random.between(-10.0, 10.0);
            chain.advance(input, input, 0.002);
            let sum = chain.high_pass(input) + chain.low_pass();
            // What rounding leaves of the larger of the two.
            prop_assert!((sum - input).abs() <= f64::EPSILON * (input.abs() + chain.low_pass().abs()));
        }
    }

    #[test]
    fn one_step_is_many_small_ones(order in 2..=4_i32, omega in 0.1..10.0, zeta in 0.3..1.5, end in -5.0..5.0) {
        let start = 1.0;
        let mut coarse = Chain::new(Denominator::new(order, omega, zeta, 1.3 * omega, zeta));
        let mut fine = coarse;
        for _ in 0..10 {
            coarse.advance(start, end, 0.1);
            for k in 0..100 {
                let at = |k: i32| start + (end - start) * f64::from(k) / 100.0;
                fine.advance(at(k), at(k + 1), 0.001);
            }
            prop_assert!((coarse.second_integral() - fine.second_integral()).abs() < 1e-11);
            prop_assert!((coarse.first_integral() - fine.first_integral()).abs() < 1e-11);
            prop_assert!((coarse.high_pass(end) - fine.high_pass(end)).abs() < 1e-10);
        }
    }
}

#[test]
fn step_and_ramp_return_to_zero_at_order_4() {
    for slope in [0.0, 0.1] {
        let mut chain = Chain::new(Denominator::new(4, 2.5, 1.0, 1.5, 0.7));
        let input = |k: i32| 1.0 + slope * f64::from(k) * 0.01;
        let mut farthest = 0.0_f64;
        for k in 0..6000 {
            chain.advance(input(k), input(k + 1), 0.01);
            farthest = farthest.max(chain.second_integral().abs());
        }
        assert!(farthest > 0.02);
        assert!(chain.second_integral().abs() < 1e-12 && chain.first_integral().abs() < 1e-12);
    }
}

#[test]
fn ramp_leaves_an_offset_below_order_4() {
    // s/(s^2 ...) and so on: the final value of s^(n-2)/D times slope/s^2 is slope over what is left of D.
    let at_rest = |order: i32, slope: f64| {
        let mut chain = Chain::new(Denominator::new(order, 2.0, 1.0, 3.0, 1.0));
        for k in 0..6000 {
            chain.advance(slope * f64::from(k) * 0.01, slope * f64::from(k + 1) * 0.01, 0.01);
        }
        chain.second_integral()
    };
    assert!((at_rest(3, 0.1) - 0.1 / (2.0 * 2.0 * 3.0)).abs() < 1e-9);
    assert!(at_rest(4, 0.1).abs() < 1e-9);
}

#[test]
fn high_pass_at_a_frequency_is_its_transfer_function() {
    // |s^4/D| at s = j omega, by the closed form for two equal critically damped pairs: (w/w0)^4 / (1 + (w/w0)^2)^2.
    let (omega0, omega) = (2.5, 4.0_f64);
    let mut chain = Chain::new(Denominator::new(4, omega0, 1.0, omega0, 1.0));
    let mut peak = 0.0_f64;
    for k in 0..40_000 {
        let at = |k: i32| (omega * f64::from(k) * 0.001).sin();
        chain.advance(at(k), at(k + 1), 0.001);
        if k > 30_000 {
            peak = peak.max(chain.high_pass(at(k + 1)).abs());
        }
    }
    let ratio2 = (omega / omega0) * (omega / omega0);
    assert!((peak - ratio2 * ratio2 / ((1.0 + ratio2) * (1.0 + ratio2))).abs() < 1e-5);
}

#[test]
fn chains_at_the_ends_of_what_is_accepted_stay_accurate() {
    // In 10 s a fast chain's low-pass is the input and a slow one's high-pass is. Nothing else fits in between.
    for (order, omega, zeta) in [(4, 1e3, 1.0), (4, 1e3, 1e-2), (4, 1e3, 1e2), (3, 1e3, 1.0), (2, 1e3, 1e2)] {
        let mut chain = Chain::new(Denominator::new(order, omega, zeta, omega, zeta));
        for _ in 0..10_000 {
            chain.advance(1.0, 1.0, 0.001);
        }
        assert!((chain.low_pass() - 1.0).abs() < 1e-3, "{omega} {zeta}: {}", chain.low_pass());
        assert!(chain.second_integral().abs() < 1e-4, "{omega} {zeta}: {}", chain.second_integral());
    }
    for (order, omega, zeta) in [(4, 1e-6, 1e-3), (4, 1e-6, 1.0), (2, 1e-6, 1.0)] {
        let mut chain = Chain::new(Denominator::new(order, omega, zeta, omega, zeta));
        for _ in 0..1000 {
            chain.advance(1.0, 1.0, 0.01);
        }
        assert!((chain.high_pass(1.0) - 1.0).abs() < 1e-3, "{omega} {zeta}");
        assert!((chain.second_integral() - 50.0).abs() < 1e-2, "{omega} {zeta}: {}", chain.second_integral());
    }
}

#[test]
fn other_coefficients_leave_the_motion_and_what_is_washed_out() {
    // Coefficients of eq. (3)'s denominator, multiplied out by hand.
    let coefficients = |[w1, z1, w2, z2]: [f64; 4]| {
        [
            2.0 * (z1 * w1 + z2 * w2),
            w1 * w1 + w2 * w2 + 4.0 * z1 * z2 * w1 * w2,
            2.0 * w1 * w2 * (z1 * w2 + z2 * w1),
            w1 * w1 * w2 * w2,
        ]
    };
    let (before, after) = ([1.3, 0.8, 2.1, 0.6], [0.4, 1.1, 3.7, 0.9]);
    let denominators = |[w1, z1, w2, z2]: [f64; 4]| [Denominator::new(4, w1, z1, w2, z2); 3];
    let input = Vector3::new(1.0, -2.0, 0.5);
    for moving in [0.7, 60.0] {
        let mut chains = Chains::new(denominators(before), 0.01);
        for _ in 0..(moving / 0.01) as usize {
            chains.advance(input, input, 0.01);
        }
        let remembered = |chains: &Chains, [c1, c2, ..]: [f64; 4]| {
            chains.low_pass() - c1 * chains.first_integral() - c2 * chains.second_integral()
        };
        let (velocity, position) = (chains.first_integral(), chains.second_integral());
        let washed_out = remembered(&chains, coefficients(before));
        chains.retune(denominators(after), 2);
        assert_eq!((chains.first_integral(), chains.second_integral()), (velocity, position));
        let error = remembered(&chains, coefficients(after)) - washed_out;
        assert!(error.amax() < 1e-12, "after {moving} s: {error}");
    }
    // After a minute nothing of the held input is left, and nothing comes back.
    let mut chains = Chains::new(denominators(before), 0.01);
    for k in 0..12_000 {
        if k == 6000 {
            chains.retune(denominators(after), 2);
        }
        chains.advance(input, input, 0.01);
        assert!(k < 6000 || chains.second_integral().amax() < 1e-9, "{}", chains.second_integral());
    }
}
