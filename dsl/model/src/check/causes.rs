//! The item of a description that does not meet a condition of a row, and a change of the item that meets it.
//!
//! Input: a formula over the values of a description. Output: the span of the `keep` line, the criterion or an attribute, and the help. A
//! changed item is printed whole, so that it compiles as printed.

use fragbuf_templates::vocabulary::{DescriptionValues, Formula};

use super::payload::description_values;
use super::unused;
use crate::variant::AxisChoice;
use crate::{Attribute, Draft, Format, SourceSpan, nearest_name};

/// Values of k that a help suggests, the most useful first.
pub(super) const SUGGESTED_K: [u32; 4] = [8, 4, 2, 1];

/// Names that users give to the attribute `color`.
const NAMES_OF_COLOR: [&str; 9] =
    ["colour", "col", "rgb", "rgba", "albedo", "diffuse", "tint", "base_color", "radiance"];

/// The item that causes an error, and a change of it that makes the description legal, if there is one.
pub(super) struct Cause {
    pub(super) span: SourceSpan,
    pub(super) help: Option<String>,
}

/// The items of a description that conditions are about.
pub(super) struct Items<'a> {
    pub(super) draft: &'a Draft,
    pub(super) choices: &'a [AxisChoice],
    /// The values of the description, without the extra words of rows.
    pub(super) given: DescriptionValues,
}

