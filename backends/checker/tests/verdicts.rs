//! What each technique holds, on which target, under which model; and that tiers follow from that.

use fragbuf_backends::tier;
use fragbuf_checker::{Limits, Model};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Fact;

use crate::subjects::{limits, report, target, variant};

/// Technique, changes, target, model, holds.
type Verdict = (&'static str, &'static [(&'static str, &'static str)], &'static str, Model, bool);

const LOCKED: &[(&str, &str)] = &[("sync", "spin_lock"), ("cull", "early")];
const INTERLOCK: &[(&str, &str)] = &[("sync", "interlock")];

const VERDICTS: [Verdict; 34] = [
    ("kb", &[], "wgsl", Model::Sequential, false),
    ("kb", &[], "spirv", Model::Late, false),
    ("kb", LOCKED, "wgsl", Model::Sequential, true),
    ("kb", LOCKED, "wgsl", Model::Late, false),
    ("kb", LOCKED, "spirv", Model::Late, true),
    ("kplus_array", &[], "wgsl", Model::Sequential, true),
    ("kplus_array", &[], "wgsl", Model::Late, false),
    ("kplus_array", &[], "msl", Model::Late, false),
    ("kplus_array", &[], "spirv", Model::Sequential, true),
    ("kplus_array", &[], "spirv", Model::Late, true),
    ("kplus_array", INTERLOCK, "spirv", Model::Sequential, true),
    ("kplus_array", INTERLOCK, "spirv", Model::Late, true),
    ("kb_ps", &[], "wgsl", Model::Sequential, true),
    ("kb_ps", &[], "spirv", Model::Late, true),
    ("kplus_heap", &[], "wgsl", Model::Sequential, true),
    ("kplus_heap", &[], "wgsl", Model::Late, false),
    ("kplus_heap", &[], "spirv", Model::Late, true),
    ("mdt32_coplanar", &[], "wgsl", Model::Sequential, true),
    ("mdt32_coplanar", &[], "wgsl", Model::Late, true),
    ("ab_array", &[], "wgsl", Model::Sequential, true),
    ("ab_array", &[], "wgsl", Model::Late, true),
    ("kb_ab_ll", &[], "wgsl", Model::Late, true),
    ("kplus_array_revised", &[], "wgsl", Model::Sequential, true),
    ("kplus_array_revised", &[], "wgsl", Model::Late, false),
    ("kplus_array_revised", &[], "spirv", Model::Late, true),
    ("kb_ll", &[], "wgsl", Model::Sequential, true),
    ("kb_ll", &[], "spirv", Model::Late, true),
    ("kplus_ab_sb", &[], "wgsl", Model::Sequential, true),
    ("kplus_ab_sb", &[], "spirv", Model::Late, true),
    ("kb_mdt64", &[], "wgsl-native", Model::Sequential, true),
    ("ab_ll", &[], "wgsl", Model::Sequential, true),
    ("ab_ll", &[], "wgsl", Model::Late, true),
    ("ab_sb", &[], "wgsl", Model::Sequential, true),
    ("ab_sb", &[], "wgsl", Model::Late, true),
];

#[test]
fn every_technique_gets_its_verdict_with_three_fragments() {
    let registry = Registry::builtin();
    for (key, set, target, model, holds) in VERDICTS {
        let report = report(key, set, target, &limits(3, model), &registry).unwrap();
        println!("{key} {set:?} {target} {model:?}: {} cases, {} states", report.cases, report.states);
        assert!(report.is_whole, "{key} {set:?} {target} {model:?} has states beyond the limit");
        assert_eq!(report.failure.is_none(), holds, "{key} {set:?} {target} {model:?}: {:#?}", report.failure);
        assert!(report.cases >= 10 || !holds, "{key} is hardly tried");
    }
}

#[test]
fn losses_by_design_are_said_to_be_stated_and_others_are_not() {
    let registry = Registry::builtin();
    let racy = report("kb", &[], "wgsl", &limits(2, Model::Sequential), &registry).unwrap();
    assert!(racy.is_stated && !racy.hazards.is_empty());
    let relaxed = report("kplus_array", &[], "wgsl", &limits(2, Model::Late), &registry).unwrap();
    assert!(!relaxed.is_stated);
}

/// What the checker has no word for: another promise than the k best, and words of 64 bits under late memory.
const BEYOND: [&str; 2] = ["depth_partition", "kb_mdt64"];

/// What the tier means, worked out: T5 fails even when memory behaves; T4 fails when stores are late; T3 holds, but not
/// without its fences; T2 has no fences and an interlock; T1 holds with neither.
#[test]
fn tiers_follow_from_the_model() {
    let registry = Registry::builtin();
    let holds = |key: &str, set: &[(&str, &str)], target: &str, model: Model| {
        let report = report(key, set, target, &limits(2, model), &registry).unwrap();
        // What a sound row loses by design, and says so, is no matter of its tier.
        report.failure.is_none() || (report.is_stated && key != "kb")
    };
    let mut cases: Vec<(&str, &[(&str, &str)])> = vec![("kb", LOCKED)];
    let known = registry.techniques().iter().filter(|technique| !BEYOND.contains(&technique.key.as_str()));
    cases.extend(known.map(|technique| (technique.key.as_str(), &[][..])));
    for (key, set) in cases {
        let soundness = variant(key, set, &registry).unwrap();
        // Metal has neither fences nor coherent words: what is late there is late without any help.
        let bare = holds(key, set, "msl", Model::Late);
        for name in ["wgsl", "wgsl-native", "glsl", "spirv", "hlsl", "msl"] {
            let offers = [target(name).offers, &[Fact::OwnEntryPoints]].concat();
            let selection = soundness.select(&offers).unwrap();
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
    offers.push(Fact::OwnEntryPoints);
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
