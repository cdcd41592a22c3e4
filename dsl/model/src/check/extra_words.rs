//! Checks the words that rows add to every fragment.
//!
//! Input: the attributes of a description and its choices. Output: an error for every word that has the name of another member of a
//! fragment, or the built-in value of another word. Shaders have each of them once.

use fragbuf_templates::vocabulary::{ImplicitAttribute, Row};

use crate::user_row::value_source;
use crate::variant::AxisChoice;
use crate::{Attribute, Diagnostic, Diagnostics, codes, mangled};

/// Checks the words of all alternatives against the attributes, and against the words of rows that can be selected with them.
pub(super) fn check(attributes: &[Attribute], choices: &[AxisChoice], diagnostics: &mut Diagnostics) {
    let added = added(choices);
    for (index, this) in added.iter().enumerate() {
        for attribute in attributes.iter().filter(|attribute| this.is_named(&mangled(&attribute.name.value))) {
            diagnostics.push(this.named_as_attribute(attribute));
        }
        for other in added[..index].iter().filter(|other| other.can_meet(this)) {
            if other.word.built_in == this.word.built_in {
                diagnostics.push(this.same_value(other));
            } else if this.is_named(&other.word.name) {
                diagnostics.push(this.same_name(other));
            }
        }
    }
}

/// A word, and the row that adds it.
struct Added<'a> {
    word: &'a ImplicitAttribute,
    row: &'a Row,
    chosen: &'a AxisChoice,
}

fn added(choices: &[AxisChoice]) -> Vec<Added<'_>> {
    let rows = choices.iter().flat_map(|chosen| chosen.alternatives.iter().map(move |each| (chosen, &*each.row)));
    rows.flat_map(|(chosen, row)| row.extra_words.iter().map(move |word| Added { word, row, chosen })).collect()
}

impl Added<'_> {
    /// Tests whether one variant can have both words: alternatives of one axis exclude each other.
    fn can_meet(&self, other: &Added<'_>) -> bool {
        std::ptr::eq(self.row, other.row) || !std::ptr::eq(self.chosen, other.chosen)
    }

    /// Tests whether the word has this name in shaders.
    fn is_named(&self, name: &str) -> bool {
        *self.word.name == *name
    }

    fn row_name(&self) -> String {
        format!("`{}: {}`", self.row.axis, value_source(&self.row.key))
    }

    fn named_as_attribute(&self, attribute: &Attribute) -> Diagnostic {
        let name = &attribute.name.value;
        let message = format!(
            "{} adds a word `{}` to every fragment, and the payload has `{name}`",
            self.row_name(),
            self.word.name
        );
        let help = format!("rename one of the two, or make another choice than {}", self.row_name());
        Diagnostic::new(codes::DUPLICATE, &attribute.name.span, message, help)
            .label(&self.chosen.span, format!("{} is chosen here", self.row_name()))
    }

    fn same_value(&self, other: &Added<'_>) -> Diagnostic {
        let (built_in, name) = (&self.word.built_in, &other.word.name);
        let message =
            format!("{} adds `{built_in}` to every fragment, and {} adds it, too", self.row_name(), other.row_name());
        let help = format!(
            "remove the word `{}` and read `{name}`, or make another choice than one of the two",
            self.word.name
        );
        self.with_other(other, message, help)
    }

    fn same_name(&self, other: &Added<'_>) -> Diagnostic {
        let name = &self.word.name;
        let message = format!(
            "{} adds a word `{name}` to every fragment, and {} adds another of this name",
            self.row_name(),
            other.row_name()
        );
        self.with_other(
            other,
            message,
            "rename one of the words, or make another choice than one of the two".to_owned(),
        )
    }

    fn with_other(&self, other: &Added<'_>, message: String, help: String) -> Diagnostic {
        Diagnostic::new(codes::DUPLICATE, &self.chosen.span, message, help)
            .label(&other.chosen.span, format!("{} is chosen here", other.row_name()))
    }
}
