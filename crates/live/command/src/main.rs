//! `moris-live`, the command.

use std::io::stdout;
use std::process::ExitCode;

use clap::Parser;
use moris_command_line::exit_status;
use moris_live_command::{Options, main as run};

#[derive(Parser)]
#[command(name = "moris-live", version = moris_pages::PACKAGE_VERSION)]
struct Arguments {
    #[command(flatten)]
    options: Options,
}

fn main() -> ExitCode {
    let out = &mut stdout();
    exit_status(run(&Arguments::parse().options, out), out)
}
