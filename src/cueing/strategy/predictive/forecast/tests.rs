//! The forecast beside plain sums over everything that has passed, and on
//! references with a known course.

use super::*;

const MEMORY: Memory = Memory { fit: 60.0, selection: 3.0 };

/// The forecaster after `time` seconds of a reference, sampled every 20 ms.
fn followed(reference: impl Fn(f64) -> f64, time: f64, kind: ForecastKind) -> Forecaster {
    let tables = Tables::default();
    let mut forecaster = Forecaster::new(&tables);
    for k in 0..(time / PLAN_INTERVAL).round() as usize {
        for j in 0..20 {
            forecaster.advance(reference(k as f64 * PLAN_INTERVAL + f64::from(j + 1) * 0.001), 0.001);
        }
        forecaster.sample(&tables, kind, &MEMORY);
    }
    forecaster
}

/// Means of a reference over the blocks that follow a time.
fn means(reference: impl Fn(f64) -> f64, time: f64) -> SVector<f64, BLOCKS> {
    let (ends, durations) = (Horizon::Near.ends(), Horizon::Near.durations());
    SVector::from_fn(|k, _| {
        let start = time + ends[k] - durations[k];
        (0..1000).map(|i| reference(start + durations[k] * (f64::from(i) + 0.5) / 1000.0)).sum::<f64>() / 1000.0
    })
}

#[test]
fn a_periodic_reference_is_learned() {
    let reference = |t: f64| 2.0 * (1.3 * t).sin() + 0.5 * (4.0 * t).cos();
    let error = |kind| {
        let (mut sum, mut count) = (0.0, 0.0);
        for time in [61.0, 62.3, 63.9, 65.2] {
            let forecaster = followed(reference, time, kind);
            sum += (forecaster.forecast.means - means(reference, time)).norm_squared();
            count += BLOCKS as f64;
        }
        (sum / count).sqrt()
    };
    let (learned, hold, decay) = (error(ForecastKind::Learned), error(ForecastKind::Hold), error(ForecastKind::Decay));
    assert!(learned < 0.15, "{learned}");
    assert!(learned < 0.2 * hold && learned < 0.2 * decay, "{learned}, {hold}, {decay}");
}

#[test]
fn a_constant_reference_is_expected_to_stay_and_none_to_stay_none() {
    let forecast = followed(|_| 1.5, 30.0, ForecastKind::Learned).forecast;
    assert!(forecast.means.iter().all(|mean| (mean - 1.5).abs() < 0.05), "{}", forecast.means);
    assert_eq!(followed(|_| 0.0, 10.0, ForecastKind::Learned).forecast, Forecast::default());
}

#[test]
fn over_a_longer_horizon_a_forecast_keeps_its_integral_and_fades() {
    let forecast = Forecast { means: SVector::from_fn(|k, _| 1.0 + k as f64), end: [2.0, 0.5] };
    assert!((forecast.over(Horizon::Near).means - forecast.means).amax() < 1e-12);
    let far = forecast.over(Horizon::Far);
    let sum = |means: &SVector<f64, BLOCKS>, horizon: Horizon| means.dot(&SVector::from(*horizon.durations()));
    let [slow, fast] = DECAY_RATES;
    let tail = 2.0 * (1.0 - (-slow * FORECAST_TIME).exp()) / slow + 0.5 * (1.0 - (-fast * FORECAST_TIME).exp()) / fast;
    let expected = sum(&forecast.means, Horizon::Near) + tail;
    assert!((sum(&far.means, Horizon::Far) - expected).abs() < 1e-12);
    assert!((far.end[0] - 2.0 * (-slow * FORECAST_TIME).exp()).abs() < 1e-12);
}

#[test]
fn a_stop_takes_the_reference_away_from_its_time_on() {
    let forecaster = followed(|_| -2.0, 20.0, ForecastKind::Learned);
    let forecast = forecaster.until_stop(1.5, Horizon::Far);
    let (ends, durations) = (Horizon::Far.ends(), Horizon::Far.durations());
    for k in 0..BLOCKS {
        let braking = (1.5 - (ends[k] - durations[k])).clamp(0.0, durations[k]) / durations[k];
        assert!((forecast.means[k] + 2.0 * braking).abs() < 1e-9, "block {k}: {}", forecast.means[k]);
    }
    assert_eq!(forecast.end, [0.0; 2]);
    let later = forecaster.until_stop(6.5, Horizon::Far);
    assert!(later.means.iter().all(|mean| (mean + 2.0).abs() < 1e-9));
    assert!((later.end[0] + 2.0).abs() < 1e-9 && later.end[1].abs() < 1e-9, "{:?}", later.end);
    assert_eq!(forecaster.until_stop(2.9, Horizon::Near).end, [0.0; 2]);
    assert_ne!(forecaster.until_stop(3.1, Horizon::Near).end, [0.0; 2]);
}

