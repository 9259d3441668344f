//! The whole exchange of a 1 kHz loop through the C functions of the built FMU, beside the same exchange with an FMU that
//! does nothing: set 9 inputs, step 1 ms, get 6 lengths and 6 felt values.
//!
//! ```sh
//! cargo build-fmu && cargo build --release -p fmi-export --example do_nothing
//! cargo bench -p moris-washout-fmu
//! ```

// The model's own file, for its GUID and its names.
#[path = "../../fmi/examples/do_nothing/model.rs"]
mod do_nothing;

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use do_nothing::DoNothing;
use fmu_host::{Fmu, Instance, Status};
use model_interface::guid;

const STEP: f64 = 0.001;

/// An instance in its loop.
struct Loop {
    instance: Instance,
    inputs: [u32; 9],
    outputs: [u32; 12],
    step: u64,
}

impl Loop {
    fn new(fmu: &Fmu, inputs: [u32; 9], outputs: [u32; 12]) -> Self {
        let mut instance = fmu.instantiate("bench").expect("instantiated");
        instance.initialize(&[], None).expect("initialised");
        Loop { instance, inputs, outputs, step: 0 }
    }

    fn washout(fmu: &Fmu) -> Self {
        let reference = |name: String| fmu.variable(&name).expect("a variable of the washout").value_reference;
        let axes = |vector: &str| ["x", "y", "z"].map(|axis| reference(format!("{vector}.{axis}")));
        let [fx, fy, fz] = axes("vehicle.specificForce");
        let [wx, wy, wz] = axes("vehicle.angularVelocity");
        let [roll, pitch, yaw] =
            ["roll", "pitch", "yaw"].map(|angle| reference(format!("vehicle.orientation.{angle}")));
        let [l1, l2, l3, l4, l5, l6] = [1, 2, 3, 4, 5, 6].map(|i| reference(format!("actuator[{i}].length")));
        let [ax, ay, az] = axes("rider.specificForce");
        let [rx, ry, rz] = axes("rider.angularVelocity");
        Loop::new(fmu, [fx, fy, fz, wx, wy, wz, roll, pitch, yaw], [l1, l2, l3, l4, l5, l6, ax, ay, az, rx, ry, rz])
    }

    fn do_nothing(fmu: &Fmu) -> Self {
        // Value references are slots, and slot 0 is the time.
        Loop::new(fmu, std::array::from_fn(|k| 1 + k as u32), std::array::from_fn(|k| 10 + k as u32))
    }

    fn exchange(&mut self) -> f64 {
        let phase = 1e-3 * self.step as f64;
        let wave = 0.3 * (phase - phase.floor() - 0.5).abs();
        let inputs = [wave, 0.5 * wave, 9.8 + 0.1 * wave, 0.01 * wave, 0.0, 0.0, 0.02 * wave, 0.01 * wave, 0.1];
        let mut outputs = [0.0; 12];
        let time = STEP * self.step as f64;
        let set = self.instance.set_real(&self.inputs, black_box(&inputs));
        let stepped = self.instance.do_step(time, STEP);
        let got = self.instance.get_real(&self.outputs, &mut outputs);
        assert!(set == Status::Ok && stepped == Status::Ok && got == Status::Ok);
        self.step += 1;
        black_box(outputs)[0]
    }
}

fn target() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target");
    std::env::var_os("CARGO_TARGET_DIR").map_or(beside, PathBuf::from)
}

fn washout_fmu() -> Fmu {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/fmu/MorisWashout.fmu");
    Fmu::open(&path).unwrap_or_else(|error| panic!("{error}: run `cargo build-fmu`"))
}

fn do_nothing_fmu() -> Fmu {
    let file = format!("{}do_nothing{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = target().join("release/examples").join(file);
    Fmu::from_library(&library, &guid::<DoNothing>())
        .unwrap_or_else(|error| panic!("{error}: run `cargo build --release -p fmi-export --example do_nothing`"))
}

fn exchange(c: &mut Criterion) {
    let (washout, nothing) = (washout_fmu(), do_nothing_fmu());
    let mut washout = Loop::washout(&washout);
    let mut nothing = Loop::do_nothing(&nothing);
    c.bench_function("exchange with an FMU that does nothing", |b| b.iter(|| nothing.exchange()));
    c.bench_function("exchange with the washout", |b| b.iter(|| washout.exchange()));
}

fn lives(c: &mut Criterion) {
    let fmu = washout_fmu();
    c.bench_function("instantiate and free", |b| b.iter(|| fmu.instantiate("bench").expect("instantiated")));
    c.bench_function("instantiate, initialise and free", |b| b.iter(|| Loop::washout(&fmu)));
    let mut running = Loop::washout(&fmu);
    let mut state = running.instance.get_state().expect("a state");
    c.bench_function("get state, reusing its memory", |b| {
        b.iter(|| running.instance.get_state_into(&mut state));
    });
    c.bench_function("set state", |b| b.iter(|| running.instance.set_state(&state)));
}

/// Ten million steps, one by one: how rarely is a step how slow?
fn worst_cases(_: &mut Criterion) {
    const STEPS: usize = 10_000_000;
    let fmu = washout_fmu();
    let mut running = Loop::washout(&fmu);
    let mut nanoseconds: Vec<u32> = (0..STEPS)
        .map(|_| {
            let begin = Instant::now();
            running.exchange();
            begin.elapsed().as_nanos() as u32
        })
        .collect();
    nanoseconds.sort_unstable();
    let at = |share: f64| nanoseconds[((STEPS - 1) as f64 * share) as usize];
    println!(
        "10 million exchanges, one clock reading each: median {} ns, 99 % {} ns, 99.99 % {} ns, slowest {} ns",
        at(0.5),
        at(0.99),
        at(0.9999),
        at(1.0)
    );
}

criterion_group!(benches, exchange, lives, worst_cases);
criterion_main!(benches);
