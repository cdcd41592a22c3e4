//! The verdict on each technique, per target and memory model; and that tiers follow from the verdicts.

use fragbuf_checker::{Error, Limits, Model, Report};
use fragbuf_model::Selection;
use fragbuf_targets::tier;
use fragbuf_templates::Registry;
use fragbuf_templates::Shorthand;
use fragbuf_templates::vocabulary::{Capability, Feature};

use crate::subjects::{limits, report, target, variant};

/// Technique, changes, target, model, outcome.
pub(crate) type Verdict = (&'static str, &'static [(&'static str, &'static str)], &'static str, Model, Outcome);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Holds,
    /// Fails with declared hazards only.
    Hazard,
    Fails,
}

use Outcome::{Fails, Hazard, Holds};

pub(crate) fn outcome(report: &Report) -> Outcome {
    match &report.failure {
        None => Holds,
        Some(_) if report.is_declared => Hazard,
        Some(_) => Fails,
    }
}

const BY_IMPORTANCE: &[(&str, &str)] = &[("allocation", "by_importance")];
const PREDICTED: &[(&str, &str)] = &[("allocation", "predicted")];
const PEELED: &[(&str, &str)] = &[("peeling", "k_layers")];
const LAYERS: &[(&str, &str)] = &[("peeling", "depth_layers")];
const SIDES: &[(&str, &str)] = &[("peeling", "both_sides")];
const FRONT_TO_BACK: &[(&str, &str)] = &[("peeling", "front_to_back"), ("storage", "single"), ("k", "1")];
const TEMPORAL: &[(&str, &str)] = &[("cull", "temporal")];
const LOCKED: &[(&str, &str)] = &[("sync", "spin_lock"), ("cull", "early")];
const LOCK: &[(&str, &str)] = &[("sync", "spin_lock")];
const PAGES_OF_ONE: &[(&str, &str)] = &[("storage.page", "1")];
const PAGES_OF_TWO: &[(&str, &str)] = &[("storage.page", "2")];
/// With more retries, racing writers have too many interleavings.
const TWO_LOOKS: &[(&str, &str)] = &[("storage.retries", "1"), ("k", "2")];
const ONE_LOOK: &[(&str, &str)] = &[("storage.retries", "0"), ("k", "2")];
const SUBMITTED: &[(&str, &str)] = &[("sync", "interlock_ordered"), ("ties", "submission")];
const INTERLOCK: &[(&str, &str)] = &[("sync", "interlock")];

const TAIL: &[(&str, &str)] = &[("overflow", "tail_blend"), ("sync", "spin_lock"), ("cull", "none")];
const LAST: &[(&str, &str)] = &[("overflow", "merge_last"), ("sync", "spin_lock"), ("cull", "none")];
const CLOSEST: &[(&str, &str)] = &[("overflow", "merge_closest"), ("sync", "spin_lock"), ("cull", "none")];
/// A further value word, and a colour of four words.
const LAST_OF_FLOATS: &[(&str, &str)] =
    &[("overflow", "merge_last"), ("cull", "none"), ("fragment.color", "vec4"), ("ties", "unordered")];

const UNPEELED: &[(&str, &str)] = &[("objects", "unpeeled")];

