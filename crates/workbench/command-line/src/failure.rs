//! The end of a command: its exit status, and its error in words.

use std::io::{ErrorKind, Write, stderr};
use std::process::ExitCode;

use anyhow::Result;

use crate::words;

/// Exit status of a command after its output is written. Prints an error to standard error. A
/// reader of the output that is gone, such as `head`, is no error.
pub fn exit_status(result: Result<ExitCode>, out: &mut dyn Write) -> ExitCode {
    match result.and_then(|code| Ok(out.flush().map(|()| code)?)) {
        Ok(code) => code,
        Err(error) if nobody_reads_on(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // The reader may be gone.
            let _ = writeln!(stderr(), "error: {}", shortened_lines(&with_causes(&error)));
            ExitCode::FAILURE
        }
    }
}

/// The error and its causes; a cause that the text before it has said is left out.
fn with_causes(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(words::error) {
        if !text.contains(cause.trim_end()) {
            text += if text.is_empty() { "" } else { ": " };
            text += &cause;
        }
    }
    text
}

/// The text with its lines cut at a length: some errors quote a line of a file.
fn shortened_lines(text: &str) -> String {
    const LONGEST: usize = 2000;
    let cut = |line: &str| match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", &line[..end]),
        None => line.to_owned(),
    };
    text.lines().map(cut).collect::<Vec<_>>().join("\n")
}

/// True if the reader of the output, such as `head`, has closed it.
fn nobody_reads_on(error: &anyhow::Error) -> bool {
    error.downcast_ref::<std::io::Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}
