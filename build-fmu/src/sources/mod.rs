//! A model in C99, for tools that compile FMUs themselves.
//!
//! Nothing but `--sources` uses this folder: a reader of the FMU's shared library may skip it.
//!
//! The model's library is compiled to WebAssembly, with the functions of FMI as its exports. wasm2c
//! turns that into C. The files in `c/` are the rest: a runtime, and the functions of FMI
//! that copy arguments into the module's memory and back.

use std::ops::Range;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use moris_fmi::{Overrides, SectionError, embedded};

use crate::archive::Contents;
use crate::{Error, FmiVersion, FmuModel, Start, compile, library, tools, workspace};

const WEBASSEMBLY_TARGET: &str = "wasm32-unknown-unknown";
/// Places of the module's two files in an FMU.
const DECLARATIONS_PATH: &str = "sources/module.h";
const CODE_PATH: &str = "sources/module_code.h";

/// Output of wasm2c for a model's library, adapted to the runtime.
pub struct Sources {
    declarations: String,
    code: String,
}

/// Changes of wasm2c's code: each text, and what stands in its place. Each is there at least once.
///
/// The memory of a module stays where it is, so that a function reads its address once. Otherwise
/// the compiler would have to read it anew after each store, and a step would take twice the time.
const CODE_CHANGES: &[(&str, &str)] = &[
    // Not in C99, and not used.
    ("#include <alloca.h>\n", ""),
    // It would keep each loaded value in a general register, for a signal handler that is not there.
    ("#define wasm_asm __asm__", "#define wasm_asm(X)"),
    ("#define FUNC_PROLOGUE\n", "#define FUNC_PROLOGUE u8 *const memory = instance->w2c_memory.data; (void)memory\n"),
    ("(wasm_rt_memory_t* mem, u64 addr", "(u8* memory, u64 addr"),
    ("&mem->data[addr]", "&memory[addr]"),
    ("(&instance->w2c_memory, ", "(memory, "),
    ("wasm_rt_allocate_memory(memory, ", "wasm_rt_allocate_memory(&instance->w2c_memory, "),
    ("wasm_rt_grow_memory(memory, ", "wasm_rt_grow_memory(&instance->w2c_memory, "),
    ("memory_copy(memory, &instance->w2c_memory, ", "WASM_RT_COPY(memory, "),
    ("memory_fill(memory, ", "WASM_RT_FILL(memory, "),
    // C's functions do with NaN what WebAssembly's do.
    ("= wasm_fabs(", "= fabs("),
    ("= wasm_sqrt(", "= sqrt("),
    // Without a function of libm, which FMPy does not link. Larger numbers are whole.
    (
        "  return trunc(x);\n",
        "  return x > -4503599627370496.0 && x < 4503599627370496.0 ? copysign((double)(long long)x, x) : x;\n",
    ),
];

impl Sources {
    /// Compiles the model's library and turns it into C.
    ///
    /// # Errors
    /// A tool is missing, or fails.
    pub fn make(model: &FmuModel, fmi: FmiVersion) -> Result<Self, Error> {
        // The version of WABT whose output the runtime in `c/` serves.
        const WASM2C_VERSION: &str = "1.0.32";
        tools::wasm2c(WEBASSEMBLY_TARGET, WASM2C_VERSION)?;
        let directory = workspace::target_directory().join(WEBASSEMBLY_TARGET).join(compile::WEBASSEMBLY_PROFILE);
        let module = directory.join(format!("{}.wasm", model.library(fmi)));
        compile_to_webassembly(model, fmi)?;
        let bytes = fs::read(&module).map_err(|reason| Error::Read { file: module.clone(), reason })?;
        library::check_paths(&bytes, &workspace::private_paths()?)
            .map_err(|reason| Error::Sources { reason: reason.to_string() })?;
        let code = directory.join(model.library(fmi)).join("module.c");
        translate_to_c(model, &module, &code)?;
        let read =
            |file: &Path| fs::read_to_string(file).map_err(|reason| Error::Read { file: file.to_owned(), reason });
        // ISO C does not let a function without a result return one.
        let free = fmi.choose("w2c_fmi2FreeInstance(", "w2c_fmi3FreeInstance(");
        let code = changed_code(read(&code)?, CODE_CHANGES)?;
        let code = changed_code(code, &[(&format!("return {free}"), free)])?;
        Ok(Sources { declarations: read(&directory.join(model.library(fmi)).join("module.h"))?, code })
    }

