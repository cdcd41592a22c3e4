//! Tests every kind of error in a complete description, rendered with its source line. `dsl/syntax` tests errors of the grammar and of
//! closures.

use std::collections::BTreeSet;

use fragbuf::report::render;
use fragbuf::vocabulary::{Capability, Row};
use fragbuf::{Registry, Severity};
use fragbuf_model::codes;

use crate::cases::{checked, has_empty_list, text};

/// Code, line, column, and a part of the help.
pub type Expected = (&'static str, u32, u32, &'static str);

/// Descriptions with their expected diagnostics.
pub const CASES: &[(&str, &[Expected])] = &[
    (
        "buffer B from kplus_array {\n    storage: linked_list;\n    sync: slot_counter;\n    keep 6;\n}",
        &[("keep-mismatch", 4, 10, "write `keep all;` and `cull: none`")],
    ),
    ("buffer B from kplus_aray { }", &[("unknown-technique", 1, 15, "did you mean `kplus_array`?")]),
    ("buffer B {\n    keep 8;\n}", &[("missing-storage", 1, 8, "from kplus_array")]),
    ("buffer B from ab_ll {\n    strage: max_array;\n}", &[("unknown-axis", 2, 5, "did you mean `storage`?")]),
    ("buffer B from ab_ll {\n    sort: insertoin;\n}", &[("unknown-value", 2, 11, "did you mean `insertion`?")]),
    ("buffer B from ab_ll {\n    sort: bitonc;\n}", &[("unknown-value", 2, 11, "insertion")]),
    (
        "buffer B from kplus_array {\n    sync: spin_lock { limt: 9 };\n}",
        &[("unknown-option", 2, 23, "did you mean `limit`?")],
    ),
    ("buffer B from kplus_array {\n    sync: spin_lock { limit: 0 };\n}", &[("invalid-option", 2, 30, "16384")]),
    ("buffer B from kplus_array {\n    sync: spin_lock { limit: many };\n}", &[("invalid-option", 2, 30, "tries")]),
    (
        "buffer B from kplus_array {\n    cull: early { x: 1 };\n}",
        &[("unknown-option", 2, 19, "has no options: remove it")],
    ),
    ("buffer B from kplus_array {\n    ties: attribute { by: id };\n}", &[("invalid-option", 2, 27, "decides")]),
    ("buffer B from kplus_array {\n    ties: attribute { by: 1 };\n}", &[("invalid-option", 2, 27, "decides")]),
    ("buffer B from kplus_array {\n    ties: submission;\n}", &[("missing-capability", 2, 11, "`ties: payload`")]),
    ("buffer B from kplus_array {\n    keep 0;\n}", &[("k-out-of-range", 2, 10, "from 1 to 1024")]),
    ("buffer B from kplus_array {\n    keep 5000;\n}", &[("k-out-of-range", 2, 10, "keep all")]),
    ("buffer B from kplus_array {\n    keep all;\n}", &[("keep-mismatch", 2, 10, "keep 8")]),
    ("buffer B from ab_ll {\n    keep 8;\n}", &[("keep-mismatch", 2, 10, "keep all")]),
    ("buffer B from ab_ll {\n    keep all least |f| f.depth;\n}", &[("keep-mismatch", 2, 20, "where")]),
    ("buffer B from kplus_array {\n    sync: none;\n}", &[("missing-capability", 2, 11, "`sync: spin_lock`")]),
    ("buffer B from kplus_array {\n    sync: slot_counter;\n}", &[("missing-capability", 2, 11, "`sync: spin_lock`")]),
    ("buffer B from ab_ll {\n    cull: early;\n}", &[("missing-capability", 2, 11, "`cull: none`")]),
    ("buffer B from ab_ll {\n    sort: none;\n}", &[("missing-capability", 2, 11, "`sort: insertion`")]),
    (
        "buffer B from kb {\n    keep 8 least |f| f.depth - f.color.w;\n}",
        &[("missing-capability", 2, 18, "`sort: insertion`")],
    ),
    ("buffer B from ab_ll {\n    fragment { depth: f32 }\n}", &[("missing-capability", 2, 16, "color: rgba8")]),
    ("buffer B from ab_ll {\n    fragment { color: rgba8, z: f32 }\n}", &[("missing-depth", 2, 16, "`depth: f32`")]),
    (
        "buffer B from ab_ll {\n    fragment { color: rgba8, depth: u32 }\n}",
        &[("missing-depth", 2, 37, "`depth: f32`")],
    ),
    // Consequences of an unknown format are not reported.
    (
        "buffer B from ab_ll {\n    fragment { color: rgb8, depth: f23 }\n}",
        &[("unknown-format", 2, 23, "`rgba8`"), ("unknown-format", 2, 36, "`f32`")],
    ),
    (
        "buffer B from ab_ll {\n    resolve: over;\n    resolve |fragments, u| { vec4(0.0, 0.0, 0.0, 1.0) }\n}",
        &[("duplicate", 3, 5, "remove one")],
    ),
    (
        "buffer B from kplus_heap {\n    cull: occupancy { words: 1 };\n}",
        &[("invalid-option", 2, 30, "`words: 2` or more")],
    ),
    ("buffer B from ab_ll {\n    cull: occupancy;\n}", &[("missing-capability", 2, 11, "`cull: none`")]),
    ("buffer B from kb_ab_sb {\n    cull: occupancy;\n}", &[("missing-capability", 2, 11, "`storage: linked_list`")]),
    (
        "buffer B from depth_partition {\n    cull: occupancy;\n}",
        &[("missing-capability", 2, 11, "`storage: sorted_array`")],
    ),
    (
        "buffer B from kplus_array {\n    keep 8 least |f| f.depth - f.color.w;\n    cull: occupancy_early;\n}",
        &[("missing-capability", 2, 18, "`cull: occupancy`")],
    ),
    ("buffer B from z_buffer {\n    samples: coverage;\n}", &[("missing-capability", 2, 14, "`samples: one`")]),
    ("buffer B from kb_sr {\n    samples: coverage;\n}", &[("missing-capability", 2, 14, "`samples: one`")]),
    ("buffer B from kb_stream {\n    samples: coverage;\n}", &[("missing-capability", 2, 14, "`samples: one`")]),
    // The mask is a third word.
    ("buffer B from kb_mdt64 {\n    samples: coverage;\n}", &[("missing-capability", 2, 14, "`storage: cascade`")]),
    ("buffer B from ab_ll {\n    samples: coverage { count: 3 };\n}", &[("invalid-option", 2, 32, "every device")]),
    (
        "buffer B from kplus_array {\n    samples: coverage;\n    cull: occupancy_early;\n}",
        &[("missing-capability", 3, 11, "`cull: occupancy`")],
    ),
    (
        "buffer B from ab_ll {\n    opaque: early_depth;\n    samples: coverage;\n}",
        &[("missing-capability", 2, 13, "`opaque: in_shader`")],
    ),
    // Depth test and stencil are taken: by the storage, by the cull.
    ("buffer B from z_buffer {\n    opaque: early_depth;\n}", &[("missing-capability", 2, 13, "`opaque: in_shader`")]),
    ("buffer B from kb_sr {\n    opaque: early_depth;\n}", &[("missing-capability", 2, 13, "`opaque: none`")]),
    (
        "buffer B from kplus_array {\n    cull: occupancy_early;\n    opaque: early_depth;\n}",
        &[("missing-capability", 3, 13, "`cull: occupancy`")],
    ),
    ("buffer B from ab_ll {\n    opaque: late;\n}", &[("unknown-value", 2, 13, "none, in_shader, early_depth")]),
    // Culled fragments cannot be blended or merged.
    ("buffer B from kplus_array {\n    overflow: tail_blend;\n}", &[("missing-capability", 2, 15, "`cull: none`")]),
    ("buffer B from kplus_array {\n    overflow: merge_last;\n}", &[("missing-capability", 2, 15, "`cull: none`")]),
    (
        "buffer B from kplus_array {\n    overflow: merge_last;\n    cull: occupancy;\n}",
        &[("missing-capability", 2, 15, "`cull: none`")],
    ),
    // Nor what no critical section keeps apart.
    ("buffer B from kb {\n    overflow: merge_last;\n}", &[("missing-capability", 2, 15, "`sync: spin_lock`")]),
    ("buffer B from kb_ab_ll {\n    overflow: tail_blend;\n}", &[("missing-capability", 2, 15, "weighted_tail")]),
    // The farthest must be the worst, and the slots in the order of depth.
    (
        "buffer B from kplus_array {\n    cull: none;\n    overflow: merge_last;\n    keep 8 least |f| f.color.x;\n}",
        &[("missing-capability", 4, 18, "`overflow: tail_blend`")],
    ),
    (
        "buffer B from kplus_array {\n    cull: none;\n    overflow: merge_closest;\n}",
        &[("missing-capability", 3, 15, "`storage: sorted_array`")],
    ),
    (
        "buffer B from depth_partition {\n    overflow: merge_last;\n}",
        &[("missing-capability", 2, 15, "`storage: sorted_array`")],
    ),
    (
        "buffer B from kplus_array {\n    fragment { depth: f32 }\n    cull: none;\n    overflow: merge_last;\n    resolve |f, u| { vec4(0.0, 0.0, 0.0, 1.0) }\n}",
        &[("missing-capability", 2, 16, "color: rgba8")],
    ),
    (
        "buffer B from ab_ll {\n    sync: spin_lock else slot_counter;\n    sort: nothing;\n    keep 0;\n}",
        &[("unknown-value", 3, 11, "none"), ("k-out-of-range", 4, 10, "from 1")],
    ),
];