#[test]
fn low_passes_follow_a_step_as_exponentials() {
    let forecaster = followed(|_| 1.0, 0.6, ForecastKind::Hold);
    for (low, time) in forecaster.low_passes.iter().zip(TIME_CONSTANTS) {
        assert!((low - (1.0 - (-0.6 / time).exp())).abs() < 1e-12);
    }
    assert!((forecaster.integral - 0.6).abs() < 1e-12);
}

#[test]
fn the_priors_covariance_is_that_of_a_simulated_process() {
    // An Ornstein-Uhlenbeck process of one pole through one low-pass, by its Lyapunov equation.
    let covariance = prior_covariance();
    for (feature, time) in TIME_CONSTANTS[..FORCES - 1].iter().enumerate() {
        let a = 1.0 / time;
        let (mut variance, mut with_input) = (0.0, 0.0);
        for (s, input_variance) in PRIOR {
            // y' = a (u - y), E u^2 = 1: E uy = a/(a + s), E y^2 = E uy.
            let cross = a / (a + s);
            with_input += input_variance * cross;
            variance += input_variance * cross;
        }
        assert!((covariance[(0, feature + 1)] - with_input).abs() < 1e-12);
        assert!((covariance[(feature + 1, feature + 1)] - variance).abs() < 1e-12);
    }
    // Two low-passes of one reference: (a + b) E y z = a E u z + b E u y.
    for (i, a) in TIME_CONSTANTS[..FORCES - 1].iter().map(|time| 1.0 / time).enumerate() {
        for (j, b) in TIME_CONSTANTS[..FORCES - 1].iter().map(|time| 1.0 / time).enumerate() {
            let expected = (a * covariance[(0, j + 1)] + b * covariance[(0, i + 1)]) / (a + b);
            assert!((covariance[(i + 1, j + 1)] - expected).abs() < 1e-12);
        }
    }
    assert!((covariance[(0, 0)] - 1.0).abs() < 1e-12);
    // The angular velocities know nothing of the forces, nor of each other.
    for rate in FORCES..FEATURES {
        let column = covariance.column(rate);
        assert_eq!((column[rate], column.amax(), column.sum()), (RATE_VARIANCE, RATE_VARIANCE, RATE_VARIANCE));
    }
    assert_eq!(covariance, covariance.transpose());
}

/// A reference with something of everything: 1 ms samples of it are what the forecaster sees.
fn lively(time: f64) -> f64 {
    let pulse = if (time % 7.0) < 1.5 { 1.2 } else { 0.0 };
    1.5 * (0.9 * time).sin() + 0.6 * (3.7 * time).cos() + pulse + 0.1 * time.sqrt()
}

/// Angular velocities beside it.
fn lively_rates(time: f64) -> Vector3<f64> {
    Vector3::new(0.4 * (1.1 * time).sin(), 0.2 * (2.3 * time).cos(), 0.1 * (0.4 * time).sin())
}

/// All samples of a reference, 1 ms apart, and from them without recursions what a forecaster
/// computes.
struct Plain {
    values: Vec<f64>,
    /// Low-passes at every 20 ms.
    low_passes: Vec<[f64; LOW_PASSES]>,
}

/// Number of 1 ms samples in 20 ms.
const PER_SAMPLE: usize = 20;

impl Plain {
    fn new(reference: impl Fn(f64) -> f64, samples: usize) -> Self {
        let values: Vec<f64> = (1..=samples * PER_SAMPLE).map(|k| reference(k as f64 * 0.001)).collect();
        let low_passes = (0..=samples).map(|n| TIME_CONSTANTS.map(|time| low_pass(&values[..n * PER_SAMPLE], time)));
        let low_passes = low_passes.collect();
        Plain { values, low_passes }
    }

    /// Advances a forecaster to a sample from the one before.
    fn advance(&self, forecaster: &mut Forecaster, n: usize) {
        for value in &self.values[(n - 1) * PER_SAMPLE..n * PER_SAMPLE] {
            forecaster.advance(*value, 0.001);
        }
        forecaster.set_angular(0.0, &lively_rates(n as f64 * PLAN_INTERVAL));
    }

