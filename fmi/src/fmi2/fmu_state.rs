//! Saving and restoring states.

use std::ptr::null_mut;

use model_interface::Model;

use super::calling_sequence as function;
use super::component::{Component, call};
use super::pointers::{answer, place, room, slice};
use super::types::*;
use crate::{Complaint, Guid, Run};

/// What every state of this library begins with, and nothing else is likely to.
const MARK: u64 = u64::from_le_bytes(*b"FMUstate");

/// What an fmi2FMUstate points to.
#[repr(C)]
struct State<M> {
    /// Belongs to whom; looked at before the rest is believed.
    owner: Owner,
    run: Run<M>,
}

/// Tells a state of this model in this very library from other memory, as far as that can be done.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(C)]
struct Owner {
    mark: u64,
    guid: *const Guid,
}

impl Owner {
    fn of<M: Model>(component: &Component<M>) -> Self {
        Owner { mark: MARK, guid: component.instance.tables().guid }
    }
}

/// The state that `pointer` leads to, if it is one of the owner's.
///
/// # Safety
/// `pointer` is null or leads to memory that can be read.
unsafe fn state<M: Model>(pointer: fmi2FMUstate, owner: Owner) -> Result<*mut State<M>, Complaint> {
    let pointer = pointer.cast::<State<M>>();
    // SAFETY: not null and aligned where it is read; for the rest the caller vouches, and all bits make an owner.
    if pointer.is_null() || !pointer.is_aligned() || unsafe { pointer.cast::<Owner>().read() } != owner {
        return Err(Complaint::error("the state is null, freed already, or none of this model's"));
    }
    Ok(pointer)
}

fn into_pointer<M: Model>(owner: Owner, run: Run<M>) -> fmi2FMUstate {
    Box::into_raw(Box::new(State { owner, run })).cast()
}

/// `fmi2GetFMUstate`: into the state that is there, or else into a new one.
pub unsafe fn get<M: Model>(component: fmi2Component, pointer: *mut fmi2FMUstate) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's place for the state.
        let pointer = unsafe { place(pointer) }?;
        let owner = Owner::of(component);
        if pointer.is_null() {
            *pointer = into_pointer(owner, component.instance.run().clone());
        } else {
            // SAFETY: the host's state, which is nobody else's during the call.
            unsafe { &mut *state::<M>(*pointer, owner)? }.run.clone_from(component.instance.run());
        }
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::GET_FMU_STATE, body) }
}

/// `fmi2SetFMUstate`
pub unsafe fn set<M: Model>(component: fmi2Component, pointer: fmi2FMUstate) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's state, which nobody changes during the call.
        let state = unsafe { &*state::<M>(pointer, Owner::of(component))? };
        component.instance.restore(&state.run);
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::SET_FMU_STATE, body) }
}

/// `fmi2FreeFMUstate`; null is ignored.
pub unsafe fn free<M: Model>(component: fmi2Component, pointer: *mut fmi2FMUstate) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        if pointer.is_null() {
            return Ok(());
        }
        // SAFETY: the host's place for the state.
        let pointer = unsafe { place(pointer) }?;
        if pointer.is_null() {
            return Ok(());
        }
        // SAFETY: the host's state. It has this library's mark, so that `into_pointer` made it.
        drop(unsafe { Box::from_raw(state::<M>(*pointer, Owner::of(component))?) });
        *pointer = null_mut();
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::FREE_FMU_STATE, body) }
}

/// `fmi2SerializedFMUstateSize`
pub unsafe fn serialized_size<M: Model>(
    component: fmi2Component,
    pointer: fmi2FMUstate,
    size: *mut usize,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's state, which nobody changes during the call.
        let state = unsafe { &*state::<M>(pointer, Owner::of(component))? };
        let length = state.run.to_bytes(component.instance.tables().guid)?.len();
        // SAFETY: the host's room for the answer.
        unsafe { answer(size, length) }
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::SERIALIZED_FMU_STATE_SIZE, body) }
}

/// `fmi2SerializeFMUstate`
pub unsafe fn serialize<M: Model>(
    component: fmi2Component,
    pointer: fmi2FMUstate,
    bytes: *mut fmi2Byte,
    size: usize,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's state, which nobody changes during the call, and its room for `size` bytes.
        let (state, room) = unsafe { (&*state::<M>(pointer, Owner::of(component))?, room(bytes.cast::<u8>(), size)?) };
        let bytes = state.run.to_bytes(component.instance.tables().guid)?;
        let (length, available) = (bytes.len(), room.len());
        let room = room.get_mut(..length).ok_or_else(|| {
            Complaint::error(format!("the state takes {length} bytes, and there is room for {available}"))
        })?;
        room.write_copy_of_slice(&bytes);
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::SERIALIZE_FMU_STATE, body) }
}

/// `fmi2DeSerializeFMUstate`: into the state that is there, or else into a new one.
pub unsafe fn deserialize<M: Model>(
    component: fmi2Component,
    bytes: *const fmi2Byte,
    size: usize,
    pointer: *mut fmi2FMUstate,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's bytes, and its place for the state.
        let (bytes, pointer) = unsafe { (slice(bytes.cast::<u8>(), size)?, place(pointer)?) };
        let run = Run::from_bytes(bytes, component.instance.tables())?;
        let owner = Owner::of(component);
        if pointer.is_null() {
            *pointer = into_pointer(owner, run);
        } else {
            // SAFETY: the host's state, which is nobody else's during the call.
            unsafe { &mut *state::<M>(*pointer, owner)? }.run = run;
        }
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::DESERIALIZE_FMU_STATE, body) }
}
