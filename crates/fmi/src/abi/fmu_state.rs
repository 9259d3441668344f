//! Saving and restoring states. The functions are named as in FMI 3.0; those of FMI 2.0 do the
//! same.

use std::ffi::c_void;
use std::ptr::null_mut;

use moris_interface::Model;

use super::pointers::{answer, buffer, out_param, slice};
use super::{Component, Host};
use crate::{CallError, Guid, InstanceState};

/// A saved state, as the host holds it.
type FmuState = *mut c_void;

/// Target of an [`FmuState`].
#[repr(C)]
struct State<M> {
    /// The state's owner. Checked before any other field is read.
    owner: Owner,
    instance: InstanceState<M>,
}

/// Distinguishes a state of this model in this library from other memory, as far as possible.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(C)]
struct Owner {
    mark: u64,
    guid: *const Guid,
}

impl Owner {
    fn of<M: Model, H: Host>(component: &Component<M, H>) -> Self {
        // Mark at the beginning of every state of this library. Other memory is unlikely to hold
        // it.
        const LIVE_STATE_MARK: u64 = u64::from_le_bytes(*b"FMUstate");
        Owner { mark: LIVE_STATE_MARK, guid: component.instance.tables().guid }
    }
}

/// The state that `pointer` leads to, if it is one of the owner's.
///
/// # Safety
/// `pointer` is null or leads to memory that can be read.
unsafe fn owned_state<M: Model>(pointer: FmuState, owner: Owner) -> Result<*mut State<M>, CallError> {
    let pointer = pointer.cast::<State<M>>();
    // SAFETY: the pointer is not null and is aligned where it is read. The caller guarantees
    // readable memory, and any bits are a valid `Owner`.
    if pointer.is_null() || !pointer.is_aligned() || unsafe { pointer.cast::<Owner>().read() } != owner {
        return Err(CallError::error("the state is null, freed already, or none of this model's"));
    }
    Ok(pointer)
}

fn into_pointer<M: Model>(owner: Owner, instance: InstanceState<M>) -> FmuState {
    Box::into_raw(Box::new(State { owner, instance })).cast()
}

/// `fmi3GetFMUState`: overwrites the state at `pointer`, or creates one if it is null.
pub unsafe fn get<M: Model, H: Host>(component: &mut Component<M, H>, pointer: *mut FmuState) -> Result<(), CallError> {
    // SAFETY: the host's place for the state.
    let pointer = unsafe { out_param(pointer) }?;
    let owner = Owner::of(component);
    if pointer.is_null() {
        *pointer = into_pointer(owner, component.instance.state.clone());
    } else {
        // SAFETY: the host's state, which is nobody else's during the call.
        unsafe { &mut *owned_state::<M>(*pointer, owner)? }.instance.clone_from(&component.instance.state);
    }
    Ok(())
}

/// `fmi3SetFMUState`
pub unsafe fn set<M: Model, H: Host>(component: &mut Component<M, H>, pointer: FmuState) -> Result<(), CallError> {
    // SAFETY: the host's state, which nobody changes during the call.
    let state = unsafe { &*owned_state::<M>(pointer, Owner::of(component))? };
    component.instance.state.clone_from(&state.instance);
    Ok(())
}

/// `fmi3FreeFMUState`; null is ignored.
pub unsafe fn free<M: Model, H: Host>(
    component: &mut Component<M, H>,
    pointer: *mut FmuState,
) -> Result<(), CallError> {
    if pointer.is_null() {
        return Ok(());
    }
    // SAFETY: the host's place for the state.
    let pointer = unsafe { out_param(pointer) }?;
    if pointer.is_null() {
        return Ok(());
    }
    // SAFETY: the host's state.
    let state = unsafe { owned_state::<M>(*pointer, Owner::of(component))? };
    // SAFETY: the state has this library's mark, so `into_pointer` made it. The mark is
    // cleared, so that its memory is no longer taken for a state. The write is volatile,
    // because the compiler sees no later read and would omit it.
    unsafe { (&raw mut (*state).owner.mark).write_volatile(0) };
    // SAFETY: as above.
    drop(unsafe { Box::from_raw(state) });
    *pointer = null_mut();
    Ok(())
}

/// `fmi3SerializedFMUStateSize`
pub unsafe fn serialized_size<M: Model, H: Host>(
    component: &mut Component<M, H>,
    pointer: FmuState,
    size: *mut usize,
) -> Result<(), CallError> {
    // SAFETY: the host's state, which nobody changes during the call.
    let state = unsafe { &*owned_state::<M>(pointer, Owner::of(component))? };
    let length = state.instance.to_bytes(component.instance.tables().guid)?.len();
    // SAFETY: the host's memory for the answer.
    unsafe { answer(size, length) }?;
    Ok(())
}

/// `fmi3SerializeFMUState`
pub unsafe fn serialize<M: Model, H: Host>(
    component: &mut Component<M, H>,
    pointer: FmuState,
    bytes: *mut u8,
    size: usize,
) -> Result<(), CallError> {
    // SAFETY: the host's state, which nobody changes during the call, and its memory for `size` bytes.
    let (state, buffer) = unsafe { (&*owned_state::<M>(pointer, Owner::of(component))?, buffer(bytes, size)?) };
    let bytes = state.instance.to_bytes(component.instance.tables().guid)?;
    let (length, available) = (bytes.len(), buffer.len());
    let buffer = buffer.get_mut(..length).ok_or_else(|| {
        CallError::error(format!("the state takes {length} bytes, and there is room for {available}"))
    })?;
    buffer.write_copy_of_slice(&bytes);
    Ok(())
}

/// `fmi3DeserializeFMUState`: overwrites the state at `pointer`, or creates one if it is null.
pub unsafe fn deserialize<M: Model, H: Host>(
    component: &mut Component<M, H>,
    bytes: *const u8,
    size: usize,
    pointer: *mut FmuState,
) -> Result<(), CallError> {
    // SAFETY: the host's bytes, and its place for the state.
    let (bytes, pointer) = unsafe { (slice(bytes, size)?, out_param(pointer)?) };
    let instance = InstanceState::from_bytes(bytes, component.instance.tables())?;
    let owner = Owner::of(component);
    if pointer.is_null() {
        *pointer = into_pointer(owner, instance);
    } else {
        // SAFETY: the host's state, which is nobody else's during the call.
        unsafe { &mut *owned_state::<M>(*pointer, owner)? }.instance = instance;
    }
    Ok(())
}