    /// The sources among the files of an FMU.
    pub(crate) fn of_files(files: &Contents) -> Option<Self> {
        let text = |path: &str| Some(String::from_utf8_lossy(files.get(path)?).into_owned());
        Some(Sources { declarations: text(DECLARATIONS_PATH)?, code: text(CODE_PATH)? })
    }

    /// The start values in place of the model's own.
    pub(crate) fn embedded(&self, model: &FmuModel) -> Result<Overrides, SectionError> {
        embedded(&self.data().1, model.functions.identity.slots.len())
    }

    /// Writes start values in place of those that are there.
    pub(crate) fn embed(&mut self, model: &FmuModel, start: &Start) -> Result<(), SectionError> {
        let (places, mut bytes) = self.data();
        start.embed(model, &mut bytes)?;
        for (place, byte) in places.into_iter().zip(bytes) {
            self.code.replace_range(place, &format!("{byte:02x}"));
        }
        Ok(())
    }

    /// The module's constant data: the place of each byte's two digits in the code, and the byte.
    fn data(&self) -> (Vec<Range<usize>>, Vec<u8>) {
        let mut places = Vec::new();
        for (begin, _) in self.code.match_indices("static const u8 data_segment_data_") {
            let end = self.code[begin..].find("};").map_or(self.code.len(), |length| begin + length);
            let digits =
                |(place, prefix): (usize, &str)| begin + place + prefix.len()..begin + place + prefix.len() + 2;
            places.extend(self.code[begin..end].match_indices("0x").map(digits));
        }
        let byte = |place: &Range<usize>| u8::from_str_radix(self.code.get(place.clone())?, 16).ok();
        let bytes = places.iter().map(|place| byte(place).unwrap_or_default()).collect();
        (places, bytes)
    }

    /// The one file to compile.
    pub fn file(model: &FmuModel) -> String {
        format!("{}.c", model.name)
    }

    /// The files in an FMU.
    pub(crate) fn files(&self, model: &FmuModel, fmi: FmiVersion) -> Contents {
        let functions = fmi.choose(include_str!("c/fmi2.h"), include_str!("c/fmi3.h"));
        let file = Sources::file(model);
        let mut files = Contents::new();
        let mut add = |path: &str, text: &str| files.insert(path.to_owned(), text.as_bytes().to_vec());
        add(&format!("sources/{file}"), &include_str!("c/model.c").replace("MODEL_NAME", model.name));
        add("sources/functions.h", functions);
        add("sources/instance.h", include_str!("c/instance.h"));
        add("sources/wasm-rt.h", include_str!("c/wasm-rt.h"));
        add(DECLARATIONS_PATH, &self.declarations);
        add(CODE_PATH, &self.code);
        add("documentation/licenses/wabt.txt", include_str!("c/wabt.txt"));
        if let FmiVersion::Fmi3(_) = fmi {
            add(
                "sources/buildDescription.xml",
                &include_str!("c/buildDescription.xml").replace("MODEL_NAME", model.name),
            );
        }
        files
    }
}

/// Compiles the model's library to WebAssembly.
fn compile_to_webassembly(model: &FmuModel, fmi: FmiVersion) -> Result<(), Error> {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args([
        "build",
        "--target",
        WEBASSEMBLY_TARGET,
        "--profile",
        compile::WEBASSEMBLY_PROFILE,
        "--package",
        model.package(fmi),
        "--target-dir",
    ]);
    cargo.arg(workspace::target_directory()).current_dir(workspace::root());
    cargo.env("CARGO_ENCODED_RUSTFLAGS", compile::encoded(&compile::path_flags()?));
    run_program(cargo, "cargo")
}

/// Turns a module into C, under the model's name.
fn translate_to_c(model: &FmuModel, module: &Path, code: &Path) -> Result<(), Error> {
    let directory = code.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(directory).map_err(|reason| Error::Write { file: directory.to_owned(), reason })?;
    let mut wasm2c = Command::new("wasm2c");
    wasm2c.args(["--no-debug-names", "--module-name", model.name, "--output"]).arg(code).arg(module);
    run_program(wasm2c, "wasm2c")
}

fn run_program(mut command: Command, program: &str) -> Result<(), Error> {
    let status = command.status().map_err(|reason| Error::Run { program: program.to_owned(), reason })?;
    if status.success() { Ok(()) } else { Err(Error::Sources { reason: format!("{program} failed") }) }
}

