//! Reads the first argument of most commands: the key of a technique, the file of a description, or `-` for a description on stdin.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use fragbuf::load::{Description, SET, load};
use fragbuf::{Diagnostic, Diagnostics, Registry, Variant, source_file};
use fragbuf_model::{SourceSpan, codes, nearest_name};

use super::output::{self, Failure};

/// The argument for the description on stdin.
const STDIN: &str = "-";

/// The description on stdin, which can be read once. Commands that draw several frames read their input for each.
static STDIN_TEXT: OnceLock<std::io::Result<String>> = OnceLock::new();

/// A description as given, and the sources that its diagnostics quote.
pub(crate) struct Input {
    description: Description,
    sources: Vec<(String, String)>,
    /// The files of the description and of its rows, as far as they were read.
    files: Vec<PathBuf>,
    /// The warnings that are printed already: `render` loads a description once per redraw.
    warned: Vec<Diagnostic>,
    /// The changes after the first of this number come from another option than `--set`.
    other_option: Option<(usize, &'static str)>,
    /// Whether the caller's own shader may read attributes that the description does not.
    is_module: bool,
}

impl Input {
    /// Reads the technique of this key, the file of this name, or stdin. Paths in a description on stdin are relative to the current folder.
    pub(crate) fn read(argument: &str, registry: &Registry) -> Result<Self, Failure> {
        let path = Path::new(argument);
        if argument.trim().is_empty() {
            let help = "give the key of a technique, which `fragbuf list` lists, or a .fragbuf file";
            return Err(Failure::Usage(format!("the name of the description is empty: {help}")));
        }
        if argument == STDIN {
            let text = STDIN_TEXT.get_or_init(|| source_file::read_stream(std::io::stdin().lock()));
            let text = text.as_ref().map_err(|error| Failure::source(Path::new("stdin"), error))?;
            return Ok(Input::of(Description::Text { file: "stdin".to_owned(), text: text.clone() }));
        }
        if registry.technique(argument).is_none() {
            other_file(argument, path, registry)?;
        }
        if !Input::is_file(argument, registry) {
            return Ok(Input::of(Description::Technique(argument.to_owned())));
        }
        let text = source_file::read(path).map_err(|error| Failure::source(path, &error))?;
        let description = Description::Text { file: argument.to_owned(), text };
        Ok(Input::of(description))
    }

    /// Returns whether the argument names a file, and not a technique.
    pub(crate) fn is_file(argument: &str, registry: &Registry) -> bool {
        let path = Path::new(argument);
        let is_file =
            path.extension().is_some_and(|extension| extension == "fragbuf") || (path.exists() && !path.is_dir());
        is_file && registry.technique(argument).is_none()
    }

    /// Returns a description of this program.
    #[cfg(feature = "pictures")]
    pub(crate) fn text(name: &str, text: &str) -> Self {
        Input::of(Description::Text { file: name.to_owned(), text: text.to_owned() })
    }

    fn of(description: Description) -> Self {
        Input {
            description,
            sources: Vec::new(),
            files: Vec::new(),
            warned: Vec::new(),
            other_option: None,
            is_module: false,
        }
    }

    /// Names the option of the changes after the first `count` in messages.
    #[cfg(feature = "pictures")]
    pub(crate) fn with_option_after(self, count: usize, option: &'static str) -> Self {
        Input { other_option: Some((count, option)), ..self }
    }

    /// Prints no warning of attributes, which the caller's own shader may read.
    pub(crate) fn for_module(self) -> Self {
        Input { is_module: true, ..self }
    }

    /// Returns the description as given.
    pub(crate) fn description(&self) -> &Description {
        &self.description
    }

    /// Returns the files that the last variant was read from; none if it is a technique.
    pub(crate) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Returns the variant, after `--set`.
    pub(crate) fn variant(&mut self, set: &[(String, String)], registry: &Registry) -> Result<Variant, Failure> {
        self.variant_with_defaults(set, &[], registry)
    }

    /// Returns the variant, after `--set`. `defaults` apply to axes on which neither the description nor `--set` chooses.
    pub(crate) fn variant_with_defaults(
        &mut self,
        set: &[(String, String)],
        defaults: &[(&str, &str)],
        registry: &Registry,
    ) -> Result<Variant, Failure> {
        let loaded = load(&self.description, set, defaults, registry);
        self.sources = self.with_options(loaded.all_sources());
        if let Description::Text { .. } = &self.description {
            self.files = loaded.sources.iter().map(|(file, _)| PathBuf::from(file)).collect();
        }
        let variant = loaded.variant.map_err(|diagnostics| self.failure(diagnostics))?;
        self.warn(&variant);
        Ok(variant)
    }

    /// Prints the warnings that are not printed yet.
    fn warn(&mut self, variant: &Variant) {
        let is_printed = |warning: &&Diagnostic| {
            !(self.warned.contains(warning) || self.is_module && warning.code == codes::UNUSED_ATTRIBUTE)
        };
        let new: Vec<Diagnostic> = variant.warnings.iter().filter(is_printed).cloned().collect();
        output::warnings(&self.at_options(&new.iter().cloned().collect()), &self.sources);
        self.warned.extend(new);
    }

    /// Returns the failure for `diagnostics`, with the sources of this input.
    pub(crate) fn failure(&self, diagnostics: Diagnostics) -> Failure {
        Failure::Description(self.at_options(&diagnostics), self.sources.clone())
    }

