//! Occlusion by opaque surfaces. Every pass draws a fragment just behind the pixel's opaque depth, and another exactly at
//! it. The first must be rejected and the second kept. The neighbouring pixel has no opaque surface.

use fragbuf_checker::Model;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Row, Template};

use crate::subjects::{limits, report};

type Set = &'static [(&'static str, &'static str)];

const IN_SHADER: Set = &[("opaque", "in_shader")];
/// Passes before the store pass are explored too.
const CULLED: Set = &[("opaque", "in_shader"), ("cull", "occupancy"), ("cull.words", "1")];
const INTERLOCK: Set = &[("opaque", "in_shader"), ("sync", "interlock")];
const EARLY: Set = &[("opaque", "early_depth")];

const HOLDS: [(&str, Set, &str, Model); 13] = [
    ("kplus_array", IN_SHADER, "wgsl", Model::Sequential),
    ("kplus_array", IN_SHADER, "spirv", Model::Relaxed),
    ("kplus_array", INTERLOCK, "spirv", Model::Relaxed),
    ("kplus_array", CULLED, "wgsl", Model::Sequential),
    ("kplus_array_revised", IN_SHADER, "wgsl", Model::Sequential),
    ("ab_ll", IN_SHADER, "wgsl", Model::Relaxed),
    ("ab_sb", IN_SHADER, "wgsl", Model::Sequential),
    ("ab_sb", IN_SHADER, "wgsl", Model::Relaxed),
    ("kplus_ab_sb", IN_SHADER, "wgsl", Model::Sequential),
    ("ab_ll_bun", IN_SHADER, "wgsl", Model::Sequential),
    ("mdt32_coplanar", IN_SHADER, "wgsl", Model::Relaxed),
    ("kb_ll", IN_SHADER, "spirv", Model::Relaxed),
    ("kplus_array", EARLY, "spirv", Model::Relaxed),
];

#[test]
fn occluded_fragments_are_rejected() {
    let registry = Registry::builtin();
    for (key, set, target, model) in HOLDS {
        let report = report(key, set, target, &limits(2, model), &registry).unwrap();
        assert_eq!(report.failure, None, "{key} {set:?} {target} {model:?}");
        assert!(report.is_exhaustive && report.cases >= 10, "{key} {set:?} {target} {model:?}: {}", report.cases);
    }
}

/// Returns the registry with a replacement in a row's template.
fn changed(axis: &str, key: &str, (before, after): (&str, &str)) -> Registry {
    let registry = Registry::builtin();
    let row = registry.row(axis, key).unwrap().clone();
    let template = row.template.clone().unwrap();
    assert_eq!(template.source.matches(before).count(), 1, "{axis}/{key}: {before}");
    let text = template.source.replace(before, after);
    registry.with(Row { template: Some(Template::new(template.path, text)), ..row })
}

/// Axis and key of a row, a replacement in its template, and the technique that shows the error.
type Wrong = (&'static str, &'static str, (&'static str, &'static str), &'static str, Set);

/// Rejects an occluded fragment without counting it.
const OCCLUDED_IS_UNCOUNTED: &str = "    if opaque_hides(position, fragment) {
        return;
    }
    if !fragment_enters_counted(";

/// Counts an occluded fragment as culled.
const OCCLUDED_IS_CULLED: &str = "    if opaque_hides(position, fragment) {
        count_event(CULLED);
        return;
    }
    if !fragment_enters_counted(";

const WRONG: [Wrong; 8] = [
    ("opaque", "in_shader", ("depth > opaque", "depth >= opaque"), "kplus_array", IN_SHADER),
    ("opaque", "in_shader", ("depth > opaque", "depth < opaque"), "kplus_array", IN_SHADER),
    ("opaque", "in_shader", ("pixel_index(position)", "1u - pixel_index(position)"), "kplus_array", IN_SHADER),
    ("opaque", "in_shader", ("fragment.depth > ", "2.0 < "), "kplus_array", IN_SHADER),
    ("pass", "store", ("    if !fragment_enters_counted(", OCCLUDED_IS_UNCOUNTED), "kplus_array", IN_SHADER),
    ("pass", "store", ("    if !fragment_enters_counted(", OCCLUDED_IS_CULLED), "kplus_array", IN_SHADER),
    (
        "pass",
        "store_reserving",
        ("fragment_enters_counted(position, fragment)", "admit(fragment)"),
        "kplus_ab_sb",
        IN_SHADER,
    ),
    ("pass", "count", ("fragment_enters(position, fragment)", "admit(fragment)"), "ab_sb", IN_SHADER),
];

#[test]
fn accepting_occluded_fragments_fails() {
    for (axis, key, change, technique, set) in WRONG {
        let registry = changed(axis, key, change);
        let report = report(technique, set, "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
        assert!(report.failure.is_some(), "{axis}/{key}: {change:?}");
    }
}
