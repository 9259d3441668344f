//! Communication steps.

use moris_interface::Model;

use super::Component;
use super::types::*;
use crate::CallError;
use crate::abi::pointers::answer;

/// Addresses for the results of a step.
pub struct StepOutcome {
    pub event_handling_needed: *mut fmi3Boolean,
    pub terminate_simulation: *mut fmi3Boolean,
    pub early_return: *mut fmi3Boolean,
    pub last_successful_time: *mut f64,
}

/// `fmi3DoStep`: a step is done as a whole, and neither needs event handling nor ends the
/// simulation.
#[inline]
pub unsafe fn do_step<M: Model>(
    component: &mut Component<M>,
    time: f64,
    step: f64,
    outcome: &StepOutcome,
) -> Result<(), CallError> {
    // SAFETY: the host's memory for the outcome, checked before anything is done.
    unsafe {
        answer(outcome.event_handling_needed, fmi3Boolean(0))?;
        answer(outcome.terminate_simulation, fmi3Boolean(0))?;
        answer(outcome.early_return, fmi3Boolean(0))?;
        answer(outcome.last_successful_time, component.instance.time())?;
    }
    component.instance.step(time, step)?;
    // SAFETY: as above.
    unsafe { answer(outcome.last_successful_time, component.instance.time()) }?;
    Ok(())
}
