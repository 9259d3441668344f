//! fmi2Instantiate and fmi2FreeInstance, with all that tools pass to them; and the logger.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::{null, null_mut};
use std::sync::Mutex;

use moris_fmu_host::Status;
use moris_fmu_host::api::{Callbacks, Text};

use crate::fixture::*;

/// Arguments of a call of the logger: instance name, status, category, message, argument.
type Entry = (String, c_int, String, String, String);

unsafe extern "C" fn log(
    environment: *mut c_void,
    instance_name: Text,
    status: c_int,
    category: Text,
    message: Text,
    argument: Text,
) {
    // SAFETY: the environment is the one that `ask` passes.
    let entries = unsafe { &*environment.cast::<Mutex<Vec<Entry>>>() };
    let entry = (text(instance_name), status, text(category), text(message), text(argument));
    entries.lock().unwrap().push(entry);
}

struct Request {
    name: Option<&'static CStr>,
    fmu_type: c_int,
    guid: Option<String>,
    resources: Option<&'static CStr>,
    logging_on: c_int,
}

impl Default for Request {
    fn default() -> Self {
        Request { name: Some(c"name"), fmu_type: 1, guid: Some(guid()), resources: None, logging_on: 0 }
    }
}

/// Attempts an instance: success, and the messages until it is freed.
fn ask(request: Request) -> (bool, Vec<Entry>) {
    let fmu = open();
    let entries = Mutex::new(Vec::<Entry>::new());
    let environment = (&raw const entries).cast_mut().cast();
    let callbacks =
        Callbacks { logger: Some(log), allocate_memory: None, free_memory: None, step_finished: None, environment };
    let guid = request.guid.as_deref().map(c_string);
    let (name, resources) = (request.name.map_or(null(), CStr::as_ptr), request.resources.map_or(null(), CStr::as_ptr));
    let guid_pointer = guid.as_ref().map_or(null(), |guid| guid.as_ptr());
    // SAFETY: strings and callbacks live during the call, the environment longer than the instance.
    let made = unsafe {
        let component =
            (fmu.api().instantiate)(name, request.fmu_type, guid_pointer, resources, &callbacks, 0, request.logging_on);
        (fmu.api().free_instance)(component);
        !component.is_null()
    };
    (made, entries.into_inner().unwrap())
}

#[track_caller]
fn assert_refused(request: Request, name: &str, part: &str) {
    let (made, entries) = ask(request);
    assert!(!made);
    let [(instance_name, status, category, message, argument)] = &entries[..] else { panic!("{entries:?}") };
    assert_eq!((instance_name.as_str(), *status, category.as_str()), (name, 3, "logStatusError"));
    assert_eq!(message, "%s", "a text must never be a format");
    assert!(argument.contains(part), "{argument}");
}

#[test]
fn is_made_silently_unless_logging_is_on() {
    assert_eq!(ask(Request::default()), (true, vec![]));
    let (made, entries) = ask(Request { logging_on: 1, ..Default::default() });
    assert!(made);
    let event = ("name".into(), 0, "logEvents".into(), "%s".into(), "FirstOrder 1.0 instantiated".into());
    assert_eq!(entries, [event]);
}

#[test]
fn is_refused_with_a_reason() {
    assert_refused(Request { name: None, ..Default::default() }, "", "pass a name");
    assert_refused(Request { name: Some(c""), ..Default::default() }, "", "pass a name");
    assert_refused(Request { guid: None, ..Default::default() }, "name", "none");
    assert_refused(Request { guid: Some("{%s%n}".into()), ..Default::default() }, "name", "{%s%n}");
    for more in [" ", "-real", "-realsx", "-arrays"] {
        assert_refused(Request { guid: Some(guid() + more), ..Default::default() }, "name", &guid());
    }
    for fmu_type in [0, 2, -1] {
        assert_refused(Request { fmu_type, ..Default::default() }, "name", "fmi2CoSimulation");
    }
}

#[test]
fn takes_every_location_of_resources() {
    let locations = [
        c"file:///tmp/a%20b",
        c"file:/tmp",
        c"file://localhost/tmp/",
        c"file:////tmp",
        c"",
        c"C:\\resources",
        c"file:///%FF%zz",
        c"http://example.org/",
        c"\xff\xfe",
    ];
    for resources in locations {
        assert!(ask(Request { resources: Some(resources), ..Default::default() }).0, "{resources:?}");
    }
}

#[test]
fn takes_names_that_are_not_ascii() {
    let (made, entries) = ask(Request { name: Some(c"W\xc3\xa4sche %s"), logging_on: 1, ..Default::default() });
    assert!(made);
    assert_eq!(entries[0].0, "Wäsche %s");
}