impl Items<'_> {
    /// Returns the item that does not meet `formula`; `None`: the description does not have it. `is_legal` tests other values.
    pub(super) fn cause(&self, formula: &Formula, is_legal: &dyn Fn(DescriptionValues) -> bool) -> Option<Cause> {
        let mentions = |symbols: &[&str]| symbols.iter().any(|symbol| formula.mentions(symbol));
        if mentions(&["color"]) {
            return self.color(is_legal);
        }
        if mentions(&["payload_words", "entry_words", "value_words"]) {
            return self.words(is_legal);
        }
        if mentions(&["keep", "limited"]) {
            return self.keep(is_legal);
        }
        self.criterion(is_legal).filter(|_| mentions(&["depth_key"]))
    }

    /// Returns the `keep` line, with the legal count that is nearest below.
    fn keep(&self, is_legal: &dyn Fn(DescriptionValues) -> bool) -> Option<Cause> {
        let keep = self.draft.keep.as_ref()?;
        let with = |k: &u32| is_legal(DescriptionValues { keep: Some(*k), ..self.given });
        let is_less = |k: &&u32| self.given.keep.is_none_or(|given| **k < given);
        let legal: Vec<u32> = SUGGESTED_K.into_iter().filter(with).collect();
        let k = legal.iter().find(is_less).or(legal.last());
        let help = k.map(|k| match (&keep.criterion, self.given.keep) {
            (Some(_), Some(given)) => format!("write `keep {k}` in place of `keep {given}`"),
            _ => format!("write `{}`", keep_line(Some(*k))),
        });
        Some(Cause { span: keep.count.span.clone(), help })
    }

    /// Returns the criterion, with the `keep` line that does not have it.
    fn criterion(&self, is_legal: &dyn Fn(DescriptionValues) -> bool) -> Option<Cause> {
        let criterion = self.draft.keep.as_ref()?.criterion.as_ref()?;
        let is_fixed = is_legal(DescriptionValues { has_criterion: false, ..self.given });
        let help = is_fixed.then(|| format!("remove the criterion: write `{}`", keep_line(self.given.keep)));
        Some(Cause { span: criterion.span.clone(), help })
    }

    /// Returns the attribute that could be the colour, with the payload that has one.
    fn color(&self, is_legal: &dyn Fn(DescriptionValues) -> bool) -> Option<Cause> {
        let attributes = &self.draft.attributes;
        let first = attributes.first()?;
        if let Some(color) = attributes.iter().find(|attribute| attribute.name.value == "color") {
            let help = self.payload(is_legal, |attribute| match attribute.name.value == "color" {
                true => with_format(attribute, Format::Rgba8),
                false => attribute.clone(),
            });
            return Some(Cause { span: color.format.span.clone(), help });
        }
        let is_color = |name: &str| NAMES_OF_COLOR.contains(&name) || nearest_name(name, &["color"]).is_some();
        if let Some(other) = attributes.iter().find(|attribute| is_color(&attribute.name.value)) {
            let format = match other.format.value {
                Format::Rgba16 | Format::Vec4 => other.format.value,
                _ => Format::Rgba8,
            };
            let name = &other.name.value;
            let help = self.payload(is_legal, |attribute| {
                let mut attribute = attribute.clone();
                if attribute.name.value == *name {
                    attribute = with_format(&attribute, format);
                    attribute.name.value = "color".to_owned();
                }
                attribute
            });
            let help = help.map(|help| format!("rename `{name}` to `color`: {help}"));
            return Some(Cause { span: other.name.span.clone(), help });
        }
        let mut color = with_format(first, Format::Rgba8);
        color.name.value = "color".to_owned();
        let all: Vec<Attribute> = std::iter::once(color).chain(attributes.iter().cloned()).collect();
        let help = is_legal(self.values(&all)).then(|| format!("write `{}`", block(&all)));
        Some(Cause { span: first.name.span.clone(), help })
    }

    /// Returns the help for a changed payload, if it is legal.
    fn payload(
        &self,
        is_legal: &dyn Fn(DescriptionValues) -> bool,
        change: impl Fn(&Attribute) -> Attribute,
    ) -> Option<String> {
        let changed: Vec<Attribute> = self.draft.attributes.iter().map(change).collect();
        is_legal(self.values(&changed)).then(|| format!("write `{}`", block(&changed)))
    }

    /// Returns the first attribute that is too much for a limit of words, with a payload within the limit: without attributes that nothing
    /// reads, or in smaller formats that closures read as the same type.
    fn words(&self, is_legal: &dyn Fn(DescriptionValues) -> bool) -> Option<Cause> {
        let attributes = &self.draft.attributes;
        let read: Vec<Attribute> = attributes
            .iter()
            .enumerate()
            .filter(|(index, attribute)| {
                attribute.name.value == "depth" || unused::is_read(attribute, *index, self.draft, self.choices)
            })
            .map(|(_, attribute)| attribute.clone())
            .collect();
        let smaller = |attributes: &[Attribute]| attributes.iter().map(with_smaller_format).collect::<Vec<_>>();
        for changed in [read.clone(), smaller(attributes), smaller(&read)] {
            if changed.is_empty() || !is_legal(self.values(&changed)) {
                continue;
            }
            let differs = attributes.iter().find_map(|attribute| {
                match changed.iter().find(|other| other.name == attribute.name) {
                    None => Some(&attribute.name.span),
                    Some(other) if other.format != attribute.format => Some(&attribute.format.span),
                    Some(_) => None,
                }
            });
            if let Some(span) = differs {
                return Some(Cause { span: span.clone(), help: Some(format!("write `{}`", block(&changed))) });
            }
        }
        if let Some(cause) = self.criterion(is_legal).filter(|cause| cause.help.is_some()) {
            return Some(cause);
        }
        let others = attributes.iter().filter(|attribute| attribute.name.value != "depth");
        let widest = others.max_by_key(|attribute| attribute.format.value.words())?;
        Some(Cause { span: widest.format.span.clone(), help: None })
    }

    /// Returns the values of the description with another payload.
    fn values(&self, attributes: &[Attribute]) -> DescriptionValues {
        let criterion = self.draft.keep.as_ref().and_then(|keep| keep.criterion.as_ref());
        description_values(attributes, criterion, self.draft.resolve.as_ref(), self.given.keep)
    }
}

fn with_format(attribute: &Attribute, format: Format) -> Attribute {
    let mut attribute = attribute.clone();
    attribute.format.value = format;
    attribute
}

/// Returns the attribute in the smallest format that closures read as the same type.
fn with_smaller_format(attribute: &Attribute) -> Attribute {
    match attribute.format.value {
        Format::Vec4 | Format::Rgba16 => with_format(attribute, Format::Rgba8),
        Format::Vec3 if attribute.name.value.contains("normal") => with_format(attribute, Format::Octahedral),
        _ => attribute.clone(),
    }
}

/// Returns the block that declares a payload.
fn block(attributes: &[Attribute]) -> String {
    let declaration = |attribute: &Attribute| format!("{}: {}", attribute.name.value, attribute.format.value.keyword());
    format!("fragment {{ {} }}", attributes.iter().map(declaration).collect::<Vec<_>>().join(", "))
}

/// Returns the `keep` line without a criterion.
fn keep_line(k: Option<u32>) -> String {
    k.map_or("keep all;".to_owned(), |k| format!("keep {k};"))
}
