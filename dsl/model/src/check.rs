//! The rules: a draft in, a proven variant or every mistake out. No rule names a technique, a storage or any other row:
//! what fits together follows from what rows require and offer, and from conditions that they state.

mod choices;
mod facts;
mod least;
mod nearest;
mod payload;

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::KeepDefault;

pub(crate) use self::payload::given;
use crate::variant::Description;
use crate::{Diagnostic, Diagnostics, Draft, KeepCount, Variant, codes};

/// The greatest number of fragments that a k-buffer keeps; a resolve pass holds them all in registers or local memory.
pub const MOST_KEPT: u32 = 1024;

/// Checks a draft against a registry. All mistakes come at once.
pub fn check(draft: &Draft, registry: &Registry) -> Result<Variant, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let technique = choices::technique(draft, registry, &mut diagnostics);
    let attributes = payload::attributes(draft, &mut diagnostics);
    let choices = choices::resolve(draft, &attributes, technique, registry, &mut diagnostics);
    let keep = keep(draft, technique.map(|technique| technique.keep), &mut diagnostics);
    if let Some(k) = keep {
        least::check(draft, &choices, k, &mut diagnostics);
    }
    let criterion = draft.keep.as_ref().and_then(|keep| keep.criterion.as_ref());
    // A storage that is missing, or a choice that is unknown, would make every fact look unmet.
    if diagnostics.is_empty() {
        let given = given(&attributes, criterion, keep);
        facts::check(draft, &choices, given, registry, &mut diagnostics);
    }
    let variant = Variant::proven(Description {
        name: draft.name.clone(),
        technique: technique.map(|technique| technique.key.clone()),
        attributes,
        uniforms: draft.uniforms.clone(),
        keep,
        criterion: criterion.cloned(),
        constraints: draft.constraints.clone(),
        resolve: draft.resolve.clone(),
        helpers: draft.helpers.clone(),
        choices,
    });
    diagnostics.gate(variant)
}

/// How many fragments stay: what the description says, else the technique.
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
                &criterion.origin,
                "a criterion chooses among fragments, but `keep all` keeps every one",
                "write `keep 8 least |f| …` to keep the 8 least, or drop `least …`; to turn fragments away use `where`",
            ));
        }
        return None;
    };
    if k == 0 || k > MOST_KEPT {
        diagnostics.push(Diagnostic::new(
            codes::CAPACITY,
            &keep.count.origin,
            format!("a pixel cannot keep {k} fragments"),
            format!("keep from 1 to {MOST_KEPT}; `keep all` with a storage such as linked_list has no limit"),
        ));
    }
    Some(k)
}
