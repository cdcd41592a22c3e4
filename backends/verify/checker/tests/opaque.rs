//! Fragments behind something opaque: one comes to every pass, just behind the pixel's texel, and another lies exactly at
//! its depth. Nothing may be seen of the first, and nothing of the second be missing; the pixel beside has nothing opaque.

use fragbuf_checker::Model;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Row, Template};

use crate::subjects::{limits, report};

type Set = &'static [(&'static str, &'static str)];

const IN_SHADER: Set = &[("opaque", "in_shader")];
/// Passes ahead of the store pass are explored too.
const CULLED: Set = &[("opaque", "in_shader"), ("cull", "occupancy"), ("cull.words", "1")];
const INTERLOCK: Set = &[("opaque", "in_shader"), ("sync", "interlock")];
const EARLY: Set = &[("opaque", "early")];

const HOLDS: [(&str, Set, &str, Model); 13] = [
    ("kplus_array", IN_SHADER, "wgsl", Model::Sequential),
    ("kplus_array", IN_SHADER, "spirv", Model::Late),
    ("kplus_array", INTERLOCK, "spirv", Model::Late),
    ("kplus_array", CULLED, "wgsl", Model::Sequential),
    ("kplus_array_revised", IN_SHADER, "wgsl", Model::Sequential),
    ("ab_ll", IN_SHADER, "wgsl", Model::Late),
    ("ab_sb", IN_SHADER, "wgsl", Model::Sequential),
    ("ab_sb", IN_SHADER, "wgsl", Model::Late),
    ("kplus_ab_sb", IN_SHADER, "wgsl", Model::Sequential),
    ("ab_ll_bun", IN_SHADER, "wgsl", Model::Sequential),
    ("mdt32_coplanar", IN_SHADER, "wgsl", Model::Late),
    ("kb_ll", IN_SHADER, "spirv", Model::Late),
    ("kplus_array", EARLY, "spirv", Model::Late),
];

#[test]
fn nothing_is_seen_of_what_is_hidden() {
    let registry = Registry::builtin();
    for (key, set, target, model) in HOLDS {
        let report = report(key, set, target, &limits(2, model), &registry).unwrap();
        assert_eq!(report.failure, None, "{key} {set:?} {target} {model:?}");
        assert!(report.is_whole && report.cases >= 10, "{key} {set:?} {target} {model:?}: {}", report.cases);
    }
}

/// The registry with a text of a row's template in place of another.
fn changed(axis: &str, key: &str, (before, after): (&str, &str)) -> Registry {
    let registry = Registry::builtin();
    let row = registry.row(axis, key).unwrap().clone();
    let template = row.template.clone().unwrap();
    assert_eq!(template.text.matches(before).count(), 1, "{axis}/{key}: {before}");
    let text = template.text.replace(before, after);
    registry.with(Row { template: Some(Template::new(template.path, text)), ..row })
}

/// Axis and key of a row, a text in it and what it becomes, the technique that shows it.
type Wrong = (&'static str, &'static str, (&'static str, &'static str), &'static str, Set);

/// Leaves a hidden fragment out without counting it.
const HIDDEN_IS_UNCOUNTED: &str = "    if opaque_hides(position, fragment) {
        return;
    }
    if !fragment_enters_counted(";

/// Counts a hidden fragment as another event.
const HIDDEN_IS_CULLED: &str = "    if opaque_hides(position, fragment) {
        count_event(CULLED);
        return;
    }
    if !fragment_enters_counted(";

const WRONG: [Wrong; 8] = [
    ("opaque", "in_shader", ("depth > opaque", "depth >= opaque"), "kplus_array", IN_SHADER),
    ("opaque", "in_shader", ("depth > opaque", "depth < opaque"), "kplus_array", IN_SHADER),
    ("opaque", "in_shader", ("pixel_index(position)", "1u - pixel_index(position)"), "kplus_array", IN_SHADER),
    ("opaque", "in_shader", ("fragment.depth > ", "2.0 < "), "kplus_array", IN_SHADER),
    ("pass", "store", ("    if !fragment_enters_counted(", HIDDEN_IS_UNCOUNTED), "kplus_array", IN_SHADER),
    ("pass", "store", ("    if !fragment_enters_counted(", HIDDEN_IS_CULLED), "kplus_array", IN_SHADER),
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
fn what_takes_hidden_fragments_in_is_noticed() {
    for (axis, key, change, technique, set) in WRONG {
        let registry = changed(axis, key, change);
        let report = report(technique, set, "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
        assert!(report.failure.is_some(), "{axis}/{key}: {change:?}");
    }
}
