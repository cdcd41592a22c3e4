//! Reads the first argument of most commands: the key of a technique, or the file of a description.

use std::path::Path;

use fragbuf::load::{Description, load};
use fragbuf::{Registry, Variant, source_file};

use super::output::Failure;

/// A description as given, and the sources that its diagnostics quote.
pub(crate) struct Input {
    description: Description,
    sources: Vec<(String, String)>,
}

impl Input {
    /// Reads the technique of this key, or the file of this name.
    pub(crate) fn read(argument: &str, registry: &Registry) -> Result<Self, Failure> {
        let path = Path::new(argument);
        let is_file =
            path.extension().is_some_and(|extension| extension == "fragbuf") || (path.exists() && !path.is_dir());
        if registry.technique(argument).is_some() || !is_file {
            return Ok(Input { description: Description::Technique(argument.to_owned()), sources: Vec::new() });
        }
        let text = source_file::read(path).map_err(|error| Failure::files(path, &error))?;
        let description = Description::Text { file: argument.to_owned(), text };
        Ok(Input { description, sources: Vec::new() })
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
        loaded.variant.map_err(|diagnostics| self.failure(diagnostics))
    }

    /// Returns the failure for `diagnostics`, with the sources of this input.
    pub(crate) fn failure(&self, diagnostics: fragbuf::Diagnostics) -> Failure {
        Failure::Description(diagnostics, self.sources.clone())
    }
}
