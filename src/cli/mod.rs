//! Arguments in, exit code out. 0: done; 1: the description or an input is at fault; 2: usage; 3: device or file system.

#[cfg(feature = "pictures")]
mod attributes;
mod check;
#[cfg(feature = "pictures")]
mod compare;
#[cfg(feature = "pictures")]
mod device;
#[cfg(feature = "pictures")]
mod devices;
mod generate;
mod input;
mod language;
mod list;
mod output;
mod page;
#[cfg(feature = "pictures")]
mod paint;
#[cfg(feature = "pictures")]
mod picture;
#[cfg(feature = "pictures")]
mod progress;
#[cfg(feature = "pictures")]
mod render;
mod show;
mod table_1;
#[cfg(feature = "pictures")]
mod uniforms;
#[cfg(feature = "pictures")]
mod view;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use output::Failure;

#[derive(Parser)]
#[command(name = "fragbuf", version, about = "Fragment buffers as GPU passes in WGSL, GLSL and SPIR-V")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// The techniques: axes, memory, passes, and the soundness tier on each target
    List(list::List),
    /// One description: its plan, or any stage of its way to a target
    Show(show::Show),
    /// The reference of the closure language
    Language(language::Language),
    /// Writes the passes of a description, or of every technique, for one or more targets
    Generate(generate::Generate),
    /// Every order in which the fragments of one pixel can run: does a technique keep what it promises?
    Check(check::Check),
    /// A picture of a scene through one description
    #[cfg(feature = "pictures")]
    Render(render::Render),
    /// Two techniques on the same scene: how far their pictures are apart
    #[cfg(feature = "pictures")]
    Compare(compare::Compare),
    /// The adapters that can render
    #[cfg(feature = "pictures")]
    Devices(devices::Devices),
}

pub(crate) fn run() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::List(list) => list.run(),
        Command::Show(show) => show.run(),
        Command::Language(language) => language.run(),
        Command::Generate(generate) => generate.run(),
        Command::Check(check) => return check.run().unwrap_or_else(Failure::report),
        #[cfg(feature = "pictures")]
        Command::Render(render) => render.run(),
        #[cfg(feature = "pictures")]
        Command::Compare(compare) => compare.run(),
        #[cfg(feature = "pictures")]
        Command::Devices(devices) => devices.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// `axis=value`, `axis.option=value` or `k=8`.
fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write name=value: an axis (sort=none), an option (sync.limit=9), or k=8".to_owned()),
    }
}
