//! Parses the arguments and runs one command.
//!
//! Exit code 0: done. 1: an error in the description or an input. 2: usage. 3: device or file system.

mod assignment;
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
mod limits;
mod list;
#[cfg(feature = "pictures")]
mod memory;
mod output;
mod page;
#[cfg(feature = "pictures")]
mod picture;
#[cfg(feature = "pictures")]
mod progress;
#[cfg(feature = "pictures")]
mod render;
#[cfg(feature = "pictures")]
mod rendering;
mod show;
#[cfg(feature = "pictures")]
mod statistics;
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
    /// List the techniques with their axes, memory, passes and soundness tier per target
    List(list::List),
    /// Show the plan of a description, its manifest, or its shaders for one target
    Show(show::Show),
    /// Print the reference of the closure language
    Language(language::Language),
    /// Write the passes of a description, or of every technique, for one or more targets
    Generate(generate::Generate),
    /// Check a technique against its specification in every interleaving of the fragments of one pixel
    Check(check::Check),
    /// Render a scene with one description and write the image
    #[cfg(feature = "pictures")]
    Render(render::Render),
    /// Render a scene with two techniques and measure the difference between the images
    #[cfg(feature = "pictures")]
    Compare(compare::Compare),
    /// List the devices that can render
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