    fn value(&self, n: usize) -> f64 {
        if n == 0 { 0.0 } else { self.values[n * PER_SAMPLE - 1] }
    }

    /// Mean over the samples from `start` to `end`, zero before the first.
    fn mean(&self, start: isize, end: isize) -> f64 {
        let from = (start.max(0) as usize) * PER_SAMPLE;
        let to = (end.max(0) as usize) * PER_SAMPLE;
        self.values[from..to].iter().sum::<f64>() / ((end - start) as f64 * PER_SAMPLE as f64)
    }

    /// The features at a sample.
    fn features(&self, n: isize) -> Features {
        if n < 1 {
            return Features::zeros();
        }
        let n = n as usize;
        let rates = lively_rates(n as f64 * PLAN_INTERVAL);
        Features::from_fn(|k, _| match k {
            0 => self.value(n),
            k if k < FORCES => self.low_passes[n][k - 1],
            k => rates[k - FORCES],
        })
    }

    /// A target whose time ends at a sample.
    fn truth(&self, target: usize, now: usize) -> f64 {
        match target {
            BLOCKS => self.low_passes[now][SLOW_LOW_PASS],
            target if target > BLOCKS => self.value(now) - self.low_passes[now][SLOW_LOW_PASS],
            block => self.mean(now as isize - BLOCK_SAMPLES[block] as isize, now as isize),
        }
    }

    /// The fixed experts at a sample: hold, trend and decay, by integrals of their courses.
    fn fixed(&self, n: isize) -> [Targets; 3] {
        if n < 0 {
            return [Targets::zeros(); 3];
        }
        let n = n as usize;
        let (slow, fast) = (self.low_passes[n][SLOW_LOW_PASS], self.value(n) - self.low_passes[n][SLOW_LOW_PASS]);
        let slope = (self.low_passes[n][TREND_LOW_PASSES[0]] - self.low_passes[n][TREND_LOW_PASSES[1]]) / 0.2;
        let course = |slow_decay: f64, fast_decay: f64| {
            let part = |value: f64, decay: f64, time: f64| value * (-decay * time).exp();
            let means = means(|time| part(slow, slow_decay, time) + part(fast, fast_decay, time), 0.0);
            let end = [part(slow, slow_decay, 3.0), part(fast, fast_decay, 3.0)];
            Targets::from_fn(|k, _| if k < BLOCKS { means[k] } else { end[k - BLOCKS] })
        };
        let hold = course(0.02, 0.02);
        let grown = |time: f64| slope * 1.5 * (1.0 - (-time / 1.5).exp());
        let (ends, durations) = (Horizon::Near.ends(), Horizon::Near.durations());
        let trend =
            Targets::from_fn(|k, _| if k < BLOCKS { grown(ends[k] - 0.5 * durations[k]) } else { 0.5 * grown(3.0) });
        [hold, hold + trend, course(0.1, 3.0)]
    }
}

/// A first-order low-pass as the sum over all held values, each with the decay since.
fn low_pass(values: &[f64], time: f64) -> f64 {
    let decay = |count: usize| (-(count as f64) * 0.001 / time).exp();
    // After 40 time constants nothing is left.
    let first = values.len().saturating_sub((40.0 * time / 0.001) as usize);
    (first..values.len()).map(|k| values[k] * (decay(values.len() - k - 1) - decay(values.len() - k))).sum()
}

/// The fit at a sample: for each target, least squares over all that has followed, with the weight
/// of its age, and with the prior.
fn plain_fit(plain: &Plain, tables: &Tables, n: usize) -> Linear {
    let mut fit = Linear::zeros();
    for (target, prior) in tables.priors.iter().enumerate() {
        let (mut squares, mut products) = (prior.squares, prior.products);
        for k in 1..=n as isize {
            let weight = (-PLAN_INTERVAL * (n as f64 - k as f64) / MEMORY.fit).exp();
            let start = k - samples_to_end(target) as isize;
            let x = plain.features(start);
            squares += weight * x * x.transpose();
            products += weight * x * plain.truth(target, k as usize);
        }
        fit.set_row(target, &(squares.try_inverse().unwrap() * products).transpose());
    }
    fit
}

