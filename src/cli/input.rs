//! Reads the first argument of most commands: the key of a technique, or the file of a description.

use std::path::Path;

use fragbuf::load::{Description, load};
use fragbuf::{Diagnostic, Registry, Variant, source_file};
use fragbuf_model::codes;

use super::output::{self, Failure};

/// A description as given, and the sources that its diagnostics quote.
pub(crate) struct Input {
    description: Description,
    sources: Vec<(String, String)>,
    /// The warnings that are printed already: `render` loads a description once per redraw.
    warned: Vec<Diagnostic>,
    /// Whether the caller's own shader may read attributes that the description does not.
    is_module: bool,
}

impl Input {
    /// Reads the technique of this key, or the file of this name.
    pub(crate) fn read(argument: &str, registry: &Registry) -> Result<Self, Failure> {
        let path = Path::new(argument);
        let is_file =
            path.extension().is_some_and(|extension| extension == "fragbuf") || (path.exists() && !path.is_dir());
        if registry.technique(argument).is_some() || !is_file {
            return Ok(Input::of(Description::Technique(argument.to_owned())));
        }
        let text = source_file::read(path).map_err(|error| Failure::source(path, &error))?;
        let description = Description::Text { file: argument.to_owned(), text };
        Ok(Input::of(description))
    }

    fn of(description: Description) -> Self {
        Input { description, sources: Vec::new(), warned: Vec::new(), is_module: false }
    }

    /// Prints no warning of attributes, which the caller's own shader may read.
    pub(crate) fn for_module(self) -> Self {
        Input { is_module: true, ..self }
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
