//! `fragbuf generate`: files and a manifest under a folder. Everything is generated before anything is written.

use std::fs;
use std::path::{Path, PathBuf};

use fragbuf::{Form, Generation, Registry, Request, TARGETS, Target, generate, manifest, target};

use super::input::Input;
use super::output::{self, Failure};

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["description", "all"])))]
pub(crate) struct Generate {
    /// A technique's key, or a .fragbuf file
    description: Option<String>,
    /// Every technique, each in a folder of its key
    #[arg(long)]
    all: bool,
    /// Changes the description: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = super::assignment)]
    set: Vec<(String, String)>,
    /// Targets, joined by commas, or `all`
    #[arg(long, required = true, value_delimiter = ',', value_name = "TARGETS")]
    target: Vec<String>,
    /// Whole programs, or functions for a shader of your own
    #[arg(long, value_enum, default_value_t = FormArgument::Program)]
    form: FormArgument,
    /// Goes before every name but the entry points', so that two buffers can share a shader
    #[arg(long, default_value = "", value_parser = prefix)]
    prefix: String,
    /// The bind group (descriptor set, register space) of everything declared
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=31))]
    group: u32,
    /// The folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum FormArgument {
    Program,
    Module,
}

impl Generate {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        let targets = targets(&self.target)?;
        let form = match self.form {
            FormArgument::Program => Form::Program,
            FormArgument::Module => Form::Module,
        };
        let request = Request { targets: &targets, form, prefix: &self.prefix, group: self.group };
        let all = registry.techniques().iter().filter(|_| self.all).map(|technique| technique.key.clone());
        let mut folders: Vec<(PathBuf, Generation)> = Vec::new();
        for argument in self.description.iter().cloned().chain(all) {
            let mut input = Input::read(&argument, &registry)?;
            let variant = input.variant(&self.set, &registry)?;
            let generation = generate(&variant, &request, &registry).map_err(|faults| input.failure(faults))?;
            if generation.plans.is_empty() {
                return Err(refused(&argument, &generation));
            }
            let folder = if self.all { self.out.join(&argument) } else { self.out.clone() };
            folders.push((folder, generation));
        }
        for (folder, generation) in &folders {
            write(folder, generation, self.group)?;
            for (target, refusal) in &generation.refusals {
                output::warn(&format!("nothing written for {} in {}: {refusal}", target.name, folder.display()));
            }
        }
        Ok(())
    }
}

/// No target that was asked for can express the description.
fn refused(description: &str, generation: &Generation) -> Failure {
    let reasons: Vec<String> =
        generation.refusals.iter().map(|(target, refusal)| format!("{}: {refusal}", target.name)).collect();
    let origin = fragbuf::Origin::new(description, 1, 1);
    let diagnostic = fragbuf::Diagnostic::new(
        fragbuf_model::codes::TARGET,
        &origin,
        format!("none of the targets can express it: {}", reasons.join("; ")),
        "choose other targets, `--form program`, or add `else` alternatives to the axis",
    );
    Failure::Description(diagnostic.into(), Vec::new())
}

fn targets(names: &[String]) -> Result<Vec<&'static Target>, Failure> {
    if names.iter().any(|name| name == "all") {
        return Ok(TARGETS.iter().collect());
    }
    let mut targets: Vec<&'static Target> = Vec::new();
    for name in names {
        let Some(found) = target(name.trim()) else {
            let known: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
            return Err(Failure::Usage(format!("no target `{name}`: give all, or some of {}", known.join(","))));
        };
        if !targets.iter().any(|target| target.name == found.name) {
            targets.push(found);
        }
    }
    Ok(targets)
}

/// An identifier of every target's, without a final underscore: the underscore that parts it from a name is added.
fn prefix(text: &str) -> Result<String, String> {
    let mut letters = text.chars();
    let starts = letters.next().is_none_or(|first| first.is_ascii_alphabetic());
    let goes_on = text.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if starts && goes_on && !text.ends_with('_') && !text.contains("__") {
        Ok(text.to_owned())
    } else {
        Err("letters, digits and single underscores, beginning with a letter and not ending in `_`".to_owned())
    }
}

fn write(folder: &Path, generation: &Generation, group: u32) -> Result<(), Failure> {
    let mut seen: Vec<&str> = Vec::new();
    for file in &generation.files {
        if !seen.contains(&file.path.as_str()) {
            seen.push(&file.path);
            write_file(&folder.join(&file.path), &file.bytes)?;
        }
    }
    write_file(&folder.join("manifest.json"), output::json(&manifest(generation, group)).as_bytes())
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::files(folder, &error))?;
    }
    fs::write(path, bytes).map_err(|error| Failure::files(path, &error))
}
