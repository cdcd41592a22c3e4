//! The first argument of most commands: a technique's key, or a description's file.

use std::path::Path;

use fragbuf::load::{Description, load};
use fragbuf::{Registry, Variant};

use super::output::Failure;

/// A description as given, and the texts to show beside its diagnostics.
pub(crate) struct Input {
    description: Description,
    sources: Vec<(String, String)>,
}

impl Input {
    /// A technique of this key, or the file of this name.
    pub(crate) fn read(argument: &str, registry: &Registry) -> Result<Self, Failure> {
        let path = Path::new(argument);
        let is_file = path.extension().is_some_and(|extension| extension == "fragbuf") || path.is_file();
        if registry.technique(argument).is_some() || !is_file {
            return Ok(Input { description: Description::Technique(argument.to_owned()), sources: Vec::new() });
        }
        let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::InvalidData => Failure::Files(format!("{argument}: the text is not UTF-8")),
            _ => Failure::files(path, &error),
        })?;
        let description = Description::Text { file: argument.to_owned(), text };
        Ok(Input { description, sources: Vec::new() })
    }

    /// The variant, after `--set`.
    pub(crate) fn variant(&mut self, set: &[(String, String)], registry: &Registry) -> Result<Variant, Failure> {
        self.variant_or(set, &[], registry)
    }

    /// The variant, after `--set`, with `unless_said` on axes that nobody chose on.
    pub(crate) fn variant_or(
        &mut self,
        set: &[(String, String)],
        unless_said: &[(&str, &str)],
        registry: &Registry,
    ) -> Result<Variant, Failure> {
        let loaded = load(&self.description, set, unless_said, registry);
        self.sources = loaded.texts();
        loaded.variant.map_err(|diagnostics| self.failure(diagnostics))
    }

    /// Diagnostics with this input's texts beside them.
    pub(crate) fn failure(&self, diagnostics: fragbuf::Diagnostics) -> Failure {
        Failure::Description(diagnostics, self.sources.clone())
    }
}
