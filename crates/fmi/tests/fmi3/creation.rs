//! fmi3Instantiate..., fmi3FreeInstance, and the logger.

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};
use std::sync::Mutex;

use crate::fixture::*;

struct Request {
    name: Option<&'static CStr>,
    token: Option<CString>,
    logging_on: u8,
    event_mode_used: u8,
    intermediate_variables: Vec<u32>,
}

impl Default for Request {
    fn default() -> Self {
        Request {
            name: Some(c"name"),
            token: Some(token()),
            logging_on: 0,
            event_mode_used: 0,
            intermediate_variables: vec![],
        }
    }
}

/// Attempts an instance: success, and the messages until it is freed.
fn ask(request: &Request) -> (bool, Vec<Entry>) {
    let library = open();
    let entries = Mutex::new(Vec::new());
    let name = request.name.map_or(null(), CStr::as_ptr);
    let token = request.token.as_ref().map_or(null(), |token| token.as_ptr());
    let (references, count) = (request.intermediate_variables.as_ptr(), request.intermediate_variables.len());
    let (logging, events, environment) = (request.logging_on, request.event_mode_used, environment(&entries));
    // SAFETY: strings and arrays live during the call, the messages longer than the instance.
    let made = unsafe {
        let instantiate = library.api().instantiate_co_simulation;
        let instance = instantiate(
            name,
            token,
            c"/tmp/".as_ptr(),
            0,
            logging,
            events,
            1,
            references,
            count,
            environment,
            Some(log),
            None,
        );
        (library.api().free_instance)(instance);
        !instance.is_null()
    };
    (made, entries.into_inner().unwrap())
}

#[track_caller]
fn assert_refused(request: &Request, part: &str) {
    let (made, entries) = ask(request);
    assert!(!made);
    let [(status, category, text)] = &entries[..] else { panic!("{entries:?}") };
    assert_eq!((*status, category.as_str()), (ERROR, "logStatusError"));
    assert!(text.starts_with("fmi3InstantiateCoSimulation: ") && text.contains(part), "{text}");
}

#[test]
fn is_made_silently_unless_logging_is_on() {
    assert_eq!(ask(&Request::default()), (true, vec![]));
    let (made, entries) = ask(&Request { logging_on: 1, ..Default::default() });
    assert!(made);
    assert_eq!(entries, [(OK, "logEvents".into(), "Lags 1.0 instantiated".into())]);
}

#[test]
fn is_refused_with_a_reason() {
    assert_refused(&Request { name: None, ..Default::default() }, "pass a name");
    assert_refused(&Request { name: Some(c""), ..Default::default() }, "pass a name");
    assert_refused(&Request { name: Some(c" \t\n"), ..Default::default() }, "pass a name");
    assert_refused(&Request { token: None, ..Default::default() }, "none");
    assert_refused(&Request { event_mode_used: 1, ..Default::default() }, "hasEventMode");
    let intermediate_variables = vec![reference("u")];
    assert_refused(&Request { intermediate_variables, ..Default::default() }, "providesIntermediateUpdate");
}

/// A host may take `#7#` in a message for a variable.
#[test]
fn a_number_sign_in_a_message_is_doubled() {
    assert_refused(&Request { token: Some(CString::from(c"a#7#%s")), ..Default::default() }, "a##7##%s");
}

#[test]
fn only_co_simulation_is_possible() {
    let library = open();
    let entries = Mutex::new(Vec::new());
    let (name, token, environment) = (c"name".as_ptr(), token(), environment(&entries));
    // SAFETY: the strings live during the calls.
    unsafe {
        let model_exchange = library.api().instantiate_model_exchange;
        assert!(model_exchange(name, token.as_ptr(), null(), 0, 0, environment, Some(log)).is_null());
        assert!(model_exchange(name, token.as_ptr(), null(), 0, 0, null_mut(), None).is_null());
        let scheduled = library.api().instantiate_scheduled_execution;
        assert!(scheduled(name, token.as_ptr(), null(), 0, 0, environment, Some(log), None, None, None).is_null());
    }
    let entries = entries.into_inner().unwrap();
    assert_eq!(entries.len(), 2);
    assert!(entries.iter().all(|(status, _, text)| *status == ERROR && text.contains("for co-simulation only")));
}

#[test]
fn does_without_a_logger() {
    let library = open();
    let token = token();
    // SAFETY: the strings live during the call; null is ignored.
    unsafe {
        let instantiate = library.api().instantiate_co_simulation;
        let name = c"name".as_ptr();
        assert!(instantiate(name, null(), null(), 0, 1, 0, 0, null(), 0, null_mut(), None, None).is_null());
        let instance = instantiate(name, token.as_ptr(), null(), 0, 1, 0, 0, null(), 0, null_mut(), None, None);
        assert!(!instance.is_null());
        assert_eq!((library.api().terminate)(instance), ERROR);
        (library.api().free_instance)(instance);
        (library.api().free_instance)(null_mut());
    }
}

/// True for each of an event, a discarded value and an error that is logged.
fn logged(instance: &Instance) -> [bool; 3] {
    let entries = |act: &dyn Fn()| {
        let before = instance.messages().len();
        act();
        instance.messages().len() > before
    };
    [
        entries(&|| assert_eq!(instance.reset(), OK)),
        entries(&|| assert_eq!(instance.set(&[reference("u")], &[f64::NAN; 3]), DISCARD)),
        entries(&|| assert_eq!(instance.exit_initialization_mode(), ERROR)),
    ]
}

#[test]
fn debug_logging_switches_categories_one_by_one() {
    let instance = Instance::new();
    let set = |on: u8, categories: &[&CStr]| {
        let pointers: Vec<_> = categories.iter().map(|category| category.as_ptr()).collect();
        // SAFETY: the instance is alive, and so are the strings.
        unsafe { (instance.api().set_debug_logging)(instance.pointer, on, pointers.len(), pointers.as_ptr()) }
    };
    assert_eq!(logged(&instance), [true; 3], "all categories are on at first");
    // Each with whether events, discarded values and errors are logged then; errors are, unless switched off by name.
    let cases: [(u8, &[&CStr], [bool; 3]); 9] = [
        (0, &[c"logEvents"], [false, true, true]),
        (0, &[], [false, false, true]),
        (1, &[c"logStatusDiscard", c"logStatusError"], [false, true, true]),
        (1, &[c"logEvents"], [true, true, true]),
        (0, &[c"logStatusError"], [true, true, false]),
        (0, &[c"logStatusDiscard"], [true, false, false]),
        (0, &[], [false, false, false]),
        (1, &[c"logEvents", c"logStatusError"], [true, false, true]),
        (1, &[], [true, true, true]),
    ];
    for (on, categories, expected) in cases {
        assert_eq!(set(on, categories), OK);
        assert_eq!(logged(&instance), expected, "{on} {categories:?}");
    }
    instance.assert_call_error(set(0, &[c"logEvents", c"logAll"]), ERROR, &["fmi3SetDebugLogging", "logAll"]);
    assert_eq!(logged(&instance), [true; 3], "a refused call changes nothing");
}
