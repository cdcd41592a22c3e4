//! What is shown over a name.
//!
//! Input: an offset. Output: the name there, and Markdown about it: of the registry for axes, values and techniques, of the type checker
//! for names in functions.

use std::ops::Range;

use fragbuf_model::{Draft, Format, UniformType};
use fragbuf_syntax::{Name, NameKind, inspect};

use super::context::{Place, context};
use super::scan::repaired;
use super::{Document, TextSpan, markdown};

/// Text about a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The name.
    pub span: TextSpan,
    /// What it means, as Markdown.
    pub markdown: String,
}

impl Document<'_> {
    /// Returns what is shown over the name at an offset.
    pub fn hover(&self, offset: usize) -> Option<Hover> {
        if self.is_too_long() {
            return None;
        }
        let lines = self.lines();
        let context = context(self.text, lines.boundary(offset));
        let word = self.text.get(context.word.clone()).filter(|word| !word.is_empty());
        let markdown = match &context.place {
            Place::Function => self.of_function(offset).map(|(name, draft)| self.over_name(&name, draft.as_ref())),
            place => word.and_then(|word| self.over_word(place, word)),
        };
        Some(Hover { span: lines.span(context.word), markdown: markdown? })
    }

    fn over_word(&self, place: &Place, word: &str) -> Option<String> {
        let registry = self.registry;
        match place {
            Place::Technique => registry.technique(word).map(markdown::technique),
            Place::Item => registry.axis(word).filter(|axis| axis.chosen).map(|axis| markdown::axis(axis, registry)),
            Place::Value { axis } => registry.row(axis, word).map(markdown::row),
            Place::OptionName { axis, value } => {
                let row = registry.row(axis, value)?;
                row.parameters.iter().find(|parameter| parameter.name == word).map(markdown::option)
            }
            Place::OptionValue { .. } | Place::AttributeName => {
                self.draft().and_then(|draft| self.over_attribute(&draft, word))
            }
            Place::AttributeType => {
                Format::ALL.into_iter().find(|format| format.keyword() == word).map(markdown::format)
            }
            Place::UniformType => {
                UniformType::ALL.into_iter().find(|ty| ty.keyword() == word).map(|ty| uniform_type(word, ty))
            }
            Place::UniformName => {
                let draft = self.draft()?;
                draft
                    .uniforms
                    .iter()
                    .find(|uniform| uniform.name.value == word)
                    .map(|uniform| format!("```rust\n{word}: {}\n```\n{}", uniform.kind.value.keyword(), UNIFORM))
            }
            Place::Name => self.over_buffer(),
            _ => None,
        }
    }

    fn over_attribute(&self, draft: &Draft, word: &str) -> Option<String> {
        let attributes = if draft.attributes.is_empty() { draft.papers_payload() } else { draft.attributes.clone() };
        let attribute = attributes.iter().find(|attribute| attribute.name.value == word)?;
        let format = attribute.format.value;
        Some(format!("```rust\n{word}: {}\n```\n{}", format.keyword(), markdown::format(format)))
    }

    /// Returns the choices of a valid description.
    fn over_buffer(&self) -> Option<String> {
        let variant = self.compile().variant?;
        let keep = variant.keep.map_or("all".to_owned(), |k| k.to_string());
        let mut text = format!("**buffer {}**\n\n* `keep {keep};`\n", variant.name.value);
        for chosen in &variant.choices {
            let rows: Vec<&str> = chosen.alternatives.iter().map(|selected| selected.row.key.as_str()).collect();
            text.push_str(&format!("* `{}: {};`\n", chosen.axis, rows.join(" else ")));
        }
        Some(text)
    }

    /// Returns the name in a function at an offset.
    pub(super) fn of_function(&self, offset: usize) -> Option<(Name, Option<Draft>)> {
        let lines = self.lines();
        let offset = lines.boundary(offset);
        let find = |text: &str| {
            let inspection = inspect(text, self.path);
            let length = |name: &Name| -> Option<usize> {
                let Range { start, end } = lines.source_span(&name.span).bytes;
                (start <= offset && offset <= end).then_some(end - start)
            };
            let names = inspection.names.into_iter();
            let found = names.filter_map(|name| Some((length(&name)?, name))).min_by_key(|(length, _)| *length)?;
            Some((found.1, inspection.parsed.draft))
        };
        find(self.text).or_else(|| find(&repaired(self.text)))
    }

    fn over_name(&self, name: &Name, draft: Option<&Draft>) -> String {
        let mut text = format!("```rust\n{}\n```\n", name.signature);
        match name.kind {
            NameKind::Attribute => {
                let about = draft.and_then(|draft| self.over_attribute(draft, &name.name));
                return about.unwrap_or(text);
            }
            NameKind::Uniform => text.push_str(UNIFORM),
            _ => text.push_str(&name.note),
        }
        text
    }

    /// Returns the draft, of the repaired text if the text has none.
    pub(super) fn draft(&self) -> Option<Draft> {
        let parsed = fragbuf_syntax::parse(self.text, self.path);
        parsed.draft.or_else(|| fragbuf_syntax::parse(&repaired(self.text), self.path).draft)
    }
}

const UNIFORM: &str = "A uniform: constant during a pass, set by the caller.";

fn uniform_type(word: &str, ty: UniformType) -> String {
    format!("`{word}`: `{}` in WGSL", ty.wgsl_type())
}