    /// Divides the source of the changes by the options that gave them.
    fn with_options(&self, mut sources: Vec<(String, String)>) -> Vec<(String, String)> {
        let Some((count, option)) = self.other_option else { return sources };
        for index in 0..sources.len() {
            let Some((_, text)) = sources.get_mut(index).filter(|(name, _)| name == SET) else { continue };
            let end = text.split_inclusive('\n').take(count).map(str::len).sum();
            let others = text.split_off(end);
            sources.push((option.to_owned(), others));
        }
        sources
    }

    /// Moves spans in the changes to the options that gave them.
    fn at_options(&self, diagnostics: &Diagnostics) -> Diagnostics {
        let Some((count, option)) = self.other_option else { return diagnostics.clone() };
        let moved = |span: &mut SourceSpan| {
            let line = (span.line as usize).saturating_sub(count);
            if &*span.file == SET && line > 0 {
                (span.file, span.line) = (option.into(), line as u32);
            }
        };
        let of_options = |diagnostic: &Diagnostic| {
            let mut diagnostic = diagnostic.clone();
            moved(&mut diagnostic.span);
            diagnostic.labels.iter_mut().for_each(|label| moved(&mut label.span));
            diagnostic
        };
        diagnostics.iter().map(of_options).collect()
    }
}

/// Returns whether a WGSL file has the header of a registry row.
fn is_user_row(path: &Path) -> bool {
    source_file::read(path).is_ok_and(|source| source.lines().any(|line| line.trim_start().starts_with("//:")))
}

/// Returns the name of the first entry point of a WGSL file.
fn entry_point(path: &Path) -> Option<String> {
    let source = source_file::read(path).ok()?;
    let starts = ["@compute", "@fragment", "@vertex"].iter().filter_map(|stage| source.find(stage));
    let (_, declaration) = source.get(starts.min()?..)?.split_once("fn ")?;
    let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    let name: String = declaration.trim_start().chars().take_while(|letter| is_name(*letter)).collect();
    (!name.is_empty()).then_some(name)
}

/// Returns the failure for an argument that names a file of another kind, or none although it looks like the name of a file.
fn other_file(argument: &str, path: &Path, registry: &Registry) -> Result<(), Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    let extension = extension.as_deref().unwrap_or_default();
    let usage = match extension {
        "wgsl" if is_user_row(path) => {
            let name = path.file_name().map_or(argument.into(), |name| name.to_string_lossy());
            format!("it is a row of its own: choose it in a description, as in `storage: wgsl(\"{name}\");`")
        }
        "wgsl" => {
            let entry = entry_point(path).unwrap_or_else(|| "main".to_owned());
            format!("`fragbuf check --wgsl {argument} --entry {entry}` checks a shader")
        }
        "obj" | "ply" | "gltf" | "glb" | "gz" => format!("give a model to `--scene {argument}`"),
        "glsl" | "vert" | "frag" | "comp" | "hlsl" | "metal" | "spv" => "fragbuf reads shaders in WGSL only".to_owned(),
        _ => String::new(),
    };
    if !usage.is_empty() {
        return Err(Failure::Usage(format!("`{argument}` is no description in a .fragbuf file: {usage}")));
    }
    let whole = path.with_extension("fragbuf");
    if !argument.contains(['/', '\\', '.']) && !path.exists() && whole.is_file() {
        return Err(Failure::Usage(format!("no technique `{argument}`: for the file, write `{}`", whole.display())));
    }
    let looks_like_file = extension == "fragbuf" || argument.contains(['/', '\\', '.']);
    if path.is_dir() || (looks_like_file && !path.exists()) {
        return Err(Failure::Files(missing_description(argument, path, registry)));
    }
    Ok(())
}

/// Returns the message about a description that is not a file, with a file of nearly this name, if there is one.
fn missing_description(argument: &str, path: &Path, registry: &Registry) -> String {
    let folder = if path.is_dir() { Some(path) } else { path.parent() };
    let folder = folder.map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
    let names = entries.into_iter().flatten().flatten().map(|entry| PathBuf::from(entry.file_name()));
    let mut names: Vec<String> = names
        .filter(|name| name.extension().is_some_and(|extension| extension == "fragbuf"))
        .filter_map(|name| Some(name.to_str()?.to_owned()))
        .collect();
    names.sort();
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let whole = if name.ends_with(".fragbuf") { name.to_owned() } else { format!("{name}.fragbuf") };
    // Without the extension, which all have in common.
    let stem = |name: &str| name.strip_suffix(".fragbuf").unwrap_or(name).to_owned();
    let stems: Vec<String> = names.iter().map(|name| stem(name)).collect();
    let nearest = nearest_name(&stem(&whole), &stems).filter(|_| !path.is_dir()).map(|stem| format!("{stem}.fragbuf"));
    let technique = path.file_stem().and_then(|stem| registry.technique(stem.to_str()?)).filter(|_| !path.is_dir());
    let help = match (technique, nearest.map(|nearest| path.with_file_name(nearest))) {
        (Some(technique), _) => format!("give the key of the technique alone, `{}`", technique.key),
        (None, Some(nearest)) => format!("did you mean `{}`?", nearest.display()),
        (None, None) => "give a .fragbuf file, or the key of a technique, which `fragbuf list` lists".to_owned(),
    };
    let what = if path.is_dir() { "is a folder" } else { "does not exist" };
    format!("the description `{argument}` {what}: {help}")
}
