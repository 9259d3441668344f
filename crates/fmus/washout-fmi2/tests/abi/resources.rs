//! Where an FMU may be unpacked to.

use std::ffi::CString;
use std::ptr::null_mut;

use moris_fmu_host::Fmu;
use moris_fmu_host::api::Callbacks;
use moris_washout::Washout;

use crate::fixture::*;

/// The library in a directory with spaces and letters of other languages, and its resources'
/// location in every form.
#[test]
fn any_directory_and_any_form_of_its_location_will_do() {
    let directory = tempfile::Builder::new().prefix("Wäsche büro — モーション %20 ").tempdir().unwrap();
    let copy = directory.path().join("MorisWashout 1.so");
    std::fs::copy(library(), &copy).unwrap();
    let fmu = Fmu::from_library(&copy, "").unwrap();
    let path = directory.path().to_str().unwrap().replace('\\', "/");
    let path = path.trim_start_matches('/');
    let encoded: String = path.bytes().map(encode).collect();
    let mut locations = vec![None, Some(String::new())];
    for path in [path, &encoded] {
        for form in ["file:///", "file:/", "file:////", "file://localhost/", "/", ""] {
            locations.extend([Some(format!("{form}{path}")), Some(format!("{form}{path}/resources/"))]);
        }
    }
    let guid = CString::new(moris_interface::guid::<Washout>()).unwrap();
    let nothing = null_mut();
    let callbacks =
        Callbacks { logger: None, allocate_memory: None, free_memory: None, step_finished: None, environment: nothing };
    for location in locations {
        let text = location.as_deref().map(|location| CString::new(location).unwrap());
        let pointer = text.as_ref().map_or(std::ptr::null(), |text| text.as_ptr());
        let api = fmu.api();
        // SAFETY: strings and callbacks live during the call, and the instance until it is freed.
        unsafe {
            let c = (api.instantiate)(c"washout".as_ptr(), 1, guid.as_ptr(), pointer, &callbacks, 0, 0);
            assert!(!c.is_null(), "{location:?}");
            let statuses = [
                (api.setup_experiment)(c, 0, 0.0, 0.0, 0, 0.0),
                (api.enter_initialization_mode)(c),
                (api.exit_initialization_mode)(c),
                (api.do_step)(c, 0.0, 1e-3, 1),
            ];
            assert_eq!(statuses, [0; 4], "{location:?}");
            (api.free_instance)(c);
        }
    }
}

/// A byte of a path as a URI has it.
fn encode(byte: u8) -> String {
    if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
        char::from(byte).to_string()
    } else {
        format!("%{byte:02X}")
    }
}
