//! Actions forbidden in a real-time loop: allocation and system calls. That it takes no lock
//! follows: an instance is its caller's alone, and a contended lock would call the system.

use libloading::{Library, Symbol};
use moris_fmu_host::{Fmu, Instance, Status};

use crate::fixture::{IDENTITY, input, open_library, real_inputs, reference};

const STEP: f64 = 1e-3;

/// A loop with every function that a host calls in one.
struct Loop {
    instance: Instance,
    inputs: Vec<u32>,
    outputs: Vec<u32>,
    values: Vec<f64>,
    engaged: [u32; 1],
    flags: [u32; 3],
    orders: usize,
}

impl Loop {
    fn new(fmu: &Fmu) -> Self {
        let mut instance = fmu.instantiate("loop").unwrap();
        instance.initialize(&[], None).unwrap();
        let first = reference("platform.position.x");
        let last = reference("tilt.pitchRate");
        let outputs: Vec<u32> = (first..=last).collect();
        Loop {
            instance,
            inputs: real_inputs(),
            values: vec![0.0; outputs.len()],
            orders: outputs.len(),
            outputs,
            engaged: [reference("engaged")],
            flags: ["status.tiltLimited", "status.safetyActive", "status.actuatorLimited"].map(reference),
        }
    }

    /// One round, now and then with a changed parameter and with inputs so large that
    /// everything is limited.
    fn round(&mut self, k: u32) -> bool {
        let time = f64::from(k) * STEP;
        let strength = if k % 1000 < 300 { 30.0 } else { 1.0 };
        let inputs = input(time).map(|value| strength * value);
        let mut flags = [0; 3];
        let ok = self.instance.set_real(&self.inputs, &inputs) == Status::Ok
            && self.instance.set_real_input_derivatives(&self.inputs, &[0.1; 11]) == Status::Ok
            && self.instance.set_boolean(&self.engaged, &[i32::from(k % 700 > 50)]) == Status::Ok
            && (!k.is_multiple_of(100) || self.retune(k) == Status::Ok)
            && self.instance.do_step(time, STEP) == Status::Ok
            && self.instance.get_real(&self.outputs, &mut self.values) == Status::Ok
            && self.instance.get_real_output_derivatives(&self.outputs[..self.orders], &mut self.values) == Status::Ok
            && self.instance.get_boolean(&self.flags, &mut flags) == Status::Ok;
        ok && self.values.iter().all(|value| value.is_finite())
    }

    fn retune(&mut self, k: u32) -> Status {
        let omega = 1.0 + 0.5 * f64::from(k / 100 % 4);
        self.instance.set_real(&[IDENTITY.slot("splitter.x.omega1").unwrap() as u32], &[omega])
    }
}

#[test]
fn no_set_step_or_get_touches_memory() {
    let path = moris_fmu_host::example_library("counting_library");
    let mut running = Loop::new(&open_library(&path));
    // A message takes memory: the one about inputs beyond their range comes with this call, and the one about the
    // second step's input with that step.
    assert_eq!(running.instance.set_real(&running.inputs, &[1e6; 11]), Status::Ok);
    assert!(running.instance.messages().iter().any(|message| message.text.contains("the model uses")));
    assert!(running.round(0) && running.round(1));
    assert!(running.instance.messages().iter().any(|message| message.text.contains("at rest on level ground")));
    // SAFETY: the library is the one just opened, and the function is declared as it is defined there.
    let library = unsafe { Library::new(&path) }.unwrap();
    // SAFETY: as above.
    let memory_operations: Symbol<extern "C" fn() -> usize> = unsafe { library.get(b"memory_operations") }.unwrap();
    let before = memory_operations();
    assert!(before > 0, "the counter counts");
    assert!((2..5000).all(|k| running.round(k)));
    assert_eq!(memory_operations(), before);
    drop(running);
    assert!(memory_operations() > before);
}

/// In a process of its own, to which the kernel then allows nothing but to end:
/// any other call kills it.
#[cfg(target_os = "linux")]
#[test]
fn no_set_step_or_get_calls_the_system() {
    let status = in_a_locked_process(|running| (0..5000).all(|k| running.round(k)));
    assert!(libc::WIFEXITED(status), "killed by signal {}", libc::WTERMSIG(status));
    assert_eq!(libc::WEXITSTATUS(status), 0, "a function failed");
    // The lock does lock.
    let status = in_a_locked_process(|_| std::fs::metadata("/").is_ok());
    assert!(libc::WIFSIGNALED(status) && libc::WTERMSIG(status) == libc::SIGKILL);
}

#[cfg(target_os = "linux")]
fn in_a_locked_process(work: impl Fn(&mut Loop) -> bool) -> i32 {
    let mut running = Loop::new(&crate::fixture::open());
    // SAFETY: the child takes no lock and asks for no memory, so that what other threads held when it was made does not
    // matter; it ends without returning.
    unsafe {
        match libc::fork() {
            0 => {
                libc::prctl(libc::PR_SET_SECCOMP, libc::SECCOMP_MODE_STRICT);
                let status = i32::from(!work(&mut running));
                libc::syscall(libc::SYS_exit, status);
                unreachable!()
            }
            child => {
                let mut status = 0;
                assert_eq!(libc::waitpid(child, &mut status, 0), child);
                status
            }
        }
    }
}
