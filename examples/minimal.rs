//! The smallest program: generates the passes of a description and prints the store pass in WGSL.
//!
//! `cargo run --example minimal`

use std::io::Write as _;
use std::process::ExitCode;

use fragbuf::{Form, Registry, Request, check, generate, parse, target};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // `Result` as the type of `main` prints the `Debug` form. There is no other stream to report a failure of this one on.
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn std::error::Error>> {
    let text = "buffer Nearest from kplus_array { keep 4; }";
    let parsed = parse(text, "nearest.fragbuf");
    let draft = parsed.draft.filter(|_| parsed.diagnostics.is_empty()).ok_or_else(|| parsed.diagnostics.to_string())?;
    let registry = Registry::builtin();
    let variant = check(&draft, &registry).map_err(|errors| errors.to_string())?;

    let wgsl = target("wgsl").ok_or("no such target")?;
    let request = Request { targets: &[wgsl], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).map_err(|errors| errors.to_string())?;
    for file in generation.files.iter().filter(|file| file.pass == "store") {
        std::io::stdout().write_all(&file.bytes)?;
    }
    Ok(())
}
