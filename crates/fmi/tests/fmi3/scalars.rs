//! A description with scalar variables: the same library, with every element under a value
//! reference of its own.

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use moris_fmi::fmi3::Layout;
use moris_interface::{Causality, Kind};

use crate::fixture::*;

fn initializing_with(layout: Layout) -> Instance {
    let instance = Instance::with(layout);
    assert_eq!(instance.enter_initialization_mode(0.0, None), OK);
    instance
}

fn slot(name: &str) -> u32 {
    IDENTITY.slot(name).unwrap_or_else(|| panic!("no {name}")) as u32
}

#[test]
fn every_element_is_set_and_read_by_its_own_reference() {
    let instance = initializing_with(Layout::Scalars);
    let parameters: Vec<u32> = (0..IDENTITY.slots.len())
        .filter(|&slot| {
            let row = IDENTITY.row(slot);
            row.causality == Causality::Parameter && matches!(row.kind, Kind::Real(_))
        })
        .map(|slot| slot as u32)
        .rev()
        .collect();
    assert!(parameters.len() > 20);
    let values: Vec<f64> = (1..).take(parameters.len()).map(f64::from).collect();
    assert_eq!(instance.set(&parameters, &values), OK);
    for (&reference, &value) in parameters.iter().zip(&values) {
        let mut read = [f64::NAN];
        assert_eq!(instance.get(&[reference], &mut read), OK);
        assert_eq!(read, [value]);
    }
}

#[test]
fn scalars_and_arrays_are_two_views_of_the_same_instance() {
    let (scalars, arrays) = (initializing_with(Layout::Scalars), initializing_with(Layout::Arrays));
    assert_eq!(scalars.set(&[slot("u.z"), slot("weight[2].x"), slot("tau")], &[3.0, 9.0, 0.25]), OK);
    arrays.set_real("u", &[0.0, 0.0, 3.0]);
    let mut weights: [f64; 18] = arrays.real("weight");
    weights[3] = 9.0;
    arrays.set_real("weight", &weights);
    arrays.set_real("tau", &[0.25]);
    assert_eq!(scalars.bytes(), arrays.bytes());
    for instance in [&scalars, &arrays] {
        assert_eq!(instance.exit_initialization_mode(), OK);
        assert_eq!(instance.do_step(0.0, 0.1).0, OK);
    }
    let mut sums = [0.0; 6];
    let references: [u32; 6] = std::array::from_fn(|k| slot(&format!("sum[{}]", k + 1)));
    assert_eq!(scalars.get(&references, &mut sums), OK);
    assert_eq!(sums, arrays.real("sum"));
    assert_ne!(sums, [0.0; 6]);
    let state = scalars.deserialize(&arrays.bytes()).unwrap();
    assert_eq!(scalars.set_state(state), OK, "a state of the one is a state of the other");
    scalars.free_state(state);
}

#[test]
fn derivatives_go_by_the_elements_too() {
    let instance = initializing_with(Layout::Scalars);
    assert_eq!(instance.set(&[slot("u.y"), slot("u.z")], &[2.0, 4.0]), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.1).0, OK);
    let derivatives = |references: &[u32]| {
        let orders = vec![1; references.len()];
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: the instance is alive, and the arrays are as long as said.
        let status = unsafe {
            let function = instance.api().get_output_derivatives;
            let (count, room) = (references.len(), values.as_mut_ptr());
            function(instance.pointer, references.as_ptr(), count, orders.as_ptr(), room, count)
        };
        (status, values)
    };
    let (status, values) = derivatives(&[slot("y.z"), slot("y.y")]);
    assert_eq!(status, OK);
    // (gain * u - y) / tau at t = 0.1 s with tau = 0.5 s: u / tau * exp(-0.2).
    for (value, u) in values.iter().zip([4.0, 2.0]) {
        assert!((value - u / 0.5 * (-0.2_f64).exp()).abs() < 1e-12, "{value}");
    }
    let (status, values) = derivatives(&[u32::MAX]);
    instance.assert_call_error(status, ERROR, &["no variable", &u32::MAX.to_string()]);
    assert!(values[0].is_nan());
}

#[test]
fn lengths_have_to_fit() {
    let instance = initializing_with(Layout::Scalars);
    let before = instance.bytes();
    let u = slot("u.x");
    instance.assert_call_error(instance.set(&[u], &[1.0; 3]), ERROR, &["'u.x' has 1 values", "comes with 3"]);
    instance.assert_call_error(instance.get(&[u, u + 1], &mut [0.0; 3]), ERROR, &["'u.x', 'u.y' together have 2"]);
    instance.assert_call_error(instance.set(&[u32::MAX], &[1.0; 2]), ERROR, &["no variable", "4294967295"]);
    instance.assert_call_error(instance.set(&[u32::MAX], &[1.0]), ERROR, &["no variable", "4294967295"]);
    instance.assert_call_error(instance.get(&[u32::MAX], &mut [1.0]), ERROR, &["no variable"]);
    assert_eq!(instance.bytes(), before);
}

/// A message names the variables of the description that the host has read.
#[test]
fn messages_name_variables_as_the_description_does() {
    let cases = [
        ("u.y", &[f64::NAN][..], "'u.y'", "'u[2]'"),
        ("weight[3].y", &[f64::INFINITY], "'weight[3].y'", "'weight[3,2]'"),
        ("tau", &[f64::NAN], "'tau'", "'tau'"),
    ];
    for (name, value, as_scalar, as_element) in cases {
        let instance = initializing_with(Layout::Scalars);
        instance.assert_call_error(instance.set(&[slot(name)], value), DISCARD, &[as_scalar]);
        let instance = initializing_with(Layout::Arrays);
        let row = IDENTITY.slots[slot(name) as usize];
        let first = slot(name) - u32::from(row.element);
        let mut values = vec![1.0; IDENTITY.row(slot(name) as usize).slots()];
        values[usize::from(row.element)] = value[0];
        let status = instance.set(&[first], &values);
        instance.assert_call_error(status, DISCARD, &[as_element]);
        let (_, _, entries) = instance.last_message();
        assert!(as_scalar == as_element || !entries.contains(as_scalar), "{entries}");
    }
}

#[test]
fn a_token_of_neither_description_is_refused() {
    let library = open();
    let guid = moris_interface::guid::<crate::model::Lags>();
    for (token, made) in [
        (guid.clone(), true),
        (format!("{guid}-arrays"), true),
        (format!("{guid}-array"), false),
        (format!("{guid}-arrays "), false),
        (format!("{guid}{guid}"), false),
        (guid[..37].to_owned(), false),
        (guid.replace('{', "["), false),
    ] {
        let c_token = CString::new(token.clone()).unwrap();
        let (name, instantiate): (&CStr, _) = (c"name", library.api().instantiate_co_simulation);
        // SAFETY: the strings live during the call; null is ignored.
        unsafe {
            let (name, token) = (name.as_ptr(), c_token.as_ptr());
            let instance = instantiate(name, token, null(), 0, 0, 0, 0, null(), 0, null_mut(), None, None);
            assert_eq!(!instance.is_null(), made, "{c_token:?}");
            (library.api().free_instance)(instance);
        }
    }
}
