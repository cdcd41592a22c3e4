//! Plans rows without templates. They test whether the vocabulary can express techniques that have no templates, and plans built-in rows with unusual passes.

mod rows;

use fragbuf_codegen::{Plan, plan};
use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_templates::Registry;

/// Plans a technique of the registry with the rows of this module.
pub fn planned(key: &str) -> Plan {
    let registry = rows::registry();
    let draft = Draft::from_technique(key, &SourceSpan::new(key, 1, 1));
    let variant = check(&draft, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let everything = fragbuf_templates::vocabulary::Feature::ALL;
    let selection = variant.select(everything).unwrap_or_else(|missing| panic!("{missing}"));
    plan(&variant, &selection, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

#[test]
fn stencil_routing_fits() {
    let plan = planned("kb_sr");
    assert_eq!(plan.words_per_pixel, "3k");
    insta::assert_snapshot!("kb_sr", plan);
}

#[test]
fn exact_regions_fit() {
    let plan = planned("ab_sb");
    assert_eq!((plan.words_per_pixel.as_str(), plan.geometry_passes.as_str()), ("2f+2", "2"));
    insta::assert_snapshot!("ab_sb", plan);
}

#[test]
fn dual_peeling_fits() {
    let plan = planned("dual");
    assert_eq!(plan.words_per_pixel, "6");
    insta::assert_snapshot!("dual", plan);
}

#[test]
fn array_or_heap_per_pixel_fits() {
    let plan = planned("kplus_ab_sb");
    assert_eq!(plan.words_per_pixel, "2f_k+3");
    insta::assert_snapshot!("kplus_ab_sb", plan);
}

#[test]
fn repeated_passes_fit() {
    let plan = planned("kb_multi");
    assert_eq!((plan.words_per_pixel.as_str(), plan.geometry_passes.as_str()), ("2k", "k+1"));
    insta::assert_snapshot!("kb_multi", plan);
}

#[test]
fn front_to_back_peeling_fits() {
    let plan = planned("f2b");
    assert_eq!(plan.words_per_pixel, "3");
    insta::assert_snapshot!("f2b", plan);
}

#[test]
fn a_host_decision_fits() {
    insta::assert_snapshot!("unified", planned("unified"));
}

#[test]
fn an_edit_of_an_unknown_pass_is_rejected() {
    use fragbuf_templates::vocabulary::{Edit, Row};
    let row = Row {
        template: rows::registry().row("cull", "none").and_then(|row| row.template.clone()),
        edits: vec![Edit::SetSkeleton("no_such_pass".to_owned(), "store".to_owned())],
        ..Row::new("cull", "none", "", "")
    };
    let registry = Registry::builtin().with(row);
    let draft = Draft::from_technique("ab_ll", &SourceSpan::new("ab_ll", 1, 1));
    let variant = check(&draft, &registry).unwrap();
    let selection = variant.select(fragbuf_templates::vocabulary::Feature::ALL).unwrap();
    let diagnostics = plan(&variant, &selection, &registry).unwrap_err();
    assert!(diagnostics.to_string().contains("`no_such_pass`"), "{diagnostics}");
}

/// The rules reject it first; the plan rejects a user row without capabilities.
#[test]
fn a_second_depth_test_is_rejected() {
    use fragbuf_templates::vocabulary::{Feature, Row};
    let builtin = Registry::builtin();
    let early = builtin.row("opaque", "early_depth").unwrap().clone();
    for (key, set, pass) in [
        ("z_buffer", ("sort", "none"), "store"),
        ("kb_sr", ("sort", "insertion"), "store"),
        ("kplus_array", ("cull", "occupancy_early"), "store"),
    ] {
        let registry =
            builtin.clone().with(Row { requires: Vec::new(), needs: vec![Feature::EarlyDepth], ..early.clone() });
        let span = SourceSpan::new(key, 1, 1);
        let mut draft = Draft::from_technique(key, &span);
        draft.set("opaque", "early_depth", &span).unwrap();
        draft.set(set.0, set.1, &span).unwrap();
        let variant = check(&draft, &registry).unwrap();
        let selection = variant.select(Feature::ALL).unwrap();
        let diagnostics = plan(&variant, &selection, &registry).unwrap_err().to_string();
        assert!(
            diagnostics.contains(&format!("`{pass}`, which already has a depth or stencil test")),
            "{key}: {diagnostics}"
        );
    }
}