pub(crate) const VERDICTS: [Verdict; 130] = [
    ("kb", &[], "wgsl", Model::Sequential, Hazard),
    ("kb", &[], "spirv", Model::Relaxed, Hazard),
    ("kb", LOCKED, "wgsl", Model::Sequential, Holds),
    ("kb", LOCKED, "wgsl", Model::Relaxed, Fails),
    ("kb", LOCKED, "spirv", Model::Relaxed, Holds),
    ("kplus_array", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_array", &[], "wgsl", Model::Relaxed, Fails),
    ("kplus_array", &[], "msl", Model::Relaxed, Fails),
    ("kplus_array", &[], "spirv", Model::Sequential, Holds),
    ("kplus_array", &[], "spirv", Model::Relaxed, Holds),
    ("kplus_array", INTERLOCK, "spirv", Model::Sequential, Holds),
    ("kplus_array", INTERLOCK, "spirv", Model::Relaxed, Holds),
    ("kb_ps", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ps", &[], "spirv", Model::Relaxed, Holds),
    ("kplus_heap", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_heap", &[], "wgsl", Model::Relaxed, Fails),
    ("kplus_heap", &[], "spirv", Model::Relaxed, Holds),
    ("mdt32_coplanar", &[], "wgsl", Model::Sequential, Holds),
    ("mdt32_coplanar", &[], "wgsl", Model::Relaxed, Holds),
    ("ab_array", &[], "wgsl", Model::Sequential, Holds),
    ("ab_array", &[], "wgsl", Model::Relaxed, Holds),
    ("kb_ab_ll", &[], "wgsl", Model::Relaxed, Holds),
    ("kplus_array_revised", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_array_revised", &[], "wgsl", Model::Relaxed, Fails),
    ("kplus_array_revised", &[], "spirv", Model::Relaxed, Holds),
    ("kb_ll", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ll", &[], "spirv", Model::Relaxed, Holds),
    ("kplus_ab_sb", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", &[], "spirv", Model::Relaxed, Holds),
    ("unified", &[], "wgsl", Model::Sequential, Holds),
    ("unified", &[], "spirv", Model::Relaxed, Holds),
    ("kplus_ab_sb", BY_IMPORTANCE, "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", BY_IMPORTANCE, "spirv", Model::Relaxed, Holds),
    ("k_peeling", &[], "wgsl", Model::Sequential, Holds),
    ("k_peeling", &[], "wgsl", Model::Relaxed, Fails),
    ("k_peeling", &[], "spirv", Model::Relaxed, Holds),
    ("mdt32_coplanar", PEELED, "wgsl", Model::Relaxed, Holds),
    ("kb_ll", PEELED, "spirv", Model::Relaxed, Holds),
    ("kplus_ab_sb", PEELED, "wgsl", Model::Sequential, Holds),
    ("f2b_ll", &[], "wgsl", Model::Sequential, Holds),
    ("f2b_ll", &[], "wgsl", Model::Relaxed, Holds),
    ("f2b_fab", &[], "wgsl", Model::Sequential, Holds),
    ("f2b_fab", &[], "wgsl", Model::Relaxed, Holds),
    ("f2b_kb", &[], "wgsl", Model::Sequential, Holds),
    ("f2b_kb", &[], "wgsl", Model::Relaxed, Holds),
    ("dual_ll", &[], "wgsl", Model::Sequential, Holds),
    ("dual_ll", &[], "wgsl", Model::Relaxed, Holds),
    ("dual_fab", &[], "wgsl", Model::Sequential, Holds),
    ("dual_fab", &[], "wgsl", Model::Relaxed, Holds),
    ("dual_kb", &[], "wgsl", Model::Sequential, Holds),
    ("dual_kb", &[], "wgsl", Model::Relaxed, Holds),
    ("f2b_2p", &[], "wgsl", Model::Sequential, Hazard),
    ("f2b_2p", &[], "wgsl", Model::Relaxed, Hazard),
    ("f2b_1p", &[], "wgsl", Model::Sequential, Hazard),
    ("f2b_1p", &[], "wgsl", Model::Relaxed, Hazard),
    ("f2b_3p", &[], "glsl", Model::Sequential, Hazard),
    ("f2b_3p", &[], "spirv", Model::Relaxed, Hazard),
    ("f2b_ll", UNPEELED, "wgsl", Model::Sequential, Holds),
    ("k_peeling", UNPEELED, "spirv", Model::Relaxed, Holds),
    ("dual", &[], "wgsl", Model::Sequential, Hazard),
    ("dual", &[], "wgsl", Model::Relaxed, Hazard),
    ("dual_2p", &[], "wgsl", Model::Sequential, Hazard),
    ("dual_2p", &[], "wgsl", Model::Relaxed, Hazard),
    ("bun", &[], "wgsl", Model::Sequential, Hazard),
    ("bun", &[], "wgsl", Model::Relaxed, Hazard),
    ("bad", &[], "wgsl", Model::Sequential, Holds),
    ("bad", &[], "wgsl", Model::Relaxed, Holds),
    ("ab_sb", LAYERS, "wgsl", Model::Relaxed, Holds),
    ("ab_ll_bun", SIDES, "wgsl", Model::Sequential, Holds),
    ("kplus_array", FRONT_TO_BACK, "wgsl", Model::Sequential, Hazard),
    ("kplus_array", FRONT_TO_BACK, "spirv", Model::Relaxed, Hazard),
    ("kplus_array", PREDICTED, "wgsl", Model::Sequential, Holds),
    ("mdt32_coplanar", PREDICTED, "wgsl", Model::Relaxed, Holds),
    ("kplus_array", TEMPORAL, "wgsl", Model::Sequential, Holds),
    ("kplus_array", TEMPORAL, "spirv", Model::Relaxed, Holds),
    ("kb_mdt64", &[], "wgsl-native", Model::Sequential, Holds),
    ("kb_mdt64", &[], "wgsl-native", Model::Relaxed, Holds),
    ("kb_mdt32", &[], "wgsl", Model::Sequential, Hazard),
    ("kb_mdt32", &[], "wgsl", Model::Relaxed, Hazard),
    ("depth_partition", &[], "wgsl", Model::Sequential, Holds),
    ("depth_partition", &[], "wgsl", Model::Relaxed, Fails),
    ("depth_partition", &[], "spirv", Model::Relaxed, Holds),
    ("ab_ll", &[], "wgsl", Model::Sequential, Holds),
    ("ab_ll", &[], "wgsl", Model::Relaxed, Holds),
    ("ab_sb", &[], "wgsl", Model::Sequential, Holds),
    ("ab_sb", &[], "wgsl", Model::Relaxed, Holds),
    ("ab_ll_paged", &[], "wgsl", Model::Sequential, Holds),
    ("ab_ll_paged", &[], "wgsl", Model::Relaxed, Holds),
    ("ab_ll_paged", PAGES_OF_TWO, "wgsl", Model::Sequential, Holds),
    ("ab_ll_paged", PAGES_OF_TWO, "wgsl", Model::Relaxed, Holds),
    ("ab_ll_paged", PAGES_OF_ONE, "wgsl", Model::Sequential, Holds),
    ("ab_ll_bun", &[], "wgsl", Model::Sequential, Holds),
    ("ab_ll_bun", &[], "wgsl", Model::Relaxed, Holds),
    ("kb_stream", LOCK, "wgsl", Model::Sequential, Holds),
    ("kb_stream", LOCK, "wgsl", Model::Relaxed, Fails),
    ("kb_stream", LOCK, "spirv", Model::Relaxed, Holds),
    ("kb_stream", &[], "spirv", Model::Sequential, Holds),
    ("kb_stream", &[], "spirv", Model::Relaxed, Holds),
    ("kb_mha", TWO_LOOKS, "wgsl", Model::Sequential, Hazard),
    ("kb_mha", ONE_LOOK, "wgsl", Model::Sequential, Hazard),
    ("kb_mha", ONE_LOOK, "spirv", Model::Relaxed, Hazard),
    ("kb_mha", LOCK, "wgsl", Model::Sequential, Hazard),
    ("kb_mha", LOCK, "wgsl", Model::Relaxed, Fails),
    ("kb_mha", LOCK, "spirv", Model::Relaxed, Hazard),
    ("kb_multi", &[], "wgsl", Model::Sequential, Hazard),
    ("kb_multi", &[], "wgsl", Model::Relaxed, Hazard),
    ("kb_ps", SUBMITTED, "spirv", Model::Sequential, Holds),
    ("kb_ps", SUBMITTED, "spirv", Model::Relaxed, Holds),
    ("kb_ab_array", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ab_array", &[], "wgsl", Model::Relaxed, Holds),
    ("kb_ab_ll", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ab_sb", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ab_sb", &[], "wgsl", Model::Relaxed, Holds),
    ("kb_ps", TAIL, "wgsl", Model::Sequential, Holds),
    ("kb_ps", TAIL, "spirv", Model::Relaxed, Holds),
    ("kplus_array", TAIL, "wgsl", Model::Sequential, Holds),
    ("kplus_array", TAIL, "wgsl", Model::Relaxed, Fails),
    ("kplus_array_revised", TAIL, "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", TAIL, "wgsl", Model::Sequential, Holds),
    ("kb_ps", LAST, "wgsl", Model::Sequential, Holds),
    ("kb_ps", LAST, "spirv", Model::Relaxed, Holds),
    ("kplus_array", LAST, "wgsl", Model::Sequential, Holds),
    ("kplus_array", LAST, "wgsl", Model::Relaxed, Fails),
    ("kplus_array", LAST, "spirv", Model::Relaxed, Holds),
    ("kplus_array", LAST_OF_FLOATS, "wgsl", Model::Sequential, Holds),
    ("kplus_heap", LAST, "wgsl", Model::Sequential, Holds),
    ("kplus_array_revised", LAST, "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", LAST, "wgsl", Model::Sequential, Holds),
    ("kb_ps", CLOSEST, "wgsl", Model::Sequential, Holds),
    ("kb_ps", CLOSEST, "spirv", Model::Relaxed, Holds),
];

#[test]
fn every_technique_gets_its_verdict_with_three_fragments() {
    let registry = Registry::builtin();
    for (key, set, target, model, expected) in VERDICTS {
        let report = report(key, set, target, &limits(3, model), &registry).unwrap();
        println!("{key} {set:?} {target} {model:?}: {} cases, {} states", report.cases, report.states);
        assert!(report.is_exhaustive, "{key} {set:?} {target} {model:?} has states beyond the limit");
        assert_eq!(outcome(&report), expected, "{key} {set:?} {target} {model:?}: {:#?}", report.failure);
        assert!(report.is_kept_set_checked && (report.cases >= 10 || expected == Fails), "{key} has too few cases");
    }
}

fn is_fixed_function(key: &str, registry: &Registry) -> bool {
    Selection::first(&variant(key, &[], registry).unwrap()).provides().contains(&Capability::FixedFunction)
}

/// Techniques whose shaders synchronise the fragments.
fn interleaved(registry: &Registry) -> impl Iterator<Item = &str> {
    let keys = registry.techniques().iter().map(|technique| technique.key.as_str());
    keys.filter(|key| !is_fixed_function(key, registry))
}

#[test]
fn every_technique_has_a_verdict_or_is_not_applicable() {
    let registry = Registry::builtin();
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let has_verdict = VERDICTS.iter().any(|(known, ..)| *known == key);
        let target = if is_fixed_function(key, &registry) { "wgsl" } else { continue };
        let nothing = report(key, &[], target, &limits(2, Model::Sequential), &registry);
        assert!(!has_verdict && matches!(nothing, Err(Error::NotApplicable(_))), "{key}: {nothing:?}");
    }
    for key in interleaved(&registry) {
        assert!(VERDICTS.iter().any(|(known, ..)| *known == key), "{key} has no verdict");
    }
}

/// `ties: submission` keeps the first of equal fragments. An interlock without submission order breaks that.
#[test]
fn ties_by_submission_need_an_ordered_interlock() {
    let mut registry = Registry::builtin();
    let mut row = registry.row("sync", "interlock_ordered").unwrap().clone();
    row.needs.retain(|feature| *feature != Feature::OrderedInterlock);
    registry = registry.with(row);
    let checked = |registry: &Registry, ties: &str| {
        let set = [("sync", "interlock_ordered"), ("ties", ties)];
        outcome(&report("kb_ps", &set, "spirv", &limits(2, Model::Sequential), registry).unwrap())
    };
    assert_eq!(checked(&Registry::builtin(), "submission"), Holds);
    assert_eq!(checked(&registry, "submission"), Fails);
    assert_eq!(checked(&registry, "payload"), Holds);
}

/// A sample mask is a value word: it is neither lost nor mixed up with another fragment's.
#[test]
fn sample_masks_stay_with_their_fragments() {
    let registry = Registry::builtin();
    for (key, target) in [("kplus_array", "spirv"), ("mdt32_coplanar", "wgsl"), ("ab_ll", "wgsl"), ("kb_ll", "spirv")] {
        let report = report(key, &[("samples", "coverage")], target, &limits(2, Model::Relaxed), &registry).unwrap();
        assert_eq!(outcome(&report), Holds, "{key}: {:#?}", report.failure);
    }
    let racy = report("kb", &[("samples", "coverage")], "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
    assert!(outcome(&racy) == Hazard && !racy.hazards.is_empty());
}

#[test]
fn only_losses_by_design_are_declared_hazards() {
    let registry = Registry::builtin();
    let racy = report("kb", &[], "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
    assert!(racy.is_declared && !racy.hazards.is_empty());
    let relaxed = report("kplus_array", &[], "wgsl", &limits(2, Model::Relaxed), &registry).unwrap();
    assert!(!relaxed.is_declared);
}

/// Computes each tier from verdicts. T5 fails under sequential consistency, T4 under the relaxed model. T3 passes there, but
/// not without its fences; T2 has no fences and an interlock; T1 passes with neither.
#[test]
fn tiers_follow_from_the_model() {
    let registry = Registry::builtin();
    let holds = |key: &str, set: &[(&str, &str)], target: &str, model: Model| {
        let report = report(key, set, target, &limits(2, model), &registry).unwrap();
        // A declared loss does not change the tier, unless a race loses fragments uncounted.
        let loses = |name: &str| matches!(Shorthand::of(name), Some(Shorthand::Permits(permits)) if permits.lost);
        let races = report.hazards.iter().any(|(name, _)| loses(name));
        report.failure.is_none() || (report.is_declared && !races)
    };
    let mut cases: Vec<(&str, &[(&str, &str)])> = vec![("kb", LOCKED)];
    let set = |key: &str| if key == "kb_mha" { ONE_LOOK } else { &[] };
    cases.extend(interleaved(&registry).map(|key| (key, set(key))));
    for (key, set) in cases {
        let soundness = variant(key, set, &registry).unwrap();
        let select = |name: &str| soundness.select(&[target(name).provides, &[Feature::OwnEntryPoints]].concat()).ok();
        // Metal has neither fences nor coherent words, and native WGSL has no fences, so nothing orders relaxed memory there.
        let unfenced = ["msl", "wgsl-native"].into_iter().find(|name| select(name).is_some()).unwrap();
        let bare = holds(key, set, unfenced, Model::Relaxed);
        for name in ["wgsl", "wgsl-native", "glsl", "spirv", "hlsl", "msl"] {
            let Some(selection) = select(name) else { continue };
            // Under the relaxed model an interlock has the effect of fences.
            let declared = match tier(selection.soundness(), target(name)) {
                "T2" => "T3",
                declared => declared,
            };
            let computed = match (holds(key, set, name, Model::Sequential), holds(key, set, name, Model::Relaxed), bare)
            {
                (false, _, _) => "T5",
                (true, false, _) => "T4",
                (true, true, false) => "T3",
                (true, true, true) => "T1",
            };
            assert_eq!(declared, computed, "{key} {set:?} on {name}");
        }
    }
    let interlock = variant("kplus_array", INTERLOCK, &registry).unwrap();
    let mut provides = target("spirv").provides.to_vec();
    provides.push(Feature::OwnEntryPoints);
    let selection = interlock.select(&provides).unwrap();
    assert_eq!(tier(selection.soundness(), target("spirv")), "T2");
    assert!(holds("kplus_array", INTERLOCK, "spirv", Model::Relaxed));
}

#[test]
fn random_schedules_fail_only_where_exploration_fails() {
    let registry = Registry::builtin();
    let random = |model| Limits { fragments: vec![4], random_schedules: Some(40), model, ..Limits::default() };
    for (key, target, model, holds) in [
        ("kb", "wgsl", Model::Sequential, false),
        ("kplus_array", "wgsl", Model::Sequential, true),
        ("kplus_array", "wgsl", Model::Relaxed, false),
        ("kplus_array", "spirv", Model::Relaxed, true),
        ("ab_ll", "wgsl", Model::Relaxed, true),
    ] {
        let report = report(key, &[], target, &random(model), &registry).unwrap();
        assert_eq!(report.failure.is_none(), holds, "{key} {target} {model:?}: {:#?}", report.failure);
    }
}
