//! The blocks `fragment { name: format, … }` and `uniform { name: type, … }`.
//!
//! Input: a block in braces. Output: its declarations as written.

use fragbuf_model::{Format, Spanned, TextureDimension, UniformType};
use proc_macro2::TokenTree;

use super::cursor::Cursor;
use crate::declarations::{self, Declaration};
use crate::foreign_names::{self, Replacement};
use crate::names;
use crate::report::{Report, Stop};

/// The blocks of declarations.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum DeclarationBlock {
    /// `fragment { … }`
    Fragment,
    /// `uniform { … }`
    Uniform,
    /// `texture { … }`
    Texture,
}

impl DeclarationBlock {
    /// Returns an example of the block.
    fn shape(self) -> &'static str {
        match self {
            DeclarationBlock::Fragment => "fragment { color: rgba8, depth: f32 }",
            DeclarationBlock::Uniform => "uniform { cut: f32 }",
            DeclarationBlock::Texture => "texture { lut: 2d }",
        }
    }

    /// Returns whether a word is a type of the block.
    fn has_type(self, word: &str) -> bool {
        match self {
            DeclarationBlock::Fragment => Format::ALL.iter().any(|format| format.keyword() == word),
            DeclarationBlock::Uniform => UniformType::ALL.iter().any(|ty| ty.keyword() == word),
            DeclarationBlock::Texture => TextureDimension::ALL.iter().any(|ty| ty.keyword() == word),
        }
    }

    /// Returns what the block has in place of a type of another language.
    fn foreign(self, word: &str) -> Option<Replacement> {
        match self {
            DeclarationBlock::Fragment => foreign_names::attribute_format(word),
            DeclarationBlock::Uniform => foreign_names::uniform_type(word),
            DeclarationBlock::Texture => foreign_names::texture_dimension(word),
        }
    }

    /// Returns how surely a word is a type: 2 a type of the block, 1 a type of another language, 0 a name. Words such as `color` are names
    /// of attributes first.
    fn certainty(self, word: &str) -> u32 {
        match word {
            _ if self.has_type(word) => 2,
            _ if declarations::is_usual_name(word) => 0,
            _ => u32::from(self.foreign(word).is_some()),
        }
    }

    /// Returns the type of the block for a word that may be a type of another language.
    fn own_type(self, word: &str) -> String {
        if self.has_type(word) {
            return word.to_owned();
        }
        self.foreign(word).and_then(|foreign| foreign.own).unwrap_or_else(|| self.usual_type().to_owned())
    }

    /// Returns a type for a declaration without one.
    pub(super) fn usual_type(self) -> &'static str {
        if self == DeclarationBlock::Texture { "2d" } else { "f32" }
    }

    /// Returns the declaration of two words, of which either may be the type: in other languages the type is first.
    pub(super) fn declaration(self, first: &str, second: &str) -> String {
        match self.certainty(first) > self.certainty(second) {
            true => format!("{second}: {}", self.own_type(first)),
            false => format!("{first}: {}", self.own_type(second)),
        }
    }
}

/// Parses a block in braces.
pub(super) fn declarations(
    cursor: &mut Cursor,
    block: DeclarationBlock,
    report: &mut Report,
) -> Result<Vec<Declaration>, Stop> {
    let Some(group) = cursor.take_braces() else {
        return Err(cursor.expected("`{`", format!("write `{}`", block.shape()), report));
    };
    cursor.take_punct(';');
    let mut inner = Cursor::inside(&group);
    let mut rows = Vec::new();
    while !inner.is_done() {
        match declaration(&mut inner, block, report) {
            Ok(row) => rows.push(row),
            Err(Stop) => inner.skip_past_comma(),
        }
    }
    Ok(rows)
}

fn declaration(cursor: &mut Cursor, block: DeclarationBlock, report: &mut Report) -> Result<Declaration, Stop> {
    let help = || format!("write `{}`", block.shape());
    let Some(name) = cursor.take_identifier() else { return Err(cursor.expected("a name", help(), report)) };
    let name = names::written(&name, report);
    if !cursor.take_punct(':') {
        let help = match cursor.peek() {
            Some(TokenTree::Ident(second)) => {
                format!("write `{}`", block.declaration(&name.value, &second.to_string()))
            }
            _ => help(),
        };
        return Err(cursor.expected("`:`", help, report));
    }
    let span = cursor.source_span(report);
    // `2d` is a literal with a suffix.
    let type_name = match block {
        DeclarationBlock::Texture => cursor.take_word(),
        _ => cursor.take_identifier().map(|name| name.to_string()),
    };
    let Some(type_name) = type_name else { return Err(cursor.expected("a type", help(), report)) };
    let type_name = Spanned::new(type_name, span);
    if !cursor.take_punct(',') && !cursor.is_done() {
        let (name, ty) = (&name.value, &type_name.value);
        let help = match cursor.peek() {
            _ if cursor.at_punct('<') => format!("write `{name}: {ty}`, without the type of the components"),
            _ if cursor.at_punct('=') => format!("write `{name}: {ty}`: a declaration has no value"),
            _ => format!("separate declarations by commas: `{name}: {ty}, …`"),
        };
        return Err(cursor.expected("`,`", help, report));
    }
    Ok(Declaration { name, type_name })
}