#[test]
fn the_learned_forecast_is_that_of_plain_sums() {
    let tables = Tables::default();
    let samples = 420;
    let plain = Plain::new(lively, samples);
    let mut forecaster = Forecaster::new(&tables);
    let mut fits = vec![from_features(&tables.decay)];
    for n in 1..=samples {
        plain.advance(&mut forecaster, n);
        forecaster.sample(&tables, ForecastKind::Learned, &MEMORY);
        // Each target is fitted every five samples.
        let mut fit = fits[n - 1];
        let newest = plain_fit(&plain, &tables, n);
        for target in (0..TARGETS).filter(|target| target % 5 == n % 5) {
            fit.set_row(target, &newest.row(target));
        }
        assert!((forecaster.fitted - fit).amax() < 1e-6, "sample {n}: {}", (forecaster.fitted - fit).amax());
        fits.push(fit);
    }
    // Mean squared errors of each expert for each target, over all samples.
    let mut errors = SMatrix::<f64, EXPERTS, TARGETS>::repeat(1e-4);
    let forecasts = |n: isize| {
        let [hold, trend, decay] = plain.fixed(n);
        let fitted = if n < 1 { Targets::zeros() } else { fits[n as usize] * plain.features(n) };
        [hold, trend, decay, fitted]
    };
    let all: Vec<_> = (0..=samples as isize).map(forecasts).collect();
    let mut age = 0;
    for target in 0..TARGETS {
        if target < BLOCKS {
            age += BLOCK_SAMPLES[target];
        }
        for n in 1..=samples {
            let weight = (1.0 - (-PLAN_INTERVAL / MEMORY.selection).exp())
                * (-PLAN_INTERVAL * (samples - n) as f64 / MEMORY.selection).exp();
            let start = n as isize - age as isize;
            let truth = plain.truth(target, n);
            for expert in 0..EXPERTS {
                let forecast = if start < 0 { 0.0 } else { all[start as usize][expert][target] };
                errors[(expert, target)] += weight * (forecast - truth).powi(2);
            }
        }
    }
    let off = (forecaster.errors - errors).component_div(&errors).amax();
    assert!(off < 1e-5, "errors are off by {off}");
    let latest = &all[samples];
    for target in 0..TARGETS {
        let weights = [0, 1, 2, 3].map(|expert: usize| errors[(expert, target)].powi(-4));
        let sum: f64 = (0..EXPERTS).map(|expert| weights[expert] * latest[expert][target]).sum();
        let expected = sum / weights.iter().sum::<f64>();
        let Forecast { means, end } = forecaster.forecast;
        let found = if target < BLOCKS { means[target] } else { end[target - BLOCKS] };
        assert!((found - expected).abs() < 1e-5, "target {target}: {found} beside {expected}");
    }
    for (kind, expert) in [(ForecastKind::Hold, 0), (ForecastKind::Decay, 2)] {
        let mut forecaster = forecaster.clone();
        forecaster.sample(&tables, kind, &MEMORY);
        let found = forecaster.over(Horizon::Near, &tables, kind);
        let expected = latest[expert].fixed_rows::<BLOCKS>(0);
        assert!((found.means - expected).amax() < 1e-5);
        assert!((found.end[0] - latest[expert][BLOCKS]).abs() < 1e-9);
        assert!((found.end[1] - latest[expert][BLOCKS + 1]).abs() < 1e-9);
    }
}

#[test]
fn the_fit_begins_as_the_fading_expert_with_the_priors_weight() {
    let tables = Tables::default();
    // A tenth of the samples of a block's time, of 3 s for the last.
    for (target, samples) in [(0, 0.2), (4, 3.3), (BLOCKS - 1, 15.0), (TARGETS - 1, 15.0)] {
        let expected = samples * (prior_covariance() + 3e-3 * Covariance::identity());
        assert!((tables.priors[target].squares - expected).amax() < 1e-12, "target {target}");
    }
    // Two low-passes are the slow part: the fit's, and that of the fixed experts.
    let mut low_passes = SVector::from_fn(|k, _| 0.2 * k as f64);
    low_passes[SLOW_LOW_PASS] = low_passes[FIT_SLOW];
    let sample = StoredSample { value: 1.3, low_passes, rates: Vector3::new(0.3, 0.2, 0.1), ..StoredSample::default() };
    for (target, prior) in tables.priors.iter().enumerate() {
        let forecast = prior.coefficients().unwrap().dot(&sample.features());
        let [.., decay] = tables.fixed_forecasts(sample.parts(), target);
        assert!((forecast - decay).abs() < 1e-9, "target {target}");
    }
}

