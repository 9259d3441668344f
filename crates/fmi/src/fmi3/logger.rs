//! Messages to the host.

use moris_interface::Identity;

use super::LOG_CATEGORIES;
use super::Layout;
use super::types::{fmi3InstanceEnvironment, fmi3LogMessageCallback, fmi3Status};
use crate::abi::Host;
use crate::abi::pointers::c_string;
use crate::{LogCategory, Mode, Severity};

/// Destination of an instance's messages: errors unless the host switches them off by name,
/// warnings unless it switches them off, the others on request.
pub struct Logger {
    callback: Option<fmi3LogMessageCallback>,
    environment: fmi3InstanceEnvironment,
    events: bool,
    warnings: bool,
    discards: bool,
    errors: bool,
    /// Layout of the model description that the host has read.
    pub layout: Layout,
}

impl Logger {
    /// A logger of all categories or of errors alone, for a description with scalars until
    /// the host sets another.
    pub fn new(
        callback: Option<fmi3LogMessageCallback>,
        environment: fmi3InstanceEnvironment,
        logging_on: bool,
    ) -> Self {
        Logger {
            callback,
            environment,
            events: logging_on,
            warnings: true,
            discards: logging_on,
            errors: true,
            layout: Layout::Scalars,
        }
    }

    /// Switches a category on or off.
    pub fn switch(&mut self, category: LogCategory, on: bool) {
        match category {
            LogCategory::Events => self.events = on,
            LogCategory::Warning => self.warnings = on,
            LogCategory::Discard => self.discards = on,
            LogCategory::Error => self.errors = on,
            _ => {}
        }
    }

    /// Switches every category on, or all but errors off.
    pub fn switch_all(&mut self, on: bool) {
        let switched = LOG_CATEGORIES.iter().filter(|&&(category, _)| on || category != LogCategory::Error);
        switched.for_each(|&(category, _)| self.switch(category, on));
    }

    fn send(&self, status: fmi3Status, category: LogCategory, text: &str) {
        let Some(callback) = self.callback else { return };
        let category = c_string(category.name());
        // Hosts may read `#7#` as the name of variable 7; `##` is `#`.
        let text = c_string(&text.replace('#', "##"));
        // SAFETY: the host gave this function for this purpose, and the strings live until it returns.
        unsafe { callback(self.environment, status, category.as_ptr(), text.as_ptr()) }
    }
}

impl Host for Logger {
    type Status = fmi3Status;
    const OK: fmi3Status = fmi3Status::fmi3OK;
    const ERROR: fmi3Status = fmi3Status::fmi3Error;

    fn mode_name(mode: Mode) -> &'static str {
        if mode == Mode::StepComplete { "step mode" } else { mode.name() }
    }

    fn rename(&self, identity: &Identity, text: String) -> String {
        self.layout.rename(identity, text)
    }

    fn event(&self, text: &str) {
        if self.events {
            self.send(fmi3Status::fmi3OK, LogCategory::Events, text);
        }
    }

    fn warning(&self, text: &str) {
        if self.warnings {
            self.send(fmi3Status::fmi3Warning, LogCategory::Warning, text);
        }
    }

    fn failure(&self, severity: Severity, text: &str) -> fmi3Status {
        match severity {
            Severity::Discard => {
                if self.discards {
                    self.send(fmi3Status::fmi3Discard, LogCategory::Discard, text);
                }
                fmi3Status::fmi3Discard
            }
            Severity::Error => {
                if self.errors {
                    self.send(fmi3Status::fmi3Error, LogCategory::Error, text);
                }
                fmi3Status::fmi3Error
            }
        }
    }
}
