//! `fragbuf generate`: writes files and a manifest to a folder. Writing begins after everything is generated.

use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use fragbuf::{Form, Generation, Registry, Request, generate, manifest};
use fragbuf_targets::{c_header, c_name};

use super::assignment::assignment;
use super::earlier::EarlierFiles;
use super::input::Input;
use super::output::{self, Failure};
use super::watch::watch;
use super::{limits, targets};

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["description", "all"])))]
pub(crate) struct Generate {
    /// Technique key, .fragbuf file, or `-` for a description on stdin
    description: Option<String>,
    /// Generate every technique, each in a folder named after its key
    #[arg(long)]
    all: bool,
    /// Change the description: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Comma-separated targets, or `all`
    #[arg(long, required = true, value_delimiter = ',', value_name = "TARGETS")]
    target: Vec<String>,
    /// Write whole programs, or functions for your own shader
    #[arg(long, value_enum, default_value_t = FormArgument::Program)]
    form: FormArgument,
    /// Prefix of every generated name except entry points, so that two buffers can share a shader
    #[arg(long, default_value = "", value_parser = prefix)]
    prefix: String,
    /// Bind group (descriptor set, register space) of all declarations
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=31))]
    group: u32,
    /// Manifest of another buffer in the same shader: warns if both together exceed what every WebGPU device has
    #[arg(long, value_name = "MANIFEST")]
    with: Vec<PathBuf>,
    /// Also write bindings for a language beside the manifest. `c`: a header with constants, structs of the uniform blocks, sizes of buffers as
    /// functions, and the steps of a frame as tables, for C11 and C++17. Its names begin with the prefix, or else with the name of the description
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    bindings: Option<Language>,
    /// Output folder
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Remove files of earlier runs from the output folder, those for other targets, too: the files that its manifest lists and this run
    /// does not write
    #[arg(long)]
    clean: bool,
    /// Generate again whenever the description, or a user file that it names, changes. Ctrl-C ends
    #[arg(long)]
    watch: bool,
}

/// The languages of bindings that the command line writes. Those of Rust are written by build scripts.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Language {
    C,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum FormArgument {
    Program,
    Module,
}

