//! Communication steps.

use moris_interface::Model;

use super::types::*;
use super::{Component, calling_sequence as function};
use crate::abi::call;
use crate::abi::pointers::answer;

/// Addresses for the results of a step.
pub struct StepAnswers {
    pub event_handling_needed: *mut fmi3Boolean,
    pub terminate_simulation: *mut fmi3Boolean,
    pub early_return: *mut fmi3Boolean,
    pub last_successful_time: *mut f64,
}

/// `fmi3DoStep`: a step is done as a whole, and neither needs event handling nor ends the
/// simulation.
#[inline]
pub unsafe fn do_step<M: Model>(instance: fmi3Instance, time: f64, step: f64, answers: &StepAnswers) -> fmi3Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's room for the answers, which is asked for before anything is done.
        unsafe {
            answer(answers.event_handling_needed, fmi3Boolean(0))?;
            answer(answers.terminate_simulation, fmi3Boolean(0))?;
            answer(answers.early_return, fmi3Boolean(0))?;
            answer(answers.last_successful_time, component.instance.time())?;
        }
        component.instance.step(time, step)?;
        // SAFETY: as above.
        unsafe { answer(answers.last_successful_time, component.instance.time()) }?;
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(instance, &function::DO_STEP, body) }
}
