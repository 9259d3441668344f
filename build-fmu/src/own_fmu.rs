//! An FMU that starts with other values than the one that it is made from.

use std::path::{Path, PathBuf};

use crate::{Base, Error, FormOptions, Start, StartOptions, write_whole};

/// A base with start values, ready to be written.
pub struct OwnFmu {
    base_file: PathBuf,
    base: Base,
    start: Start,
}

impl OwnFmu {
    /// Opens the base, for an FMU in this form, and reads the values.
    ///
    /// # Errors
    /// The base or the values cannot be used.
    pub fn new(base_file: &Path, options: &StartOptions, form: FormOptions) -> Result<Self, Error> {
        let base = Base::open(base_file)?.in_form(form)?;
        let start = options.of_models(&[base.model])?.remove(0);
        Ok(OwnFmu { base_file: base_file.to_owned(), base, start })
    }

    /// Lines about its start values.
    pub fn notes(&self) -> Vec<String> {
        let model = self.base.model;
        let platforms: Vec<String> = self.base.platforms().map(|platform| platform.to_string()).collect();
        let count =
            format!("{}: {} start values of your own, for {}", model.name, self.start.count(), platforms.join(", "));
        let warnings = (model.functions.warnings)(self.start.slots()).into_iter();
        [count].into_iter().chain(warnings.map(|warning| format!("warning: {warning}"))).collect()
    }

    /// Writes the FMU into a directory, under its usual name. Returns the file.
    ///
    /// # Errors
    /// The file would be the base itself, or cannot be written.
    pub fn write(self, output: &Path) -> Result<PathBuf, Error> {
        let file = output.join(self.base.fmi.fmu_file(self.base.model.name));
        if file.canonicalize().is_ok_and(|file| self.base_file.canonicalize().is_ok_and(|base| base == file)) {
            let reason = "is the base; choose another directory with --output".to_owned();
            return Err(Error::Base { file, reason });
        }
        write_whole(&file, &self.base.pack(&self.start)?)?;
        Ok(file)
    }
}
