//! What a fragment carries, and what of it the conditions of rows may ask.

use fragbuf_templates::vocabulary::Given;

use crate::{Attribute, Diagnostic, Diagnostics, Draft, Format, UserFunction, codes};

/// The description's attributes, or the papers' payload.
pub(super) fn attributes(draft: &Draft, diagnostics: &mut Diagnostics) -> Vec<Attribute> {
    if draft.attributes.is_empty() {
        return draft.papers_payload();
    }
    let depth = draft.attributes.iter().find(|attribute| attribute.name.value == "depth");
    match depth {
        Some(depth) if depth.format.value != Format::F32 => diagnostics.push(Diagnostic::new(
            codes::MISSING_DEPTH,
            &depth.format.origin,
            format!("`depth` is {}, not f32", depth.format.value.keyword()),
            "write `depth: f32`; a second depth of another format needs another name",
        )),
        Some(_) => {}
        None => diagnostics.push(Diagnostic::new(
            codes::MISSING_DEPTH,
            &draft.attributes[0].name.origin,
            "the payload has no `depth`",
            "add `depth: f32`: kept fragments are put in its order, and without a criterion the farthest is the worst",
        )),
    }
    draft.attributes.clone()
}

/// What a description gives to the conditions of rows; the words that rows carry come on top.
pub(crate) fn given(attributes: &[Attribute], criterion: Option<&UserFunction>, keep: Option<u32>) -> Given {
    let color = attributes.iter().find(|attribute| attribute.name.value == "color");
    Given {
        keep,
        payload_words: attributes.iter().map(|attribute| attribute.format.value.words()).sum(),
        has_criterion: criterion.is_some(),
        has_color: color
            .is_some_and(|color| matches!(color.format.value, Format::Rgba8 | Format::Rgba16 | Format::Vec4)),
    }
}
