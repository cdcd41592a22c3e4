//! Warns of attributes, uniforms, textures, images, functions and variables that nothing uses.
//!
//! Input: a draft and its choices. Output: a warning per unused name, in the order of the source. Attributes that a choice reads are used:
//! its condition, an option or its WGSL mentions them. The attributes of a preset are not the user's, so no warning names them.

use fragbuf_templates::vocabulary::ParameterType;

use crate::variant::{AxisChoice, SelectedRow};
use crate::{Attribute, Diagnostic, Diagnostics, Draft, Spanned, Unused, UserFunction, codes, counted, mangled};

/// Returns the warnings.
pub(super) fn warnings(draft: &Draft, choices: &[AxisChoice]) -> Diagnostics {
    let attributes = draft.attributes.iter().enumerate();
    let unread = attributes.filter(|(index, attribute)| {
        // The payload of the papers has the span of the buffer's name.
        let is_written = attribute.name.span != draft.name.span;
        is_written && attribute.name.value != "depth" && !is_read(attribute, *index, draft, choices)
    });
    let uniforms = draft.uniforms.iter().map(|uniform| &uniform.name);
    let unread_uniforms =
        uniforms.filter(|name| !closures(draft).any(|closure| closure.reads.uniforms.contains(&name.value)));
    let mut warnings: Vec<Diagnostic> = unread.map(|(_, attribute)| unused_attribute(attribute)).collect();
    warnings.extend(unread_uniforms.map(unused_uniform));
    let textures = draft.textures.iter().map(|texture| &texture.name);
    let unread_textures =
        textures.filter(|name| !closures(draft).any(|closure| closure.reads.textures.contains(&name.value)));
    warnings.extend(unread_textures.map(|name| unused_texture(name, "texture")));
    let images = draft.images.iter().map(|image| &image.name);
    let unread_images =
        images.filter(|name| !closures(draft).any(|closure| closure.reads.images.contains(&name.value)));
    warnings.extend(unread_images.map(|name| unused_texture(name, "image")));
    warnings.extend(draft.unused.iter().map(unused_name));
    warnings.sort_by_key(|warning| (warning.span.line, warning.span.column));
    warnings.into_iter().collect()
}

/// Returns the closures, which are the functions that passes call.
fn closures(draft: &Draft) -> impl Iterator<Item = &UserFunction> {
    let criterion = draft.keep.as_ref().and_then(|keep| keep.criterion.as_ref());
    let images = draft.images.iter().map(|image| &image.function);
    criterion.into_iter().chain(&draft.constraints).chain(images).chain(&draft.between).chain(&draft.resolve)
}

/// Tests whether a closure or a choice reads an attribute.
pub(super) fn is_read(attribute: &Attribute, index: usize, draft: &Draft, choices: &[AxisChoice]) -> bool {
    let name = &attribute.name.value;
    closures(draft).any(|closure| closure.reads.attributes.contains(name))
        || choices.iter().flat_map(|chosen| &chosen.alternatives).any(|selected| reads(selected, name, index))
}

/// Tests whether a row reads an attribute.
fn reads(selected: &SelectedRow, name: &str, index: usize) -> bool {
    let row = &selected.row;
    let in_wgsl = row.template.as_ref().is_some_and(|template| has_member(&template.source, &mangled(name)));
    let in_condition = row.conditions.iter().any(|condition| condition.formula.mentions(name));
    let mut parameters = row.parameters.iter().filter(|parameter| parameter.kind == ParameterType::Attribute);
    let by_option = parameters.any(|parameter| {
        let set =
            selected.options.iter().find(|(option, _)| *option == *parameter.name).map(|(_, value)| u64::from(*value));
        // A default that depends on symbols may be any attribute.
        let value = set.or_else(|| parameter.default.evaluate(&|_| None).ok());
        value.is_none_or(|value| value == index as u64)
    });
    in_wgsl || in_condition || by_option
}

/// Tests whether WGSL has the member `.name`.
fn has_member(source: &str, name: &str) -> bool {
    source.match_indices(name).any(|(at, _)| {
        let is_end = |letter: char| !letter.is_alphanumeric() && letter != '_';
        source[..at].ends_with('.') && source[at + name.len()..].chars().next().is_none_or(is_end)
    })
}

fn unused_attribute(attribute: &Attribute) -> Diagnostic {
    let (name, words) = (&attribute.name.value, counted(attribute.format.value.words(), "word"));
    let message = format!("nothing reads the attribute `{name}`, which is {words} of every fragment");
    Diagnostic::new(
        codes::UNUSED_ATTRIBUTE,
        &attribute.name.span,
        message,
        format!("remove `{name}`, or read it in a closure"),
    )
}

fn unused_uniform(name: &Spanned<String>) -> Diagnostic {
    let message = format!("no closure reads the uniform `{}`", name.value);
    Diagnostic::new(
        codes::UNUSED_UNIFORM,
        &name.span,
        message,
        format!("remove `{0}`, or read it as `u.{0}`", name.value),
    )
}

fn unused_texture(name: &Spanned<String>, what: &str) -> Diagnostic {
    let message = format!("no closure reads the {what} `{}`", name.value);
    let help = format!("remove `{0}`, or read it as `u.{0}`", name.value);
    Diagnostic::new(codes::UNUSED_UNIFORM, &name.span, message, help)
}

fn unused_name(unused: &Spanned<Unused>) -> Diagnostic {
    let (code, message, help) = match &unused.value {
        Unused::Function(name) => {
            (codes::UNUSED_FUNCTION, format!("no closure calls the function `{name}`"), format!("remove `fn {name}`"))
        }
        Unused::Variable(name) => (
            codes::UNUSED_VARIABLE,
            format!("nothing reads the variable `{name}`"),
            format!("remove it, or call it `_{name}`"),
        ),
    };
    Diagnostic::new(code, &unused.span, message, help)
}
