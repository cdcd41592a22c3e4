//! Generates how a pass calls the closure of its effect or image.

use std::fmt::Write;

use fragbuf_templates::vocabulary::Pass;

use super::{lookups, resumable};
use crate::Plan;

/// Generates the functions of the contract of the effect, for a description with a closure.
pub(super) fn text(plan: &Plan, pass: &Pass, text: &mut String) {
    let variant = &plan.variant;
    if let Some(image) = lookups::image_of(plan, pass) {
        return whole(&image.function.name, text);
    }
    match (&variant.resolve, resumable::interrupted(plan)) {
        (Some(_), Some(parts)) => resumable::text(parts, text),
        (Some(closure), None) => whole(&closure.name, text),
        (None, _) => {}
    }
    if let Some(between) = &variant.between {
        let _ = writeln!(
            text,
            "fn stream_value(front: Fragment, back: Fragment, gap: f32) -> vec4<f32> {{\n    return {}(front, back, gap);\n}}",
            between.name
        );
    }
}

/// Generates the call of a closure over all fragments.
fn whole(closure: &str, text: &mut String) {
    let _ = writeln!(text, "fn resolve_layers() -> vec4<f32> {{\n    return {closure}();\n}}");
}