impl Generate {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        if !self.watch {
            return self.generate(&mut Vec::new());
        }
        let registry = Registry::builtin();
        let description = self.description.iter().filter(|description| Input::is_file(description, &registry));
        let files = description.map(PathBuf::from).chain(self.with.iter().cloned()).collect();
        watch(files, "give a .fragbuf file", |files| self.generate(files))
    }

    /// Writes everything once, and adds the files that it reads to `files`.
    fn generate(&self, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
        if self.out.as_os_str() == "-" {
            let registry = Registry::builtin();
            let first = registry.techniques().first().map(|technique| technique.key.as_str());
            let description = self.description.as_deref().or(first).unwrap_or_default();
            let help = format!("`fragbuf show {description} --dump wgsl` prints the sources");
            return Err(Failure::Usage(format!("`generate` writes a folder, and `-` is none: {help}")));
        }
        Failure::unless_folder(&self.out)?;
        let registry = Registry::builtin();
        let targets = targets::several(&self.target)?;
        let form = match self.form {
            FormArgument::Program => Form::Program,
            FormArgument::Module => Form::Module,
        };
        let request = Request { targets: &targets, form, prefix: &self.prefix, group: self.group };
        let all = registry.techniques().iter().filter(|_| self.all).map(|technique| technique.key.clone());
        let (mut inputs, mut variants) = (Vec::new(), Vec::new());
        for argument in self.description.iter().cloned().chain(all) {
            let mut input = Input::read(&argument, &registry)?;
            if form == Form::Module {
                input = input.for_module();
            }
            let variant = input.variant(&self.set, &registry);
            files.extend_from_slice(input.files());
            variants.push(variant?);
            inputs.push((argument, input));
        }
        let mut folders: Vec<(PathBuf, Generation, Option<Header>)> = Vec::new();
        let generations = on_all_cores(&variants, |variant| generate(variant, &request, &registry));
        for (((argument, input), variant), generation) in inputs.into_iter().zip(&variants).zip(generations) {
            let generation = generation.map_err(|errors| input.failure(errors))?;
            if generation.plans.is_empty() && !self.all {
                return Err(targets::unsupported(&input, variant, &request, &self.set, &registry));
            }
            let folder = if self.all { self.out.join(&argument) } else { self.out.clone() };
            let header = self.bindings.filter(|_| !generation.plans.is_empty()).map(|Language::C| {
                let name = c_name(if self.prefix.is_empty() { stem(&argument, &registry) } else { &self.prefix });
                Header { text: c_header(&generation, &name, &argument, self.group), path: format!("{name}.h") }
            });
            folders.push((folder, generation, header));
        }
        if folders.iter().all(|(_, generation, _)| generation.plans.is_empty()) {
            return Err(Failure::Usage(NOTHING.to_owned()));
        }
        let others = self.with.iter().map(|path| limits::read(path)).collect::<Result<Vec<_>, _>>()?;
        limits::check_names(form, &self.prefix, self.group, &others)?;
        for (folder, generation, header) in &folders {
            limits::warn(generation, self.group, &others);
            let header_path = header.as_ref().map(|header| header.path.as_str());
            let earlier = EarlierFiles::find(folder, generation, header_path);
            if !generation.plans.is_empty() {
                self.write(folder, generation, header.as_ref(), &earlier)?;
            }
            match self.clean {
                true => earlier.remove()?,
                false => earlier.warn(&targets),
            }
            for (target, missing) in &generation.unsupported {
                output::warn(&format!("nothing written for {} in {}: {missing}", target.name, folder.display()));
            }
        }
        Ok(())
    }

    /// Writes every file once, and the manifest, which also lists the files of earlier runs that stay.
    fn write(
        &self,
        folder: &Path,
        generation: &Generation,
        header: Option<&Header>,
        earlier: &EarlierFiles,
    ) -> Result<(), Failure> {
        let mut seen: Vec<&str> = Vec::new();
        for file in &generation.files {
            if !seen.contains(&file.path.as_str()) {
                seen.push(&file.path);
                write_file(&folder.join(&file.path), &file.bytes)?;
            }
        }
        let mut manifest = manifest(generation, self.group);
        if let Some(Header { path, text }) = header {
            manifest["c_header"] = path.as_str().into();
            write_file(&folder.join(path), text.as_bytes())?;
        }
        if !self.clean {
            earlier.list_in(&mut manifest);
        }
        write_file(&folder.join("manifest.json"), output::json(&manifest).as_bytes())
    }
}

/// A header of C: its path in the output folder, and its content.
struct Header {
    path: String,
    text: String,
}

/// Returns the name of a description in bindings: the key of a technique, or the name of a file without its extension.
fn stem<'a>(description: &'a str, registry: &Registry) -> &'a str {
    match registry.technique(description) {
        Some(_) => description,
        None if description == "-" => "description",
        None => Path::new(description).file_stem().and_then(|stem| stem.to_str()).unwrap_or(description),
    }
}

/// Returns the result of `work` for each item, in the order of the items. A single item needs no thread.
pub(crate) fn on_all_cores<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    if items.len() < 2 {
        return items.iter().map(work).collect();
    }
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(items.len())));
    let worker = || {
        let indices = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        for (index, item) in indices.map_while(|index| Some((index, items.get(index)?))) {
            let result = work(item);
            results.lock().unwrap_or_else(PoisonError::into_inner).push((index, result));
        }
    };
    thread::scope(|scope| (0..cores.min(items.len())).for_each(|_| drop(scope.spawn(worker))));
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_unstable_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

/// The error if no technique can be written for any of the targets.
const NOTHING: &str = "none of the targets supports a technique in this form: choose other targets, `--form program` or `--group` from 0 to 3";

/// Parses a prefix: an identifier on every target, without a final underscore. The generator adds the underscore that
/// separates it from a name.
fn prefix(text: &str) -> Result<String, String> {
    let mut letters = text.chars();
    let starts_well = letters.next().is_none_or(|first| first.is_ascii_alphabetic());
    let is_plain = text.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if starts_well && is_plain && !text.ends_with('_') && !text.contains("__") {
        Ok(text.to_owned())
    } else {
        Err("write letters, digits and single underscores, beginning with a letter and not ending in `_`".to_owned())
    }
}

/// Writes a file, and creates its folder.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::files(folder, &error))?;
    }
    fs::write(path, bytes).map_err(|error| Failure::files(path, &error))
}
