//! The payload of a fragment, and its properties that the conditions of rows read.

use fragbuf_templates::vocabulary::DescriptionValues;

use crate::{Attribute, Diagnostic, Diagnostics, Draft, Format, Resumable, UserFunction, codes};

/// Returns the description's attributes, or the papers' payload.
pub(super) fn attributes(draft: &Draft, diagnostics: &mut Diagnostics) -> Vec<Attribute> {
    if draft.attributes.is_empty() {
        return draft.papers_payload();
    }
    let depth = draft.attributes.iter().find(|attribute| attribute.name.value == "depth");
    match depth {
        Some(depth) if depth.format.value != Format::F32 => diagnostics.push(Diagnostic::new(
            codes::MISSING_DEPTH,
            &depth.format.span,
            format!("`depth` is {}, not f32", depth.format.value.keyword()),
            "write `depth: f32`; a second depth of another format needs another name",
        )),
        Some(_) => {}
        None if draft.incomplete.attributes => {}
        None => diagnostics.push(Diagnostic::new(
            codes::MISSING_DEPTH,
            &draft.attributes[0].name.span,
            "the payload has no `depth`",
            "add `depth: f32`: kept fragments are sorted by it, and without a criterion the farthest is the worst",
        )),
    }
    draft.attributes.clone()
}

/// The words that named effects keep: the premultiplied colour composited so far, and the transmittance behind it.
const COMPOSITED_WORDS: u32 = 4;

/// Returns the values of a description that the conditions of rows read, without the extra words of rows.
pub(crate) fn description_values(
    attributes: &[Attribute],
    criterion: Option<&UserFunction>,
    resolve: Option<&UserFunction>,
    keep: Option<u32>,
) -> DescriptionValues {
    let color = attributes.iter().find(|attribute| attribute.name.value == "color");
    DescriptionValues {
        keep,
        payload_words: attributes.iter().map(|attribute| attribute.format.value.words()).sum(),
        has_criterion: criterion.is_some(),
        has_color: color
            .is_some_and(|color| matches!(color.format.value, Format::Rgba8 | Format::Rgba16 | Format::Vec4)),
        is_resumable: resolve.is_some_and(|closure| closure.resumable().is_some()),
        resumed_words: resolve.map_or(COMPOSITED_WORDS, |closure| closure.resumable().map_or(0, Resumable::words)),
    }
}