#[test]
fn every_error_has_its_code_span_and_help() {
    for (source, expected) in CASES {
        let diagnostics = checked(&text(source), &[]).err().unwrap_or_else(|| panic!("accepted: {source}"));
        let found: Vec<_> = diagnostics
            .iter()
            .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column))
            .collect();
        let wanted: Vec<_> = expected.iter().map(|(code, line, column, _)| (*code, *line, *column)).collect();
        assert_eq!(found, wanted, "{source}\n{diagnostics}");
        for (diagnostic, (.., help)) in diagnostics.iter().zip(*expected) {
            assert!(!diagnostic.help.is_empty() && diagnostic.help.contains(help), "{source}\n{diagnostics}");
            assert!(!has_empty_list(diagnostic), "{source}\n{diagnostics}");
        }
    }
}

#[test]
fn every_code_of_whole_descriptions_is_covered() {
    let covered: BTreeSet<&str> =
        CASES.iter().flat_map(|(_, diagnostics)| diagnostics.iter().map(|(code, ..)| *code)).collect();
    let first = codes::ALL.iter().position(|code| *code == codes::UNKNOWN_TECHNIQUE).unwrap();
    // `target` needs a target without atomics, `internal` a defect.
    let errors = codes::ALL[first..].iter().filter(|code| code.severity == Severity::Error);
    for code in errors.filter(|code| ![codes::UNSUPPORTED_TARGET, codes::INTERNAL].contains(code)) {
        assert!(covered.contains(code.name), "no case for {}", code.name);
    }
}

