//! The rules. Input: a draft. Output: a variant, or every error. No rule names a technique, a storage or any other row:
//! which rows are compatible follows from the capabilities that they require and provide, and from their conditions.

mod capabilities;
mod causes;
mod choices;
mod command_line;
mod extra_words;
mod merged;
mod option_minimums;
mod payload;
mod suggestion;
mod unused;
mod warnings;

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{DescriptionValues, KeepDefault};

pub(crate) use self::payload::description_values;
use crate::variant::Description;
use crate::{Diagnostic, Diagnostics, Draft, KeepCount, Variant, codes};

/// The greatest k of a k-buffer; a resolve pass holds k fragments in registers or local memory.
pub const MAX_K: u32 = 1024;

/// Checks a draft against a registry. Returns all errors at once.
pub fn check(draft: &Draft, registry: &Registry) -> Result<Variant, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let technique = choices::technique(draft, registry, &mut diagnostics);
    let attributes = payload::attributes(draft, &mut diagnostics);
    let choices = choices::resolve(draft, &attributes, technique, registry, &mut diagnostics);
    let keep = keep(draft, technique.map(|technique| technique.keep), &mut diagnostics);
    if let Some(k) = keep {
        option_minimums::check(draft, &choices, k, &mut diagnostics);
    }
    if let (Some(between), Some(image)) = (&draft.between, draft.images.first()) {
        diagnostics.push(
            Diagnostic::new(
                codes::UNSUPPORTED,
                &between.span,
                "the effect `between` is computed while fragments are composited, and cannot read images",
                format!("write the effect as `resolve |fragments, u| …`, or remove `image {}`", image.name.value),
            )
            .label(&image.name.span, "the image"),
        );
    }
    extra_words::check(&attributes, &choices, &mut diagnostics);
    let criterion = draft.keep.as_ref().and_then(|keep| keep.criterion.as_ref());
    // With a missing storage, an unknown choice or a part with errors, every capability would be reported as missing.
    if diagnostics.is_empty() && !draft.incomplete.hides_capabilities() {
        let given = description_values(&attributes, criterion, draft.resolve.as_ref(), keep);
        // What a closure with errors would need is unknown.
        let given = DescriptionValues { is_resumable: given.is_resumable || draft.incomplete.resolve, ..given };
        capabilities::check(draft, &choices, given, registry, &mut diagnostics);
    }
    let diagnostics = command_line::fixes(draft, registry, diagnostics);
    let warnings = warnings::warnings(draft, &choices);
    let variant = Variant::new(Description {
        name: draft.name.clone(),
        technique: technique.map(|technique| technique.key.clone()),
        attributes,
        uniforms: draft.uniforms.clone(),
        textures: draft.textures.clone(),
        keep,
        keep_span: draft.keep.as_ref().map(|keep| keep.count.span.clone()),
        criterion: criterion.cloned(),
        constraints: draft.constraints.clone(),
        resolve: draft.resolve.clone(),
        between: draft.between.clone(),
        images: draft.images.clone(),
        helpers: draft.helpers.clone(),
        choices,
        warnings,
    });
    diagnostics.into_result(variant)
}

/// Returns the number of kept fragments: the description's, else the technique's; `None` for all.
fn keep(draft: &Draft, default: Option<KeepDefault>, diagnostics: &mut Diagnostics) -> Option<u32> {
    let Some(keep) = &draft.keep else {
        return match default {
            Some(KeepDefault::Best(k)) => Some(k),
            Some(KeepDefault::All) | None => None,
        };
    };
    let KeepCount::AtMost(k) = keep.count.value else {
        if let Some(criterion) = &keep.criterion {
            diagnostics.push(Diagnostic::new(
                codes::KEEP_MISMATCH,
                &criterion.span,
                "a criterion selects among fragments, but `keep all` keeps every fragment",
                "write `keep 8 least |f| …` to keep the 8 least, or remove `least …`; to reject fragments, use `where`",
            ));
        }
        return None;
    };
    if k == 0 || k > MAX_K {
        diagnostics.push(Diagnostic::new(
            codes::K_OUT_OF_RANGE,
            &keep.count.span,
            format!("a pixel cannot keep {k} fragments"),
            format!("keep from 1 to {MAX_K}; `keep all` with a storage such as linked_list has no limit"),
        ));
    }
    Some(k)
}
