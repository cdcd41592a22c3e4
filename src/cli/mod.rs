//! Parses the arguments and runs one command.
//!
//! Exit code 0: done. 1: an error in the description or an input. 2: usage. 3: device or file system.

#[cfg(feature = "pictures")]
mod animated_image;
#[cfg(feature = "pictures")]
mod animation;
#[cfg(feature = "pictures")]
mod arrangement;
mod assignment;
#[cfg(feature = "pictures")]
mod attributes;
#[cfg(feature = "pictures")]
mod camera;
mod check;
#[cfg(feature = "pictures")]
mod compare;
mod completions;
#[cfg(feature = "pictures")]
mod coplanarity;
#[cfg(feature = "pictures")]
mod device;
#[cfg(feature = "pictures")]
mod devices;
mod earlier;
#[cfg(feature = "pictures")]
mod effects;
mod explain;
#[cfg(feature = "figures")]
mod figure;
mod generate;
#[cfg(feature = "pictures")]
mod image_file;
mod input;
mod language;
mod limits;
mod list;
mod lsp;
mod manual;
#[cfg(feature = "pictures")]
mod memory;
mod new;
mod output;
mod page;
mod paper_table;
#[cfg(feature = "pictures")]
mod picture;
#[cfg(feature = "playground")]
mod playground;
#[cfg(feature = "pictures")]
mod predict;
#[cfg(feature = "pictures")]
mod progress;
mod progress_line;
#[cfg(feature = "pictures")]
mod render;
#[cfg(feature = "pictures")]
mod rendered_texture;
#[cfg(feature = "pictures")]
mod rendering;
#[cfg(feature = "pictures")]
mod scene_data;
mod show;
#[cfg(feature = "playground")]
mod site;
#[cfg(feature = "pictures")]
mod size;
#[cfg(feature = "pictures")]
mod statistics;
mod table_1;
mod targets;
#[cfg(feature = "pictures")]
mod uniforms;
mod usage;
#[cfg(feature = "pictures")]
mod view;
mod watch;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};

use output::{ColorChoice, Failure, MessageFormat};

#[derive(Parser)]
#[command(name = "fragbuf", version, about = "Fragment buffers as GPU passes in WGSL, GLSL and SPIR-V")]
struct Arguments {
    /// Format of errors and warnings on stderr. `json`: one object per line
    #[arg(long, global = true, value_enum, default_value_t, value_name = "FORMAT", help_heading = "Messages")]
    message_format: MessageFormat,
    /// Colours of errors and warnings. `auto`: on a terminal, unless the environment has NO_COLOR
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN", help_heading = "Messages")]
    message_color: ColorChoice,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List the techniques with their axes, memory, passes and soundness tier per target
    List(list::List),
    /// Create a crate with a description, a build script that generates its passes, and a program that lists them
    New(new::New),
    /// Show the plan of a description, its manifest, or its shaders for one target
    Show(show::Show),
    /// Print the reference of the closure language
    Language(language::Language),
    /// Explain a diagnostic or a counter: its cause and the fix, for most an example
    Explain(explain::Explain),
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
    /// Predict k for a scene from a memory budget and a hit ratio
    #[cfg(feature = "pictures")]
    Predict(predict::Predict),
    /// List the devices that can render
    #[cfg(feature = "pictures")]
    Devices(devices::Devices),
    /// Repeat an experiment of a paper: write its measurements (CSV) and chart (SVG), and compare the trend with the paper's
    #[cfg(feature = "figures")]
    Figure(figure::Figure),
    /// Open a page to edit a description, see its picture, its cost and its text, and check it
    #[cfg(feature = "playground")]
    Playground(playground::Playground),
    /// Write static pages: a gallery, a page per technique, and a player that draws pre-generated variants by WebGPU
    #[cfg(feature = "playground")]
    Site(site::Site),
    /// Answer an editor by the Language Server Protocol, on stdin and stdout
    Lsp(lsp::Lsp),
    /// Print the completions for a shell
    Completions(completions::Completions),
    /// Print the manual page, or write one page per command
    Man(manual::Manual),
}

pub(crate) fn run() -> ExitCode {
    let words = std::env::args_os().collect();
    #[cfg(feature = "pictures")]
    let words = effects::with_arguments(words);
    let arguments = Arguments::try_parse_from::<Vec<OsString>, _>(words).unwrap_or_else(|error| {
        let given: Vec<String> = std::env::args().collect();
        usage::explained(error, &given, &Arguments::command()).exit()
    });
    output::set_messages(arguments.message_format, arguments.message_color);
    let result = match arguments.command {
        Command::List(list) => list.run(),
        Command::New(new) => new.run(),
        Command::Show(show) => show.run(),
        Command::Language(language) => language.run(),
        Command::Explain(explain) => explain.run(),
        Command::Completions(completions) => completions.run(),
        Command::Man(manual) => manual.run(),
        Command::Generate(generate) => generate.run(),
        Command::Lsp(lsp) => return lsp.run().unwrap_or_else(Failure::report),
        Command::Check(check) => return check.run().unwrap_or_else(Failure::report),
        #[cfg(feature = "pictures")]
        Command::Render(render) => render.run(),
        #[cfg(feature = "pictures")]
        Command::Compare(compare) => compare.run(),
        #[cfg(feature = "pictures")]
        Command::Predict(predict) => predict.run(),
        #[cfg(feature = "pictures")]
        Command::Devices(devices) => devices.run(),
        #[cfg(feature = "figures")]
        Command::Figure(figure) => figure.run(),
        #[cfg(feature = "playground")]
        Command::Playground(playground) => playground.run(),
        #[cfg(feature = "playground")]
        Command::Site(site) => site.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
