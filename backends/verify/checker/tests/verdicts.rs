//! What each technique holds, on which target, under which model; and that tiers follow from that.

use fragbuf_targets::tier;
use fragbuf_checker::{Error, Limits, Model, Report};
use fragbuf_model::Selection;
use fragbuf_templates::Registry;
use fragbuf_templates::Shorthand;
use fragbuf_templates::vocabulary::{Capability, Fact};

use crate::subjects::{limits, report, target, variant};

/// Technique, changes, target, model, what is found.
type Verdict = (&'static str, &'static [(&'static str, &'static str)], &'static str, Model, Found);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Found {
    Holds,
    /// Loses what its rows state, and nothing else.
    AsStated,
    Fails,
}

use Found::{AsStated, Fails, Holds};

fn found(report: &Report) -> Found {
    match &report.failure {
        None => Holds,
        Some(_) if report.is_stated => AsStated,
        Some(_) => Fails,
    }
}

const LOCKED: &[(&str, &str)] = &[("sync", "spin_lock"), ("cull", "early")];
const LOCK: &[(&str, &str)] = &[("sync", "spin_lock")];
const PAGES_OF_ONE: &[(&str, &str)] = &[("storage.page", "1")];
const PAGES_OF_TWO: &[(&str, &str)] = &[("storage.page", "2")];
/// Racing writers that try again have too many orders.
const TWO_LOOKS: &[(&str, &str)] = &[("storage.retries", "1"), ("k", "2")];
const ONE_LOOK: &[(&str, &str)] = &[("storage.retries", "0"), ("k", "2")];
const SUBMITTED: &[(&str, &str)] = &[("sync", "interlock_ordered"), ("ties", "submission")];
const INTERLOCK: &[(&str, &str)] = &[("sync", "interlock")];

const TAIL: &[(&str, &str)] = &[("overflow", "tail_blend"), ("sync", "spin_lock"), ("cull", "none")];
const LAST: &[(&str, &str)] = &[("overflow", "merge_last"), ("sync", "spin_lock"), ("cull", "none")];
const CLOSEST: &[(&str, &str)] = &[("overflow", "merge_closest"), ("sync", "spin_lock"), ("cull", "none")];
/// A word beside the colour, and the colour in four.
const LAST_OF_FLOATS: &[(&str, &str)] =
    &[("overflow", "merge_last"), ("cull", "none"), ("fragment.color", "vec4"), ("ties", "unordered")];

