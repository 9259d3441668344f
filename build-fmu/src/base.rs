//! An FMU as the base of another with other start values: its libraries are taken as they are but
//! for these values. Nothing is compiled.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use moris_fmi::{Overrides, SectionError, embedded};
use moris_fmu_host::files::unpack;
use quick_xml::de::from_str;
use serde::Deserialize;

use crate::contents::Extras;
use crate::{
    Error, FMU_MODELS, FmiVersion, FmuModel, FormOptions, Platform, Sources, Start, archive, code_signature, contents,
    terminals,
};

/// Path of the description in an FMU.
const MODEL_DESCRIPTION: &str = "modelDescription.xml";

/// An FMU that others may have made, as it is and as its files.
pub struct Unpacked {
    /// The archive.
    pub bytes: Vec<u8>,
    /// The files, by their paths.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Unpacked {
    /// Reads an FMU up to a bound.
    ///
    /// # Errors
    /// The file cannot be read, is too large, or is no archive.
    pub fn open(file: &Path) -> Result<Self, Error> {
        // Largest FMU that is read, packed or unpacked [bytes].
        const MAX_FMU_SIZE: u64 = 256_000_000;
        let bytes = moris_fmu_host::files::bytes(file, MAX_FMU_SIZE)
            .map_err(|reason| Error::Read { file: file.to_owned(), reason })?;
        let files = unpack(&bytes, MAX_FMU_SIZE)
            .map_err(|error| Error::Base { file: file.to_owned(), reason: format!("cannot be unpacked: {error}") })?;
        Ok(Unpacked { bytes, files })
    }

    /// The text of the description.
    ///
    /// # Errors
    /// There is none: the reason, as a part of a sentence.
    pub fn model_description(&self) -> Result<Cow<'_, str>, String> {
        let text = self.files.get(MODEL_DESCRIPTION).ok_or_else(|| format!("has no {MODEL_DESCRIPTION}"))?;
        Ok(String::from_utf8_lossy(text))
    }
}

/// A model's libraries, by platform, and the extras, without start values in
/// place of the model's own.
pub struct Base {
    pub model: &'static FmuModel,
    pub fmi: FmiVersion,
    libraries: Vec<(Platform, Vec<u8>)>,
    extras: Extras,
}

/// The attributes of `modelDescription.xml` that tell models and versions apart.
#[derive(Deserialize)]
struct Root {
    #[serde(rename = "@fmiVersion")]
    fmi_version: String,
    #[serde(rename = "@modelName")]
    model_name: String,
    #[serde(rename = "@version", default)]
    version: String,
    #[serde(rename = "@guid", alias = "@instantiationToken")]
    token: String,
}

impl Base {
    /// Reads an FMU.
    ///
    /// # Errors
    /// The file is no FMU of this program's models, of another version, damaged, or put
    /// together from several FMUs.
    pub fn open(file: &Path) -> Result<Self, Error> {
        let unpacked = Unpacked::open(file)?;
        Self::of(&unpacked).map_err(|reason| Error::Base { file: file.to_owned(), reason })
    }

    fn of(unpacked: &Unpacked) -> Result<Self, String> {
        let files = &unpacked.files;
        let root: Root = from_str(&unpacked.model_description()?)
            .map_err(|error| format!("has a {MODEL_DESCRIPTION} that cannot be read: {error}"))?;
        let model = FMU_MODELS.iter().find(|model| model.name == root.model_name);
        let model =
            model.ok_or_else(|| format!("is of the model {}, which this program does not know", root.model_name))?;
        let identity = &model.functions.identity;
        if root.version != identity.version {
            let (theirs, ours) = (root.version, identity.version);
            return Err(format!("is of version {theirs}, but this program packs {ours}; take both from one release"));
        }
        let other_build =
            || "is of another build of this version than this program; take both from one release".to_owned();
        let versions: Vec<FmiVersion> =
            FmiVersion::ALL.iter().copied().filter(|fmi| fmi.number() == root.fmi_version).collect();
        let first = versions.first().ok_or_else(|| format!("is of FMI {}", root.fmi_version))?;
        let library = |&platform: &Platform| {
            let path = format!("binaries/{}/{}", platform.directory(*first), platform.packed_library(model.name));
            Some((platform, files.get(&path)?.clone()))
        };
        let libraries: Vec<(Platform, Vec<u8>)> = Platform::ALL.iter().filter_map(library).collect();
        let sources = Sources::of_files(files);
        let start = |what: &str, overrides: Result<Overrides, SectionError>| {
            let overrides = overrides.map_err(|error| match error {
                SectionError::Missing => format!("has {what} without a place for start values"),
                SectionError::Version => other_build(),
                SectionError::Damaged => format!("has {what} whose start values are damaged"),
            });
            overrides.map(|overrides| Start::of_library(model, overrides))
        };
        let of_library = |(platform, library): &(Platform, Vec<u8>)| {
            start(&format!("a library for {platform}"), embedded(library, identity.slots.len()))
        };
        let of_sources = sources.iter().map(|sources| start("sources", sources.embedded(model)));
        let starts: Vec<Start> = libraries.iter().map(of_library).chain(of_sources).collect::<Result<_, _>>()?;
        let start = starts.first().ok_or("has no library for a platform that this program knows")?;
        // The description's token follows from the model, its start values and the layout.
        let fmi = versions.into_iter().find(|&fmi| model.token(fmi, start) == root.token).ok_or_else(other_build)?;
        if starts.iter().any(|other| other != start) {
            return Err("has libraries with different start values; it is put together from several FMUs".to_owned());
        }
        let extras = Extras { sources, terminals: files.contains_key(terminals::TERMINALS_PATH) };
        Ok(Base { model, fmi, libraries, extras })
    }

    /// The same in this form, beside its own.
    ///
    /// # Errors
    /// The base is not of FMI 2.0, which alone has reals only.
    pub fn in_form(mut self, form: FormOptions) -> Result<Self, Error> {
        self.fmi = form.of(self.fmi)?;
        self.extras.terminals |= form.terminals;
        Ok(self)
    }

    /// The same with these sources in place of its own.
    pub fn with_sources(mut self, sources: Sources) -> Self {
        self.extras.sources = Some(sources);
        self
    }

    /// The platforms that the FMU is for.
    pub fn platforms(&self) -> impl Iterator<Item = Platform> {
        self.libraries.iter().map(|(platform, _)| *platform)
    }

    /// Packs the FMU with these start values.
    ///
    /// # Errors
    /// The archive would be too large.
    pub fn pack(self, start: &Start) -> Result<Vec<u8>, Error> {
        pack(self.model, start, self.fmi, self.libraries, self.extras)
    }
}

/// Packs an FMU of these libraries and extras, with start values that replace those in them.
///
/// # Errors
/// A library or the sources have no place for them, or the archive would be too large.
pub fn pack(
    model: &FmuModel,
    start: &Start,
    fmi: FmiVersion,
    mut libraries: Vec<(Platform, Vec<u8>)>,
    mut extras: Extras,
) -> Result<Vec<u8>, Error> {
    for (platform, library) in &mut libraries {
        start.embed(model, library).map_err(|_| Error::NoPlace { platform: *platform })?;
        code_signature::renew(library);
    }
    if let Some(sources) = &mut extras.sources {
        sources.embed(model, start).map_err(|_| Error::Sources { reason: "no place for start values".to_owned() })?;
    }
    archive::pack(&contents::contents(model, start, fmi, libraries, &extras))
}