#[test]
fn a_hint_is_a_change_that_works() {
    let source = "buffer B from kplus_array {\n    sync: none;\n}";
    let diagnostics = checked(&text(source), &[]).unwrap_err();
    assert!(diagnostics.iter().all(|diagnostic| diagnostic.help.contains("`sync: spin_lock`")), "{diagnostics}");
    assert!(checked(&text(&source.replace("none", "spin_lock")), &[]).is_ok());
}

/// Some capabilities are provided under a condition, or by no row that a description can choose.
#[test]
fn a_missing_capability_always_has_help() {
    let builtin = Registry::builtin();
    let over = builtin.row("resolve", "over").unwrap().clone();
    let mut missing = 0;
    for capability in Capability::ALL {
        for preset in ["ab_ll", "kplus_array", "kb_sr"] {
            let row = Row { key: "demanding".to_owned(), requires: vec![*capability], ..over.clone() };
            let source = format!("buffer B from {preset} {{ resolve: demanding; }}");
            let draft = fragbuf::parse(&source, "case.fragbuf").draft.unwrap();
            let Err(diagnostics) = fragbuf::check(&draft, &builtin.clone().with(row)) else { continue };
            missing += 1;
            let helps = diagnostics.iter().all(|diagnostic| !diagnostic.help.is_empty() && !has_empty_list(diagnostic));
            assert!(helps, "{diagnostics}");
        }
    }
    assert!(missing > 20, "{missing}");
}

#[test]
fn errors_are_rendered_with_their_line() {
    let source = "buffer B from kplus_array {\n    keep 8 least |f| f.deph;\n    sort: insertoin;\n}";
    let diagnostics = checked(&text(source), &[]).unwrap_err();
    let drawn = render(&diagnostics, &[("case.fragbuf".to_owned(), source.to_owned())]);
    insta::assert_snapshot!("drawn", drawn);
}

#[test]
fn set_from_outside_is_checked_like_the_text() {
    let key = fragbuf::load::Description::Technique("kplus_array".to_owned());
    for (name, value, code) in [
        ("k", "many", "invalid-option"),
        ("sort", "x", "unknown-value"),
        ("sync.limit", "0", "invalid-option"),
        ("nope", "1", "unknown-axis"),
        ("k", "0", "k-out-of-range"),
    ] {
        let diagnostics = checked(&key, &[(name, value)]).err().unwrap_or_else(|| panic!("accepted: {name}={value}"));
        assert_eq!(
            diagnostics.iter().map(|diagnostic| diagnostic.code.name).collect::<Vec<_>>(),
            [code],
            "{name}={value}"
        );
    }
    let variant = checked(&key, &[("k", "3"), ("sync.limit", "9"), ("sort", "insertion")]).unwrap();
    assert_eq!(variant.keep, Some(3));
}
