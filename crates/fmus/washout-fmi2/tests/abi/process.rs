//! The process that the library finds itself in is left as it was.

use moris_fmu_host::Fmu;
use moris_fmu_tests::hostile::{Choices, Functions, run};

use crate::fixture::*;

/// Properties of the process: locale, directory, signals' handlers, environment, threads, open
/// files, what is done at its end.
fn process() -> Vec<String> {
    let count = |directory: &str| std::fs::read_dir(directory).unwrap().count();
    // SAFETY: null asks for the present locale.
    let locale = unsafe { std::ffi::CStr::from_ptr(libc::setlocale(libc::LC_ALL, std::ptr::null())) };
    let mut process = vec![
        format!("locale {locale:?}"),
        format!("directory {}", std::env::current_dir().unwrap().display()),
        format!("environment {:?}", std::env::vars_os().collect::<Vec<_>>()),
        format!("threads {}", count("/proc/self/task")),
        format!("files {}", count("/proc/self/fd")),
    ];
    for signal in 1..=64 {
        // SAFETY: all zeros are an action, and null asks for the present one.
        let action = unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            libc::sigaction(signal, std::ptr::null(), &mut action);
            action
        };
        process.push(format!("signal {signal}: {:#x} {:#x}", action.sa_sigaction, action.sa_flags));
    }
    process
}

/// Run in a process of its own, in which nothing else happens: see the next test.
#[test]
#[ignore = "a part of the_process_is_left_as_it_was, which runs it"]
fn look_before_and_after() {
    // SAFETY: no other thread is there that would ask for the locale.
    unsafe { libc::setlocale(libc::LC_ALL, c"".as_ptr()) };
    let before = process();
    let fmu = Fmu::from_library(&library(), "").unwrap();
    assert_eq!(process(), before, "by loading it");
    run(&Functions::fmi2(fmu.api()), Choices::Seed(13), 20_000);
    assert_eq!(process(), before, "by calling it");
    drop(fmu);
    assert_eq!(process(), before, "by unloading it");
}

#[test]
fn the_process_is_left_as_it_was() {
    run_alone("process::look_before_and_after");
}