fn changed_code(code: String, changes: &[(&str, &str)]) -> Result<String, Error> {
    changes.iter().try_fold(code, |code, (from, to)| {
        if code.contains(from) {
            Ok(code.replace(from, to))
        } else {
            Err(Error::Sources { reason: format!("wasm2c's code has no \"{}\"", from.trim()) })
        }
    })
}

#[cfg(test)]
mod tests {
    use moris_fmi::embed;

    use super::*;
    use crate::contents::Extras;
    use crate::model::WASHOUT;
    use crate::{Base, Platform, archive, base, contents};

    /// The place of start values, which will do for a library.
    fn place() -> Vec<u8> {
        let slots = WASHOUT.functions.identity.slots.len();
        let head = [b"moris-start-here".to_vec(), 1_u64.to_le_bytes().to_vec(), (slots as u64).to_le_bytes().to_vec()];
        let mut place = [head.concat(), vec![0xff; 8 * (slots + 1)]].concat();
        embed(&mut place, slots, &[]).unwrap();
        place
    }

    /// A module whose data is in two pieces: the second is nothing but the place of start values.
    fn sources() -> Sources {
        let list = |bytes: &[u8]| bytes.iter().map(|byte| format!("0x{byte:02x}, ")).collect::<String>();
        let code = format!(
            "static const u8 data_segment_data_w2c_d0[] = {{\n  {}}};\nx = 0xfe;\n\
             static const u8 data_segment_data_w2c_d1[] = {{\n  {}}};\ny = 0xab;\n",
            list(&[1, 2, 3]),
            list(&place())
        );
        Sources { declarations: String::new(), code }
    }

    #[test]
    fn start_values_are_written_into_the_data_and_nowhere_else() {
        let mut sources = sources();
        let own = sources.code.clone();
        assert_eq!(sources.embedded(&WASHOUT), Ok(vec![]));
        let start = Start::with(&WASHOUT, &vec![("gravity".to_owned(), 9.8)]).unwrap();
        sources.embed(&WASHOUT, &start).unwrap();
        let slot = WASHOUT.functions.identity.slot("gravity").unwrap();
        assert_eq!(sources.embedded(&WASHOUT), Ok(vec![(slot, 9.8)]));
        assert!(sources.code.contains("  0x01, 0x02, 0x03, };\nx = 0xfe;\n") && sources.code.ends_with("y = 0xab;\n"));
        sources.embed(&WASHOUT, &Start::own(&WASHOUT)).unwrap();
        assert_eq!(sources.code, own);
    }

    #[test]
    fn sources_of_a_base_start_as_its_libraries() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("with-sources.fmu");
        let (own, fmi) = (Start::own(&WASHOUT), FmiVersion::Fmi2);
        let start = Start::with(&WASHOUT, &vec![("gravity".to_owned(), 9.8)]).unwrap();
        let libraries = || vec![(Platform::Linux64, place())];
        let with = |sources| Extras { sources: Some(sources), ..Extras::default() };
        let packed = base::pack(&WASHOUT, &own, fmi, libraries(), with(sources())).unwrap();
        fs::write(&file, &packed).unwrap();
        // Opening the result shows that library, sources and description agree.
        fs::write(&file, Base::open(&file).unwrap().pack(&start).unwrap()).unwrap();
        assert!(Base::open(&file).unwrap().pack(&own).unwrap() == packed);

        let mut others = sources();
        others.embed(&WASHOUT, &start).unwrap();
        let mixed = contents::contents(&WASHOUT, &own, fmi, libraries(), &with(others));
        fs::write(&file, archive::pack(&mixed).unwrap()).unwrap();
        let refused = Base::open(&file).err().unwrap().to_string();
        assert!(refused.contains("different start values"), "{refused}");
    }

    #[test]
    fn code_of_another_kind_is_refused() {
        let nothing = Sources { declarations: String::new(), code: "int x;".to_owned() };
        assert_eq!(nothing.embedded(&WASHOUT), Err(SectionError::Missing));
        let error = changed_code("a b".to_owned(), &[("a", "c"), ("d", "e")]).unwrap_err();
        assert!(error.to_string().contains("has no \"d\""));
        assert_eq!(changed_code("a b a".to_owned(), &[("a", "c")]).unwrap(), "c b c");
    }
}
