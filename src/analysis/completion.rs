//! What can be written at an offset.
//!
//! Input: an offset in a text that may be incomplete. Output: names with their meanings, in the order in which they are useful. A value
//! that the rules reject in this description is listed last, with the reason.

use std::borrow::Cow;

use fragbuf_model::{Draft, Format, UniformType};
use fragbuf_syntax::{Candidate, ITEMS, KEYWORDS, NameKind, STATEMENTS, parse};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::ParameterType;

use super::context::{Context, Place, context};
use super::scan::repaired;
use super::{Document, Edit, Position, TextSpan, markdown, placeholder, values};
use crate::{load, user_file};

/// A text that can be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// The name.
    pub label: String,
    /// Its kind.
    pub kind: CompletionKind,
    /// Its type or its summary, in a line.
    pub detail: String,
    /// More about it, as Markdown; may be empty.
    pub documentation: String,
    /// The change of the text.
    pub edit: Edit,
    /// The error that the description would have, in the words of the compiler. `None`: it is legal.
    pub illegal: Option<String>,
}

/// The kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CompletionKind {
    /// A word of the language.
    Keyword,
    /// A technique.
    Technique,
    /// An axis.
    Axis,
    /// A value of an axis.
    Value,
    /// An option of a value.
    Option,
    /// A type of an attribute or a uniform.
    Type,
    /// A name in a function.
    Name(NameKind),
}

