//! Benchmark of one exchange of a 1 kHz loop with the built FMU, through the C functions.
//!
//! An exchange sets 9 inputs, steps 1 ms, and gets 6 lengths and 6 felt values. The same exchange
//! is timed with an FMU that does nothing, and with empty functions. The difference of these two is
//! the cost of the C functions.
//!
//! ```sh
//! cargo build-fmu && cargo build --release -p moris-fmi --example do_nothing
//! cargo bench -p moris-washout-fmi2
//! ```

// The model's source file, for its GUID and its names.
#[path = "../../../../fmi/tests/models/do_nothing/model.rs"]
mod do_nothing;
// The tests' random numbers; not all of its functions are used here.
#[allow(dead_code)]
#[path = "../../../../../tests/washout/common/random.rs"]
mod random;
mod running;
mod worst_cases;

use std::path::{Path, PathBuf};

use criterion::{Criterion, criterion_group, criterion_main};
use do_nothing::DoNothing;
use moris_fmu_host::Fmu;
use moris_interface::guid;
use running::Running;

fn target() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../target");
    std::env::var_os("CARGO_TARGET_DIR").map_or(beside, PathBuf::from)
}

fn washout_fmu() -> Fmu {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../target/fmu/MorisWashout.fmu");
    Fmu::open(&path).unwrap_or_else(|error| panic!("{error}: run `cargo build-fmu`"))
}

fn do_nothing_fmu() -> Fmu {
    let file = format!("{}do_nothing{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = target().join("release/examples").join(file);
    Fmu::from_library(&library, &guid::<DoNothing>())
        .unwrap_or_else(|error| panic!("{error}: run `cargo build --release -p moris-fmi --example do_nothing`"))
}

fn exchange(c: &mut Criterion) {
    let (washout, nothing) = (washout_fmu(), do_nothing_fmu());
    let mut alone = Running::do_nothing(&nothing).without_functions();
    let mut nothing = Running::do_nothing(&nothing);
    let mut washout = Running::washout(&washout, &[]);
    c.bench_function("exchange with empty functions: the loop alone", |b| b.iter(|| alone.ride()));
    c.bench_function("exchange with an FMU that does nothing", |b| b.iter(|| nothing.ride()));
    c.bench_function("exchange with the washout", |b| b.iter(|| washout.ride()));
}

fn lives(c: &mut Criterion) {
    let fmu = washout_fmu();
    c.bench_function("instantiate and free", |b| b.iter(|| fmu.instantiate("bench").expect("instantiated")));
    c.bench_function("instantiate, initialise and free", |b| b.iter(|| Running::washout(&fmu, &[])));
    let mut running = Running::washout(&fmu, &[]);
    let mut state = running.instance.get_state().expect("a state");
    c.bench_function("get state, reusing its memory", |b| {
        b.iter(|| running.instance.get_state_into(&mut state));
    });
    c.bench_function("set state", |b| b.iter(|| running.instance.set_state(&state)));
}

criterion_group!(benches, exchange, lives, worst_cases::smooth_ride, worst_cases::limited_ride);
criterion_main!(benches);
