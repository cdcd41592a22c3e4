//! The command line: `fragbuf list | show | generate`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
