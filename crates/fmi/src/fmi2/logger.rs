//! Messages to the host.

use std::ffi::{CStr, CString};

use super::types::{fmi2CallbackFunctions, fmi2CallbackLogger, fmi2ComponentEnvironment, fmi2Status};
use crate::abi::Host;
use crate::abi::pointers::c_string;
use crate::{LogCategory, Mode, Severity};

/// Where an instance's messages go. Warnings and errors always do, events only
/// with debug logging on.
pub struct Logger {
    instance_name: CString,
    callback: Option<fmi2CallbackLogger>,
    environment: fmi2ComponentEnvironment,
    events: bool,
}

impl Logger {
    /// The logger of the instance of this name. Of the host's callbacks nothing but
    /// their contents is kept.
    pub fn new(instance_name: CString, callbacks: &fmi2CallbackFunctions, events: bool) -> Self {
        Logger { instance_name, callback: callbacks.logger, environment: callbacks.environment, events }
    }

    /// Switches events on and off.
    pub fn log_events(&mut self, events: bool) {
        self.events = events;
    }

    /// The text is an argument of the message `"%s"`, for hosts take the message as a format.
    fn send(&self, status: fmi2Status, category: LogCategory, text: &str) {
        let Some(callback) = self.callback else { return };
        let category = c_string(category.name());
        let text = c_string(text);
        let format: &CStr = c"%s";
        // SAFETY: the host gave this function for this purpose, and the strings live until it returns.
        unsafe {
            callback(
                self.environment,
                self.instance_name.as_ptr(),
                status,
                category.as_ptr(),
                format.as_ptr(),
                text.as_ptr(),
            );
        }
    }
}

impl Host for Logger {
    type Status = fmi2Status;
    const OK: fmi2Status = fmi2Status::fmi2OK;
    const ERROR: fmi2Status = fmi2Status::fmi2Error;

    fn mode_name(mode: Mode) -> &'static str {
        mode.name()
    }

    fn event(&self, text: &str) {
        if self.events {
            self.send(fmi2Status::fmi2OK, LogCategory::Events, text);
        }
    }

    fn warning(&self, text: &str) {
        self.send(fmi2Status::fmi2Warning, LogCategory::Warning, text);
    }

    fn failure(&self, severity: Severity, text: &str) -> fmi2Status {
        let (status, category) = match severity {
            Severity::Discard => (fmi2Status::fmi2Discard, LogCategory::Discard),
            Severity::Error => (fmi2Status::fmi2Error, LogCategory::Error),
        };
        self.send(status, category, text);
        status
    }
}
