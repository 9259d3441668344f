//! The parts of [`export_fmi2!`](crate::export_fmi2) and [`export_fmi3!`](crate::export_fmi3) that
//! make C functions from a table. A line is a function: its name, its constant in the version's
//! calling sequence, and its arguments after the instance.

/// Functions that hand their arguments on, each to the function after the arrow.
#[doc(hidden)] // for `export_fmi2!` and `export_fmi3!`
#[macro_export]
macro_rules! export_functions {
    ($($name:ident $constant:ident ($($argument:ident: $type:ty),*) => $body:path;)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                instance: *mut ::std::ffi::c_void,
                $($argument: $type),*
            ) -> <Logger as $crate::abi::Host>::Status {
                // SAFETY: the function hands on what the host passes, for which the standard vouches.
                unsafe { $crate::abi::call(instance, &function::$constant, |component| $body(component $(, $argument)*)) }
            }
        )+
    };
}

/// Functions that use no argument but the instance, all with the same body. Of the arguments, only
/// the types are given; after them stands the attribute that says that a function is not provided.
#[doc(hidden)] // for `export_fmi2!` and `export_fmi3!`
#[macro_export]
macro_rules! export_unsupported {
    ($body:path; $($name:ident $constant:ident ($($argument:ty),*) $($capability:literal)?;)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                instance: *mut ::std::ffi::c_void,
                $(_: $argument),*
            ) -> <Logger as $crate::abi::Host>::Status {
                // SAFETY: the function hands on the host's instance, for which the standard vouches.
                unsafe { $crate::abi::call(instance, &function::$constant, |component| $body(component $(, $capability)?)) }
            }
        )+
    };
}

/// The get and set functions of types that no variable has. Of the arguments, only the types of
/// those after the value references and their count are given.
#[doc(hidden)] // for `export_fmi2!` and `export_fmi3!`
#[macro_export]
macro_rules! export_none_of_this_type {
    ($model:ty; $($name:ident $constant:ident ($($argument:ty),+);)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                instance: *mut ::std::ffi::c_void,
                _: *const u32,
                count: usize,
                $(_: $argument),+
            ) -> <Logger as $crate::abi::Host>::Status {
                let body = |component: &mut _| unsupported::none_of_this_type::<$model, Logger>(component, count);
                // SAFETY: the function hands on the host's instance, for which the standard vouches.
                unsafe { $crate::abi::call(instance, &function::$constant, body) }
            }
        )+
    };
}
