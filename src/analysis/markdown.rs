//! Axes, rows, techniques and formats as Markdown, from the registry and the model.
//!
//! Input: data of the registry. Output: text for people.

use std::fmt::Write as _;

use fragbuf_model::{Format, counted};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Axis, KeepDefault, Parameter, ParameterType, Resource, Row, Technique};

/// Returns an option with its default, its range and what it does.
pub fn option(parameter: &Parameter) -> String {
    let (least, greatest) = parameter.range;
    let range = match parameter.kind {
        ParameterType::Number => format!(", from {least} to {greatest}"),
        ParameterType::PowerOfTwo => format!(", a power of two from {least} to {greatest}"),
        ParameterType::Attribute => ", an attribute".to_owned(),
    };
    format!("`{}: {}`{range}: {}", parameter.name, parameter.default, parameter.summary)
}

/// Returns an axis with its values.
pub(super) fn axis(axis: &Axis, registry: &Registry) -> String {
    let mut text = format!("**`{}`**: {}\n", axis.key, axis.summary);
    if let Some(default) = axis.default {
        let _ = write!(text, "\nDefault: `{default}`, unless the technique or another choice gives one.\n");
    }
    text.push('\n');
    for row in registry.rows_of(axis.key).filter(|row| !Registry::is_of_closures(row)) {
        let _ = writeln!(text, "* `{}`: {}", row.key, row.summary);
    }
    text
}

/// Returns a value of an axis: its source, its memory, what it guarantees and what it requires.
pub(super) fn row(row: &Row) -> String {
    let mut text = format!("**`{}: {}`**: {}\n", row.axis, row.key, row.summary);
    if !row.paper.is_empty() {
        let _ = write!(text, "\n*{}*\n", row.paper);
    }
    let mut list = |title: &str, items: Vec<String>| {
        if !items.is_empty() {
            let _ = write!(text, "\n{title}:\n\n");
            items.iter().for_each(|item| text.push_str(&format!("* {item}\n")));
        }
    };
    list("Memory", row.resources.iter().map(resource).collect());
    let words = row.extra_words.iter().map(|word| format!("`{}`: a word of every fragment", word.name));
    list("Adds", words.collect());
    list("Guarantees", row.provides.iter().map(|capability| capability.meaning().to_owned()).collect());
    let required = row.requires.iter().map(|capability| capability.meaning().to_owned());
    list("Requires", required.chain(row.conditions.iter().map(|condition| condition.meaning.to_string())).collect());
    list("Needs of the device", row.needs.iter().map(|feature| feature.meaning().to_owned()).collect());
    let hazards = row.hazards.iter().map(|hazard| format!("`{}`: {}", hazard.name, hazard.description));
    list("Hazards", hazards.collect());
    list("Options", row.parameters.iter().map(option).collect());
    text
}

fn resource(resource: &Resource) -> String {
    let length: Vec<String> = resource.extents.iter().map(|extent| extent.length.to_string()).collect();
    let length = if length.is_empty() { "1".to_owned() } else { length.join(" × ") };
    format!("`{}`, length {length}: {}", resource.name, resource.summary)
}

/// Returns a technique with its choices.
pub(super) fn technique(technique: &Technique) -> String {
    let keep = match technique.keep {
        KeepDefault::All => "all".to_owned(),
        KeepDefault::Best(k) => k.to_string(),
    };
    let mut text =
        format!("**{}** (`{}`): {}\n\n*{}*\n\n", technique.title, technique.key, technique.summary, technique.paper);
    let _ = writeln!(text, "* `keep {keep};`");
    for (axis, value) in &technique.choices {
        let _ = writeln!(text, "* `{axis}: {value};`");
    }
    text
}

/// Returns a format of an attribute.
pub(super) fn format(format: Format) -> String {
    let (words, ty) = (counted(format.words(), "word"), fragbuf_syntax::type_of_attribute(format));
    format!("`{}`: {words} of 32 bits per fragment; {}. A closure sees `{ty}`.", format.keyword(), format.meaning())
}