/// The host's struct and strings may be gone as soon as the call returns.
#[test]
fn keeps_no_pointer_of_the_host() {
    let fmu = open();
    let entries = Mutex::new(Vec::<Entry>::new());
    let environment = (&raw const entries).cast_mut().cast();
    let mut name = *b"first\0";
    let mut guid = c_string(&guid()).into_bytes_with_nul();
    let mut callbacks =
        Callbacks { logger: Some(log), allocate_memory: None, free_memory: None, step_finished: None, environment };
    // SAFETY: what is passed lives during the call, the environment longer than the instance.
    unsafe {
        let guid_pointer = guid.as_ptr().cast::<c_char>();
        let component = (fmu.api().instantiate)(name.as_ptr().cast(), 1, guid_pointer, null(), &callbacks, 0, 0);
        name.fill(b'x');
        guid.fill(b'x');
        callbacks = Callbacks { logger: None, environment: null_mut(), ..callbacks };
        std::hint::black_box((&mut name, &mut guid, &mut callbacks));
        assert_eq!((fmu.api().do_step)(component, 0.0, 0.1, 1), 3);
        (fmu.api().free_instance)(component);
    }
    let entries = entries.into_inner().unwrap();
    assert_eq!((entries.len(), entries[0].0.as_str()), (1, "first"));
}

#[test]
fn does_without_callbacks_and_without_a_logger() {
    let fmu = open();
    let guid = c_string(&guid());
    let nothing = Callbacks {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: null_mut(),
    };
    // SAFETY: what is passed lives during the call.
    unsafe {
        assert!((fmu.api().instantiate)(c"a".as_ptr(), 1, guid.as_ptr(), null(), null(), 0, 1).is_null());
        assert!((fmu.api().instantiate)(c"a".as_ptr(), 0, guid.as_ptr(), null(), &nothing, 0, 1).is_null());
        let component = (fmu.api().instantiate)(c"a".as_ptr(), 1, guid.as_ptr(), null(), &nothing, 0, 1);
        assert!(!component.is_null());
        assert_eq!((fmu.api().do_step)(component, 0.0, 0.1, 1), 3);
        assert_eq!((fmu.api().setup_experiment)(component, 0, 0.0, 0.0, 0, 0.0), 0);
        (fmu.api().free_instance)(component);
        (fmu.api().free_instance)(null_mut());
    }
}

#[test]
fn debug_logging_chooses_events_and_refuses_unknown_categories() {
    let mut instance = instantiated();
    let (c, api) = (instance.component(), open());
    let set = |on: c_int, categories: &[&CStr]| {
        let pointers: Vec<_> = categories.iter().map(|category| category.as_ptr()).collect();
        // SAFETY: the component is alive, and so are the strings.
        Status::from(unsafe { (api.api().set_debug_logging)(c, on, pointers.len(), pointers.as_ptr()) })
    };
    // Each with whether events are logged then.
    let cases: [(c_int, &[&CStr], bool); 6] = [
        (0, &[], false),
        (1, &[], true),
        (1, &[c"logStatusError", c"logStatusWarning", c"logStatusDiscard", c"logStatusFatal"], false),
        (1, &[c"logStatusError", c"logEvents"], true),
        (0, &[c"logEvents"], false),
        (1, &[c"logAll"], true),
    ];
    for (on, categories, events) in cases {
        assert_eq!(set(on, categories), Status::Ok);
        let entries = instance.messages().len();
        assert_eq!(instance.reset(), Status::Ok);
        assert_eq!(instance.messages().len() - entries, usize::from(events), "{on} {categories:?}");
        // Errors are always logged.
        assert_eq!(instance.do_step(0.0, 1.0), Status::Error);
        assert_eq!(last_message(&instance).category, "logStatusError");
    }
    assert_call_error(&instance, set(0, &[c"logEvents", c"log%s"]), Status::Error, &["fmi2SetDebugLogging", "log%s"]);
    let entries = instance.messages().len();
    assert_eq!(instance.reset(), Status::Ok);
    assert_eq!(instance.messages().len(), entries + 1, "a refused call changes nothing");
    // SAFETY: the component is alive; null is to be refused.
    let status = unsafe { (api.api().set_debug_logging)(c, 1, 1, [null()].as_ptr()) };
    assert_eq!(status, 3);
}

#[test]
fn platform_and_version_are_the_standard_s() {
    let fmu = open();
    // SAFETY: they take no arguments.
    let (platform, version) = unsafe { (text((fmu.api().get_types_platform)()), text((fmu.api().get_version)())) };
    assert_eq!((platform.as_str(), version.as_str()), ("default", "2.0"));
}
