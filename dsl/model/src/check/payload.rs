//! What a fragment carries, and what that offers to the rows.

use fragbuf_templates::vocabulary::Fact;

use crate::variant::Chosen;
use crate::{Attribute, Diagnostic, Diagnostics, Draft, Format, UserFunction, codes};

/// Targets of one word that every WebGPU device has: eight, of 32 bytes a pixel together.
const TARGETS: u32 = 8;

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

/// What a payload offers, with the words that rows add. A criterion is a word of its own, where depth alone is the key
/// already.
pub(super) fn facts(attributes: &[Attribute], criterion: Option<&UserFunction>, choices: &[Chosen]) -> Vec<Fact> {
    let mut facts = Vec::new();
    let color = attributes.iter().find(|attribute| attribute.name.value == "color");
    if color.is_some_and(|color| matches!(color.format.value, Format::Rgba8 | Format::Rgba16 | Format::Vec4)) {
        facts.push(Fact::Color);
    }
    let words: u32 = attributes.iter().map(|attribute| attribute.format.value.words()).sum();
    let words = words + choices.iter().map(carried).sum::<u32>();
    if words <= 2 {
        facts.push(Fact::OneWordBesideDepth);
    }
    if words <= TARGETS {
        facts.push(Fact::WordPerTarget);
    }
    if words + u32::from(criterion.is_some()) <= 2 {
        facts.push(Fact::OneWordBesideKey);
    }
    facts
}

/// The most words that a fragment carries for one axis.
fn carried(chosen: &Chosen) -> u32 {
    chosen.alternatives.iter().map(|selected| selected.row.carries.len() as u32).max().unwrap_or(0)
}