impl Document<'_> {
    /// Returns what can be written at an offset, in place of the word there.
    pub fn completion(&self, offset: usize) -> Vec<Completion> {
        if self.is_too_long() {
            return Vec::new();
        }
        let lines = self.lines();
        let context = context(self.text, lines.boundary(offset));
        let mut found = self.completions(&context);
        let span = lines.span(context.word);
        found.iter_mut().for_each(|completion| completion.edit.span = span.clone());
        found
    }

    fn completions(&self, context: &Context) -> Vec<Completion> {
        let registry = self.registry;
        match &context.place {
            Place::Start => vec![self.keyword("buffer")],
            Place::From => vec![self.keyword("from")],
            Place::Technique => registry
                .techniques()
                .iter()
                .map(|technique| {
                    let (key, about) = (&technique.key, markdown::technique(technique));
                    self.item(key, key, CompletionKind::Technique, technique.summary, about)
                })
                .collect(),
            Place::Item => self.items(context),
            Place::Value { axis } => self.values(axis, context),
            Place::Else => vec![self.keyword("else")],
            Place::OptionName { axis, value } => {
                let row = registry.row(axis, value);
                row.iter()
                    .flat_map(|row| &row.parameters)
                    .map(|parameter| {
                        let text = format!("{}: ", parameter.name);
                        self.item(
                            &parameter.name,
                            &text,
                            CompletionKind::Option,
                            &parameter.summary,
                            markdown::option(parameter),
                        )
                    })
                    .collect()
            }
            Place::OptionValue { axis, value, option } => self.option_values(axis, value, option),
            Place::AttributeType => Format::ALL
                .into_iter()
                .map(|format| {
                    let key = format.keyword();
                    self.item(key, key, CompletionKind::Type, format.meaning(), markdown::format(format))
                })
                .collect(),
            Place::UniformType => UniformType::ALL
                .into_iter()
                .map(|ty| self.item(ty.keyword(), ty.keyword(), CompletionKind::Type, ty.wgsl_type(), String::new()))
                .collect(),
            Place::Count => vec![self.keyword("all")],
            Place::Least => vec![self.keyword("least")],
            Place::Function => self.names(context),
            Place::Other | Place::Name | Place::File { .. } | Place::AttributeName | Place::UniformName => Vec::new(),
        }
    }

    fn item(&self, label: &str, text: &str, kind: CompletionKind, detail: &str, documentation: String) -> Completion {
        let start = Position { line: 0, character: 0 };
        // `completion` sets the span.
        let edit = Edit { span: TextSpan { bytes: 0..0, start, end: start }, text: text.to_owned() };
        let (label, detail) = (label.to_owned(), detail.to_owned());
        Completion { label, kind, detail, documentation, edit, illegal: None }
    }

    fn keyword(&self, word: &str) -> Completion {
        debug_assert!(KEYWORDS.contains(&word) || ITEMS.contains(&word) || STATEMENTS.contains(&word));
        self.item(word, word, CompletionKind::Keyword, "", String::new())
    }

    /// Returns the words that begin items, and the axes on which the description does not choose.
    fn items(&self, context: &Context) -> Vec<Completion> {
        let draft = self.draft_without(context);
        let chosen: Vec<&str> =
            draft.iter().flat_map(|draft| &draft.choices).map(|choice| &*choice.axis.value).collect();
        let axes = self.registry.axes().iter().filter(|axis| axis.chosen && !chosen.contains(&axis.key));
        let axes = axes.map(|axis| {
            let text = format!("{}: ", axis.key);
            self.item(axis.key, &text, CompletionKind::Axis, axis.summary, markdown::axis(axis, self.registry))
        });
        ITEMS.iter().map(|word| self.keyword(word)).chain(axes).collect()
    }

    /// Returns the values of an axis: the legal ones first.
    fn values(&self, axis: &str, context: &Context) -> Vec<Completion> {
        let draft = self.draft_without(context);
        let is_axis = self.registry.axis(axis).is_some_and(|axis| axis.chosen);
        let Some(draft) = draft.filter(|_| is_axis) else { return Vec::new() };
        let registry = self.registry_with_files(&draft);
        let mut found: Vec<Completion> = values::values(&draft, axis, &registry)
            .into_iter()
            .map(|(row, error)| {
                let illegal = error.as_ref().map(values::reason);
                let item = self.item(&row.key, &row.key, CompletionKind::Value, &row.summary, markdown::row(row));
                Completion { illegal, ..item }
            })
            .collect();
        found.sort_by_key(|completion| completion.illegal.is_some());
        found
    }

    fn registry_with_files(&self, draft: &Draft) -> Cow<'_, Registry> {
        match self.reads_files && load::names_files(draft) {
            true => Cow::Owned(user_file::read(draft, self.registry).registry),
            false => Cow::Borrowed(self.registry),
        }
    }

    fn option_values(&self, axis: &str, value: &str, option: &str) -> Vec<Completion> {
        let row = self.registry.row(axis, value);
        let Some(parameter) = row.and_then(|row| row.parameters.iter().find(|parameter| parameter.name == option))
        else {
            return Vec::new();
        };
        match parameter.kind {
            ParameterType::Attribute => {
                let draft = self.draft();
                let attributes = draft.map(|draft| match draft.attributes.is_empty() {
                    true => draft.papers_payload(),
                    false => draft.attributes,
                });
                let item = |name: &str, format: Format| {
                    let kind = CompletionKind::Name(NameKind::Attribute);
                    self.item(name, name, kind, format.keyword(), markdown::format(format))
                };
                attributes.into_iter().flatten().map(|each| item(&each.name.value, each.format.value)).collect()
            }
            ParameterType::Number | ParameterType::PowerOfTwo => {
                let default = parameter.default.to_string();
                let is_number = default.chars().all(|digit| digit.is_ascii_digit());
                let item = self.item(
                    &default,
                    &default,
                    CompletionKind::Option,
                    &parameter.summary,
                    markdown::option(parameter),
                );
                if is_number { vec![item] } else { Vec::new() }
            }
        }
    }

    /// Returns the names of the type checker in a function, and the words of statements if a value can be there.
    fn names(&self, context: &Context) -> Vec<Completion> {
        let candidates = placeholder::candidates(self.text, self.path, &context.word);
        let is_member = matches!(&*context.before, "." | ":");
        let words = STATEMENTS.iter().filter(|_| !is_member).map(|word| self.keyword(word));
        let names = candidates.iter().map(|candidate: &Candidate| {
            let kind = CompletionKind::Name(candidate.kind);
            self.item(&candidate.name, &candidate.name, kind, &candidate.signature, candidate.note.clone())
        });
        let names: Vec<Completion> = names.collect();
        names.into_iter().chain(words).collect()
    }

    /// Returns the draft of the text without the item that is being written.
    fn draft_without(&self, context: &Context) -> Option<Draft> {
        let before = self.text.get(..context.item)?;
        let rest = self.text.get(context.word.end.max(context.item)..)?;
        // The rest of the item goes, too, if its end is near.
        let line = rest.split(['\n', '}']).next().unwrap_or_default();
        let after = match line.find(';') {
            Some(end) => rest.get(end + 1..),
            None => Some(rest),
        };
        let text = format!("{before}{}", after.unwrap_or_default());
        parse(&text, self.path).draft.or_else(|| parse(&repaired(&text), self.path).draft)
    }
}
