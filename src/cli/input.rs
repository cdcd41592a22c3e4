//! The first argument of most commands: a technique's key, or a description's file.

use std::path::Path;

use fragbuf::load::{self, Description};
use fragbuf::{Registry, Variant};

use super::output::Failure;

/// A description as given, and the text to show beside its diagnostics.
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
            let description = Description::Technique(argument.to_owned());
            return Ok(Input { description, sources: vec![(argument.to_owned(), argument.to_owned())] });
        }
        let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::InvalidData => Failure::Files(format!("{argument}: the text is not UTF-8")),
            _ => Failure::files(path, &error),
        })?;
        let sources = vec![(argument.to_owned(), text.clone())];
        Ok(Input { description: Description::Text { file: argument.to_owned(), text }, sources })
    }

    /// The variant, after `--set`.
    pub(crate) fn variant(&self, set: &[(String, String)], registry: &Registry) -> Result<Variant, Failure> {
        load::variant(&self.description, set, registry).map_err(|diagnostics| self.failure(diagnostics))
    }

    /// The variant, after `--set`, with `unless_said` on axes that nobody chose on.
    pub(crate) fn variant_or(
        &self,
        set: &[(String, String)],
        unless_said: &[(&str, &str)],
        registry: &Registry,
    ) -> Result<Variant, Failure> {
        load::variant_or(&self.description, set, unless_said, registry).map_err(|diagnostics| self.failure(diagnostics))
    }

    /// Diagnostics with this input's text beside them.
    pub(crate) fn failure(&self, diagnostics: fragbuf::Diagnostics) -> Failure {
        Failure::Description(diagnostics, self.sources.clone())
    }
}
