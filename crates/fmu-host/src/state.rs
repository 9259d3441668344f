//! Saved states.

use crate::api::FmuState;
use crate::{HostError, Instance, Status};

/// A state of an instance, for any instance of the same FMU. The memory is the FMU's until
/// [`Instance::free_state`].
#[derive(Debug)]
pub struct State {
    pub(crate) pointer: FmuState,
}

// SAFETY: an FMU's state is memory that no thread owns, and only `&mut` and `Instance` lead to changes.
unsafe impl Send for State {}

impl State {
    /// The FMU's own pointer to the state, to use with [`Instance::api`].
    pub fn pointer(&self) -> FmuState {
        self.pointer
    }
}

impl Instance {
    /// Saves the state.
    ///
    /// # Errors
    /// The FMU does not save it.
    pub fn get_state(&mut self) -> Result<State, HostError> {
        let mut state = State { pointer: std::ptr::null_mut() };
        let status = self.get_state_into(&mut state);
        self.expect_ok("fmi2GetFMUstate", status)?;
        Ok(state)
    }

    /// Saves the state in the memory of one that is there already.
    pub fn get_state_into(&mut self, state: &mut State) -> Status {
        // SAFETY: the FMU's instance and state.
        unsafe { (self.api().get_fmu_state)(self.component, &mut state.pointer) }.into()
    }

    /// Restores a state.
    pub fn set_state(&mut self, state: &State) -> Status {
        // SAFETY: the FMU's instance and state.
        unsafe { (self.api().set_fmu_state)(self.component, state.pointer) }.into()
    }

    /// Gives a state's memory back.
    pub fn free_state(&mut self, mut state: State) -> Status {
        // SAFETY: the FMU's instance and state.
        unsafe { (self.api().free_fmu_state)(self.component, &mut state.pointer) }.into()
    }

    /// A state as bytes.
    ///
    /// # Errors
    /// The FMU does not give them.
    pub fn serialize(&mut self, state: &State) -> Result<Vec<u8>, HostError> {
        let mut size = 0;
        // SAFETY: the FMU's instance and state, and room for the answer.
        let status = unsafe { (self.api().serialized_fmu_state_size)(self.component, state.pointer, &mut size) }.into();
        self.expect_ok("fmi2SerializedFMUstateSize", status)?;
        let mut bytes = vec![0; size];
        // SAFETY: the FMU's instance and state, and the room that it asked for.
        let status =
            unsafe { (self.api().serialize_fmu_state)(self.component, state.pointer, bytes.as_mut_ptr(), size) }.into();
        self.expect_ok("fmi2SerializeFMUstate", status)?;
        Ok(bytes)
    }

    /// The state that bytes are.
    ///
    /// # Errors
    /// The FMU rejects them.
    pub fn deserialize(&mut self, bytes: &[u8]) -> Result<State, HostError> {
        let mut state = State { pointer: std::ptr::null_mut() };
        let (pointer, size) = (bytes.as_ptr(), bytes.len());
        // SAFETY: the FMU's instance, the bytes, and room for the answer.
        let status =
            unsafe { (self.api().deserialize_fmu_state)(self.component, pointer, size, &mut state.pointer) }.into();
        self.expect_ok("fmi2DeSerializeFMUstate", status)?;
        Ok(state)
    }
}