#[test]
fn a_rate_that_leads_the_reference_is_learned() {
    // The reference follows 0.2 s after the yaw rate, which nothing else foretells.
    let noise =
        |time: f64| (7.3 * time + 3.0 * (0.9 * time).sin()).sin() + (5.1 * time + 4.0 * (1.7 * time).cos()).sin();
    let error = |leads: f64| {
        let tables = Tables::default();
        let mut forecaster = Forecaster::new(&tables);
        let (mut sum, mut count) = (0.0, 0.0);
        for n in 0..4000 {
            let time = f64::from(n) * PLAN_INTERVAL;
            for _ in 0..20 {
                forecaster.advance(noise(time), 0.001);
            }
            forecaster.set_angular(0.0, &Vector3::new(0.0, 0.0, leads * noise(time + 0.2)));
            forecaster.sample(&tables, ForecastKind::Learned, &MEMORY);
            if n > 2000 {
                // The third block is from 0.1 to 0.2 s.
                sum += (forecaster.forecast.means[2] - noise(time + 0.15)).powi(2);
                count += 1.0;
            }
        }
        (sum / count).sqrt()
    };
    let (with, without) = (error(1.0), error(0.0));
    assert!(with < 0.5 * without, "{with} beside {without}");
}

#[test]
fn over_a_horizon_the_forecast_is_its_own() {
    let tables = Tables::default();
    let forecaster = followed(lively, 8.0, ForecastKind::Learned);
    for (horizon, expected) in
        [(Horizon::Near, forecaster.forecast), (Horizon::Far, forecaster.forecast.over(Horizon::Far))]
    {
        assert_eq!(forecaster.over(horizon, &tables, ForecastKind::Learned), expected);
    }
    assert_ne!(forecaster.forecast.means, forecaster.forecast.over(Horizon::Far).means);
}

/// A preview of `count` values, 0.2 s apart, of a reference from a time on.
fn course(reference: impl Fn(f64) -> f64, time: f64, count: usize) -> PreviewedCue {
    let values = std::array::from_fn(|k| reference(time + (k + 1) as f64 * 0.2));
    PreviewedCue { step: 0.2, count, values, ..PreviewedCue::default() }
}

/// Linear between values 0.2 s apart: a preview loses nothing of it.
fn cornered(time: f64) -> f64 {
    let (corner, fraction) = ((time / 0.2).floor(), time / 0.2 - (time / 0.2).floor());
    let value = |k: f64| (1.9 * k).sin() + 0.5 * (0.7 * k).cos();
    value(corner) + fraction * (value(corner + 1.0) - value(corner))
}

#[test]
fn after_a_right_preview_the_forecast_is_the_one_made_then() {
    let tables = Tables::default();
    let mut forecaster = followed(cornered, 12.0, ForecastKind::Decay);
    forecaster.preview(&course(cornered, 12.0, 8));
    assert!((forecaster.preview_length() - 1.6).abs() < 1e-12);
    let then = followed(cornered, 13.6, ForecastKind::Decay);
    let mut ahead = Ahead::default();
    let previewed = forecaster.previewed_reference(&mut ahead, &tables, ForecastKind::Decay).unwrap();
    // The forecaster holds each value for a millisecond, and knows the present one by a low-pass.
    assert!((previewed.after.means - then.forecast.means).amax() < 0.02, "{}", previewed.after.means);
    assert!((previewed.slow - forecaster.low_passes[SLOW_LOW_PASS]).abs() < 1e-15);
    for part in 0..2 {
        assert!((previewed.after.end[part] - then.forecast.end[part]).abs() < 0.02);
    }
    forecaster.delay_preview(0.3);
    assert!((forecaster.preview_length() - 1.9).abs() < 1e-12);
}

#[test]
fn the_forecast_goes_towards_the_preview_by_its_trust() {
    let tables = Tables::default();
    let mut forecaster = followed(lively, 8.0, ForecastKind::Learned);
    forecaster.preview(&course(|time| 3.0 * time.cos(), 0.0, 30));
    let mut ahead = Ahead::default();
    let previewed = forecaster.previewed_reference(&mut ahead, &tables, ForecastKind::Learned).unwrap();
    for horizon in [Horizon::Near, Horizon::Far] {
        let learned = forecaster.forecast.over(horizon);
        let (previewed, trust) = (previewed.over(horizon), forecaster.trust(horizon));
        let found = forecaster.over(horizon, &tables, ForecastKind::Learned);
        for block in 0..BLOCKS {
            let mix = (1.0 - trust[block]) * learned.means[block] + trust[block] * previewed.means[block];
            assert!((found.means[block] - mix).abs() < 1e-12, "{found:?}");
        }
        let last = trust[BLOCKS - 1];
        for part in 0..2 {
            let mix = (1.0 - last) * learned.end[part] + last * previewed.end[part];
            assert!((found.end[part] - mix).abs() < 1e-12, "{found:?}");
        }
        assert!(last > 0.1 && last < 0.999, "{last}");
    }
}

