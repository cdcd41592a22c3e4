//! The declaration of a name.
//!
//! Input: an offset. Output: the WGSL file of a value, the path of a user file, or the place in the text that declares the name.

use fragbuf_syntax::NameKind;

use super::context::{Place, context};
use super::{Document, TextSpan};

/// Where a name is declared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Definition {
    /// A WGSL file of fragbuf.
    Template {
        /// Its path in the registry, such as `storage/max_array.wgsl`.
        path: String,
        /// Its source.
        source: String,
    },
    /// A user file.
    File {
        /// Its path, as messages name it: relative to the folder to which the path of the document is.
        path: String,
    },
    /// A place in the document.
    Text(TextSpan),
}

impl Document<'_> {
    /// Returns the declaration of the name at an offset.
    pub fn definition(&self, offset: usize) -> Option<Definition> {
        if self.is_too_long() {
            return None;
        }
        let lines = self.lines();
        let offset = lines.boundary(offset);
        let context = context(self.text, offset);
        let word = self.text.get(context.word.clone()).unwrap_or_default();
        match &context.place {
            Place::Value { axis } if word.is_empty() || self.registry.row(axis, word).is_none() => self.file(offset),
            Place::Value { axis } => {
                let template = self.registry.row(axis, word)?.template.as_ref()?;
                Some(Definition::Template { path: template.path.to_string(), source: template.source.to_string() })
            }
            Place::File { .. } => self.file(offset),
            Place::OptionValue { .. } => self.declaration(NameKind::Attribute, word),
            Place::Function => {
                let (name, _) = self.of_function(offset)?;
                match (name.declared, name.kind) {
                    (Some(span), _) => Some(Definition::Text(lines.source_span(&span))),
                    (None, kind) => self.declaration(kind, &name.name),
                }
            }
            _ => None,
        }
    }

    /// Returns the user file whose choice is at an offset.
    fn file(&self, offset: usize) -> Option<Definition> {
        let lines = self.lines();
        let draft = self.draft()?;
        let alternatives = draft.choices.iter().flat_map(|choice| &choice.alternatives);
        let mut at_offset = alternatives.filter(|alternative| {
            let span = lines.source_span(&alternative.value.span).bytes;
            // The span is that of the quoted path; `wgsl(` is before it.
            span.start.saturating_sub("wgsl(".len()) <= offset && offset <= span.end
        });
        let path = at_offset.find_map(|alternative| alternative.file())?;
        Some(Definition::File { path: self.file_name(path) })
    }

    fn declaration(&self, kind: NameKind, name: &str) -> Option<Definition> {
        let draft = self.draft()?;
        let attributes = draft.attributes.iter().map(|attribute| &attribute.name);
        let uniforms = draft.uniforms.iter().map(|uniform| &uniform.name);
        let found = match kind {
            NameKind::Attribute => attributes.into_iter().find(|declared| declared.value == name),
            NameKind::Uniform => uniforms.into_iter().find(|declared| declared.value == name),
            _ => None,
        };
        found.map(|declared| Definition::Text(self.lines().source_span(&declared.span)))
    }
}
