//! A technique's key or a description's text, with changes from outside, becomes a variant.

use fragbuf_model::{Diagnostics, Draft, Origin, Variant};
use fragbuf_syntax::{Parsed, parse};
use fragbuf_templates::Registry;

/// A description to load.
#[derive(Clone, Debug)]
pub enum Description {
    /// A technique of the registry.
    Technique(String),
    /// A file's name, as messages give it, and its text.
    Text {
        /// The name.
        file: String,
        /// The text.
        text: String,
    },
}

/// Checks a description after the changes `set`, each a name and a value as in `--set name=value`.
pub fn variant(
    description: &Description,
    set: &[(String, String)],
    registry: &Registry,
) -> Result<Variant, Diagnostics> {
    variant_or(description, set, &[], registry)
}

/// The same, with `unless_said`, also names and values, where neither the description nor `set` says anything: of that
/// axis, or for `fragment.attribute` of the payload.
pub fn variant_or(
    description: &Description,
    set: &[(String, String)],
    unless_said: &[(&str, &str)],
    registry: &Registry,
) -> Result<Variant, Diagnostics> {
    let (mut draft, mut diagnostics) = match description {
        Description::Technique(key) => {
            (Draft::from_technique(key, &Origin::new(key.as_str(), 1, 1)), Diagnostics::new())
        }
        Description::Text { file, text } => {
            let parsed = parse(text, file);
            match parsed.draft {
                Some(draft) => (draft, parsed.diagnostics),
                None => return Err(parsed.diagnostics),
            }
        }
    };
    for (name, value) in set {
        let origin = Origin::new("--set", 1, 1).with_length(name.chars().count() as u32);
        if let Err(wanted) = draft.set(name, value, &origin) {
            diagnostics.push(fragbuf_model::Diagnostic::new(
                fragbuf_model::codes::BAD_OPTION,
                &origin,
                format!("`{value}` is no value for `{name}`"),
                format!("give {wanted}"),
            ));
        }
    }
    for (name, value) in unless_said {
        let said = match name.split_once('.') {
            Some(("fragment", _)) => !draft.attributes.is_empty(),
            _ => draft.choices.iter().any(|choice| choice.axis.value == *name),
        };
        if !said {
            // A choice on an axis takes any text; the rules judge it.
            let _ = draft.set(name, value, &Origin::new("unless said", 1, 1));
        }
    }
    Parsed { draft: Some(draft), diagnostics }.check(registry)
}