#[test]
fn trust_falls_with_the_fourth_power_of_the_worst_ratio_of_errors() {
    let mut forecaster = Forecaster::new(&Tables::default());
    let learned = [0.1, 0.02, 0.3, 0.05, 0.01, 0.2, 0.03, 0.4];
    let previewed = [0.01, 0.02, 0.04, 0.03, 0.001, 0.01, 0.05, 0.02];
    forecaster.preview_errors = [learned, previewed].map(SVector::from);
    let ratio = |block: usize| previewed[block] / (learned[block] + 0.005);
    let trust = |blocks: &[usize]| {
        let worst = blocks.iter().map(|&block| ratio(block)).fold(0.0, f64::max);
        1.0 / (1.0 + (1.6 * worst).powi(4))
    };
    let near: [&[usize]; BLOCKS] = [&[0], &[1], &[2], &[3], &[4], &[4, 5], &[4, 5, 6], &[4, 5, 6, 7]];
    // The near block that ends with the far one, or after it.
    let far = [near[1], near[3], near[4], near[5], near[6], near[7], near[7], near[7]];
    for (horizon, blocks) in [(Horizon::Near, near), (Horizon::Far, far)] {
        for (found, blocks) in forecaster.trust(horizon).iter().zip(blocks) {
            assert!((found - trust(blocks)).abs() < 1e-12, "{found} beside {}", trust(blocks));
        }
    }
}

#[test]
fn errors_of_a_preview_rise_fast_and_fall_slowly() {
    let tables = Tables::default();
    let samples = 300;
    let plain = Plain::new(lively, samples);
    let mut forecaster = Forecaster::new(&tables);
    let mut expected = [1e-4, 2e-3].map(SVector::<f64, BLOCKS>::repeat);
    let mut made = vec![];
    for n in 1..=samples {
        plain.advance(&mut forecaster, n);
        // At first there is no preview; then it is wrong for a while.
        let wrong = if n % 100 < 50 { 0.8 } else { 0.0 };
        if n > 20 {
            forecaster.preview(&course(|time| lively(time) + wrong, n as f64 * PLAN_INTERVAL, 20));
        }
        forecaster.sample(&tables, ForecastKind::Learned, &MEMORY);
        let previewed = forecaster.preview_over(Horizon::Near, &tables, ForecastKind::Learned);
        made.push(previewed.map(|previewed| [forecaster.forecast.means, previewed.means]));
        let mut age = 0;
        for block in 0..BLOCKS {
            age += BLOCK_SAMPLES[block];
            let truth = plain.truth(block, n);
            let Some(means) = n.checked_sub(age + 1).and_then(|then| made[then]) else { continue };
            for which in 0..2 {
                let squared = 1e-4 + (means[which][block] - truth).powi(2);
                let error = &mut expected[which][block];
                let time = if squared > *error { 1.5 } else { 10.0 };
                *error += (1.0 - (-PLAN_INTERVAL / time).exp()) * (squared - *error);
            }
        }
        for (found, expected) in forecaster.preview_errors.iter().zip(&expected) {
            assert!((found - expected).amax() < 1e-9, "sample {n}");
        }
    }
    assert!(expected[1][BLOCKS - 1] > 0.01, "{}", expected[1]);
}

#[test]
fn the_angular_channels_part_of_the_reference_fades_over_a_preview() {
    let tables = Tables::default();
    let mut forecaster = followed(|_| 0.0, 1.0, ForecastKind::Hold);
    forecaster.preview(&course(|_| 0.0, 0.0, 8));
    forecaster.set_angular(0.5, &Vector3::zeros());
    let mut ahead = Ahead::default();
    let previewed = forecaster.previewed_reference(&mut ahead, &tables, ForecastKind::Hold).unwrap();
    assert!((previewed.ahead.last() - 0.5 * (-1.6_f64).exp()).abs() < 1e-12, "{}", previewed.ahead.last());
}