const VERDICTS: [Verdict; 84] = [
    ("kb", &[], "wgsl", Model::Sequential, AsStated),
    ("kb", &[], "spirv", Model::Late, AsStated),
    ("kb", LOCKED, "wgsl", Model::Sequential, Holds),
    ("kb", LOCKED, "wgsl", Model::Late, Fails),
    ("kb", LOCKED, "spirv", Model::Late, Holds),
    ("kplus_array", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_array", &[], "wgsl", Model::Late, Fails),
    ("kplus_array", &[], "msl", Model::Late, Fails),
    ("kplus_array", &[], "spirv", Model::Sequential, Holds),
    ("kplus_array", &[], "spirv", Model::Late, Holds),
    ("kplus_array", INTERLOCK, "spirv", Model::Sequential, Holds),
    ("kplus_array", INTERLOCK, "spirv", Model::Late, Holds),
    ("kb_ps", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ps", &[], "spirv", Model::Late, Holds),
    ("kplus_heap", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_heap", &[], "wgsl", Model::Late, Fails),
    ("kplus_heap", &[], "spirv", Model::Late, Holds),
    ("mdt32_coplanar", &[], "wgsl", Model::Sequential, Holds),
    ("mdt32_coplanar", &[], "wgsl", Model::Late, Holds),
    ("ab_array", &[], "wgsl", Model::Sequential, Holds),
    ("ab_array", &[], "wgsl", Model::Late, Holds),
    ("kb_ab_ll", &[], "wgsl", Model::Late, Holds),
    ("kplus_array_revised", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_array_revised", &[], "wgsl", Model::Late, Fails),
    ("kplus_array_revised", &[], "spirv", Model::Late, Holds),
    ("kb_ll", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ll", &[], "spirv", Model::Late, Holds),
    ("kplus_ab_sb", &[], "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", &[], "spirv", Model::Late, Holds),
    ("kb_mdt64", &[], "wgsl-native", Model::Sequential, Holds),
    ("kb_mdt64", &[], "wgsl-native", Model::Late, Holds),
    ("kb_mdt32", &[], "wgsl", Model::Sequential, AsStated),
    ("kb_mdt32", &[], "wgsl", Model::Late, AsStated),
    ("depth_partition", &[], "wgsl", Model::Sequential, Holds),
    ("depth_partition", &[], "wgsl", Model::Late, Fails),
    ("depth_partition", &[], "spirv", Model::Late, Holds),
    ("ab_ll", &[], "wgsl", Model::Sequential, Holds),
    ("ab_ll", &[], "wgsl", Model::Late, Holds),
    ("ab_sb", &[], "wgsl", Model::Sequential, Holds),
    ("ab_sb", &[], "wgsl", Model::Late, Holds),
    ("ab_ll_paged", &[], "wgsl", Model::Sequential, Holds),
    ("ab_ll_paged", &[], "wgsl", Model::Late, Holds),
    ("ab_ll_paged", PAGES_OF_TWO, "wgsl", Model::Sequential, Holds),
    ("ab_ll_paged", PAGES_OF_TWO, "wgsl", Model::Late, Holds),
    ("ab_ll_paged", PAGES_OF_ONE, "wgsl", Model::Sequential, Holds),
    ("ab_ll_bun", &[], "wgsl", Model::Sequential, Holds),
    ("ab_ll_bun", &[], "wgsl", Model::Late, Holds),
    ("kb_stream", LOCK, "wgsl", Model::Sequential, Holds),
    ("kb_stream", LOCK, "wgsl", Model::Late, Fails),
    ("kb_stream", LOCK, "spirv", Model::Late, Holds),
    ("kb_stream", &[], "spirv", Model::Sequential, Holds),
    ("kb_stream", &[], "spirv", Model::Late, Holds),
    ("kb_mha", TWO_LOOKS, "wgsl", Model::Sequential, AsStated),
    ("kb_mha", ONE_LOOK, "wgsl", Model::Sequential, AsStated),
    ("kb_mha", ONE_LOOK, "spirv", Model::Late, AsStated),
    ("kb_mha", LOCK, "wgsl", Model::Sequential, AsStated),
    ("kb_mha", LOCK, "wgsl", Model::Late, Fails),
    ("kb_mha", LOCK, "spirv", Model::Late, AsStated),
    ("kb_multi", &[], "wgsl", Model::Sequential, AsStated),
    ("kb_multi", &[], "wgsl", Model::Late, AsStated),
    ("kb_ps", SUBMITTED, "spirv", Model::Sequential, Holds),
    ("kb_ps", SUBMITTED, "spirv", Model::Late, Holds),
    ("kb_ab_array", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ab_array", &[], "wgsl", Model::Late, Holds),
    ("kb_ab_ll", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ab_sb", &[], "wgsl", Model::Sequential, Holds),
    ("kb_ab_sb", &[], "wgsl", Model::Late, Holds),
    ("kb_ps", TAIL, "wgsl", Model::Sequential, Holds),
    ("kb_ps", TAIL, "spirv", Model::Late, Holds),
    ("kplus_array", TAIL, "wgsl", Model::Sequential, Holds),
    ("kplus_array", TAIL, "wgsl", Model::Late, Fails),
    ("kplus_array_revised", TAIL, "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", TAIL, "wgsl", Model::Sequential, Holds),
    ("kb_ps", LAST, "wgsl", Model::Sequential, Holds),
    ("kb_ps", LAST, "spirv", Model::Late, Holds),
    ("kplus_array", LAST, "wgsl", Model::Sequential, Holds),
    ("kplus_array", LAST, "wgsl", Model::Late, Fails),
    ("kplus_array", LAST, "spirv", Model::Late, Holds),
    ("kplus_array", LAST_OF_FLOATS, "wgsl", Model::Sequential, Holds),
    ("kplus_heap", LAST, "wgsl", Model::Sequential, Holds),
    ("kplus_array_revised", LAST, "wgsl", Model::Sequential, Holds),
    ("kplus_ab_sb", LAST, "wgsl", Model::Sequential, Holds),
    ("kb_ps", CLOSEST, "wgsl", Model::Sequential, Holds),
    ("kb_ps", CLOSEST, "spirv", Model::Late, Holds),
];

#[test]
fn every_technique_gets_its_verdict_with_three_fragments() {
    let registry = Registry::builtin();
    for (key, set, target, model, wanted) in VERDICTS {
        let report = report(key, set, target, &limits(3, model), &registry).unwrap();
        println!("{key} {set:?} {target} {model:?}: {} cases, {} states", report.cases, report.states);
        assert!(report.is_whole, "{key} {set:?} {target} {model:?} has states beyond the limit");
        assert_eq!(found(&report), wanted, "{key} {set:?} {target} {model:?}: {:#?}", report.failure);
        assert!(report.is_judged && (report.cases >= 10 || wanted == Fails), "{key} is hardly tried");
    }
}

fn is_left_to_tests(key: &str, registry: &Registry) -> bool {
    Selection::first(&variant(key, &[], registry).unwrap()).offers().contains(&Fact::FixedFunction)
}

/// Techniques whose fragments are kept apart by what shaders do.
fn interleaved(registry: &Registry) -> impl Iterator<Item = &str> {
    let keys = registry.techniques().iter().map(|technique| technique.key.as_str());
    keys.filter(|key| !is_left_to_tests(key, registry))
}

#[test]
fn every_technique_has_a_verdict_or_nothing_to_try() {
    let registry = Registry::builtin();
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let is_tried = VERDICTS.iter().any(|(tried, ..)| *tried == key);
        let target = if is_left_to_tests(key, &registry) { "wgsl" } else { continue };
        let nothing = report(key, &[], target, &limits(2, Model::Sequential), &registry);
        assert!(!is_tried && matches!(nothing, Err(Error::NothingToTry(_))), "{key}: {nothing:?}");
    }
    for key in interleaved(&registry) {
        assert!(VERDICTS.iter().any(|(tried, ..)| *tried == key), "{key} is not tried");
    }
}

/// With `ties: submission` the first of equal ones stays: an interlock that lets fragments in by any order breaks that.
#[test]
fn submission_decides_ties_only_where_it_decides_who_enters() {
    let mut registry = Registry::builtin();
    let mut row = registry.row("sync", "interlock_ordered").unwrap().clone();
    row.needs.retain(|capability| *capability != Capability::OrderedInterlock);
    registry = registry.with(row);
    let checked = |registry: &Registry, ties: &str| {
        let set = [("sync", "interlock_ordered"), ("ties", ties)];
        found(&report("kb_ps", &set, "spirv", &limits(2, Model::Sequential), registry).unwrap())
    };
    assert_eq!(checked(&Registry::builtin(), "submission"), Holds);
    assert_eq!(checked(&registry, "submission"), Fails);
    assert_eq!(checked(&registry, "payload"), Holds);
}

/// A mask of samples is a word like any other: it is neither lost nor mixed up with another fragment's.
#[test]
fn masks_of_samples_stay_with_their_fragments() {
    let registry = Registry::builtin();
    for (key, target) in [("kplus_array", "spirv"), ("mdt32_coplanar", "wgsl"), ("ab_ll", "wgsl"), ("kb_ll", "spirv")] {
        let report = report(key, &[("samples", "coverage")], target, &limits(2, Model::Late), &registry).unwrap();
        assert_eq!(found(&report), Holds, "{key}: {:#?}", report.failure);
    }
    let racy = report("kb", &[("samples", "coverage")], "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
    assert!(found(&racy) == AsStated && !racy.hazards.is_empty());
}

#[test]
fn losses_by_design_are_said_to_be_stated_and_others_are_not() {
    let registry = Registry::builtin();
    let racy = report("kb", &[], "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
    assert!(racy.is_stated && !racy.hazards.is_empty());
    let relaxed = report("kplus_array", &[], "wgsl", &limits(2, Model::Late), &registry).unwrap();
    assert!(!relaxed.is_stated);
}

/// What the tier means, worked out: T5 fails even when memory behaves; T4 fails when stores are late; T3 holds, but not
/// without its fences; T2 has no fences and an interlock; T1 holds with neither.
#[test]
fn tiers_follow_from_the_model() {
    let registry = Registry::builtin();
    let holds = |key: &str, set: &[(&str, &str)], target: &str, model: Model| {
        let report = report(key, set, target, &limits(2, model), &registry).unwrap();
        // What a row loses by design, and says so, is no matter of its tier; what it loses uncounted by a race is.
        let loses = |name: &str| matches!(Shorthand::of(name), Some(Shorthand::Permits(permits)) if permits.lost);
        let races = report.hazards.iter().any(|(name, _)| loses(name));
        report.failure.is_none() || (report.is_stated && !races)
    };
    let mut cases: Vec<(&str, &[(&str, &str)])> = vec![("kb", LOCKED)];
    let set = |key: &str| if key == "kb_mha" { ONE_LOOK } else { &[] };
    cases.extend(interleaved(&registry).map(|key| (key, set(key))));
    for (key, set) in cases {
        let soundness = variant(key, set, &registry).unwrap();
        let select = |name: &str| soundness.select(&[target(name).offers, &[Capability::OwnEntryPoints]].concat()).ok();
        // Metal has neither fences nor coherent words, native WGSL no fences: what is late there is late without help.
        let helpless = ["msl", "wgsl-native"].into_iter().find(|name| select(name).is_some()).unwrap();
        let bare = holds(key, set, helpless, Model::Late);
        for name in ["wgsl", "wgsl-native", "glsl", "spirv", "hlsl", "msl"] {
            let Some(selection) = select(name) else { continue };
            // An interlock is what holds where memory is late, as fences are.
            let stated = match tier(selection.soundness(), target(name)) {
                "T2" => "T3",
                stated => stated,
            };
            let computed = match (holds(key, set, name, Model::Sequential), holds(key, set, name, Model::Late), bare) {
                (false, _, _) => "T5",
                (true, false, _) => "T4",
                (true, true, false) => "T3",
                (true, true, true) => "T1",
            };
            assert_eq!(stated, computed, "{key} {set:?} on {name}");
        }
    }
    let interlock = variant("kplus_array", INTERLOCK, &registry).unwrap();
    let mut offers = target("spirv").offers.to_vec();
    offers.push(Capability::OwnEntryPoints);
    let selection = interlock.select(&offers).unwrap();
    assert_eq!(tier(selection.soundness(), target("spirv")), "T2");
    assert!(holds("kplus_array", INTERLOCK, "spirv", Model::Late));
}

#[test]
fn schedules_by_chance_find_what_is_wrong_and_nothing_else() {
    let registry = Registry::builtin();
    let by_chance = |model| Limits { fragments: vec![4], seeds: Some(40), model, ..Limits::default() };
    for (key, target, model, holds) in [
        ("kb", "wgsl", Model::Sequential, false),
        ("kplus_array", "wgsl", Model::Sequential, true),
        ("kplus_array", "wgsl", Model::Late, false),
        ("kplus_array", "spirv", Model::Late, true),
        ("ab_ll", "wgsl", Model::Late, true),
    ] {
        let report = report(key, &[], target, &by_chance(model), &registry).unwrap();
        assert_eq!(report.failure.is_none(), holds, "{key} {target} {model:?}: {:#?}", report.failure);
    }
}
