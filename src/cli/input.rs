//! Reads the first argument of most commands: the key of a technique, or the file of a description.

use std::path::{Path, PathBuf};

use fragbuf::load::{Description, load};
use fragbuf::{Diagnostic, Registry, Variant, source_file};
use fragbuf_model::codes;

use super::output::{self, Failure};

/// A description as given, and the sources that its diagnostics quote.
pub(crate) struct Input {
    description: Description,
    sources: Vec<(String, String)>,
    /// The files of the description and of its rows, as far as they were read.
    files: Vec<PathBuf>,
    /// The warnings that are printed already: `render` loads a description once per redraw.
    warned: Vec<Diagnostic>,
    /// Whether the caller's own shader may read attributes that the description does not.
    is_module: bool,
}

impl Input {
    /// Reads the technique of this key, or the file of this name.
    pub(crate) fn read(argument: &str, registry: &Registry) -> Result<Self, Failure> {
        if !Input::is_file(argument, registry) {
            return Ok(Input::of(Description::Technique(argument.to_owned())));
        }
        let path = Path::new(argument);
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

    fn of(description: Description) -> Self {
        Input { description, sources: Vec::new(), files: Vec::new(), warned: Vec::new(), is_module: false }
    }

    /// Prints no warning of attributes, which the caller's own shader may read.
    pub(crate) fn for_module(self) -> Self {
        Input { is_module: true, ..self }
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
        self.sources = loaded.all_sources();
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
        output::warnings(&new.iter().cloned().collect(), &self.sources);
        self.warned.extend(new);
    }

    /// Returns the failure for `diagnostics`, with the sources of this input.
    pub(crate) fn failure(&self, diagnostics: fragbuf::Diagnostics) -> Failure {
        Failure::Description(diagnostics, self.sources.clone())
    }
}
