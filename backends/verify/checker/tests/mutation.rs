//! Mutation test of storages and syncs: the checker must kill every mutant. The operators were fixed before the first run:
//! delete a statement, swap two consecutive ones, split an atomic operation into a read and a write, increment or decrement
//! a number, `<` ↔ `<=`; later, to access a published word like a guarded one. `survivors.rs` lists the mutants that survive, with reasons.

use std::sync::Mutex;

use fragbuf_checker::{Error, Limits, Model};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, KeepDefault, Row, Technique, Template};

use crate::mutants::{Mutant, mutants};
use crate::repeated::{is_repeated, with_iterations};
use crate::subjects::{limits, report};
use crate::survivors::SURVIVORS;
use crate::survivors_of_peeling::{JUDGED_ELSEWHERE, OF_PEELING};
use crate::survivors_of_races::OF_RACES;
use crate::survivors_of_slots::OF_SLOTS;

const BOTH: &str = include_str!("rows/both_neighbours.wgsl");

/// A check of a mutated row: technique, changes, target, model.
pub(crate) type Check = (&'static str, &'static [(&'static str, &'static str)], &'static str, Model);

/// An overflow row that replaces kept fragments, so that it shows when a displaced fragment is passed on.
const MERGED: &[(&str, &str)] = &[("overflow", "merge_last"), ("sync", "spin_lock"), ("cull", "none")];

const KPLUS: &[Check] = &[
    ("kplus_array", &[], "wgsl", Model::Sequential),
    ("kplus_array", &[], "spirv", Model::Relaxed),
    ("kplus_array", &[("sync", "interlock")], "spirv", Model::Relaxed),
    ("kplus_array", MERGED, "wgsl", Model::Sequential),
];
const SORTED: &[Check] = &[
    ("kb", &[("sync", "spin_lock"), ("cull", "early")], "wgsl", Model::Sequential),
    ("kb", &[("sync", "spin_lock"), ("cull", "early")], "spirv", Model::Relaxed),
    ("kb", MERGED, "wgsl", Model::Sequential),
    ("kb", &[("overflow", "merge_closest"), ("sync", "spin_lock")], "wgsl", Model::Sequential),
];
const LIST: &[Check] = &[("ab_ll", &[], "wgsl", Model::Sequential), ("ab_ll", &[], "wgsl", Model::Relaxed)];
const REGIONS: &[Check] = &[("ab_sb", &[], "wgsl", Model::Sequential), ("ab_sb", &[], "wgsl", Model::Relaxed)];

const PAGES: &[Check] = &[
    ("ab_ll_paged", &[("storage.page", "2")], "wgsl", Model::Sequential),
    ("ab_ll_paged", &[("storage.page", "1")], "wgsl", Model::Sequential),
    ("ab_ll_paged", &[], "wgsl", Model::Relaxed),
    // This target has helper invocations.
    ("ab_ll_paged", &[("storage.page", "2")], "spirv", Model::Sequential),
];
const BUCKETS: &[Check] = &[("ab_ll_bun", &[], "wgsl", Model::Sequential), ("ab_ll_bun", &[], "wgsl", Model::Relaxed)];

const HEAP: &[Check] = &[
    ("kplus_heap", &[], "wgsl", Model::Sequential),
    ("kplus_heap", &[], "spirv", Model::Relaxed),
    ("kplus_heap", MERGED, "wgsl", Model::Sequential),
];
const CASCADE: &[Check] = &[
    ("mdt32_coplanar", &[], "wgsl", Model::Sequential),
    ("mdt32_coplanar", &[], "wgsl", Model::Relaxed),
    // More value words, each ordered among equal words before it.
    ("mdt32_coplanar", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];
const ARRAY: &[Check] = &[("ab_array", &[], "wgsl", Model::Sequential), ("ab_array", &[], "wgsl", Model::Relaxed)];

const REVISED: &[Check] = &[
    ("kplus_array_revised", &[], "wgsl", Model::Sequential),
    ("kplus_array_revised", &[("sync", "interlock")], "spirv", Model::Relaxed),
    ("kplus_array_revised", &[], "spirv", Model::Relaxed),
    ("kplus_array_revised", MERGED, "wgsl", Model::Sequential),
];
const ORDERED: &[Check] = &[("kb_ll", &[], "wgsl", Model::Sequential), ("kb_ll", &[], "spirv", Model::Relaxed)];
const BOUNDED: &[Check] = &[
    ("kplus_ab_sb", &[], "wgsl", Model::Sequential),
    // A heap for every k.
    ("kplus_ab_sb", &[("storage.array", "0")], "wgsl", Model::Sequential),
    ("kplus_ab_sb", &[], "spirv", Model::Relaxed),
    ("kplus_ab_sb", MERGED, "wgsl", Model::Sequential),
];
const WIDE: &[Check] =
    &[("kb_mdt64", &[], "wgsl-native", Model::Sequential), ("kb_mdt64", &[], "wgsl-native", Model::Relaxed)];
const DISTINCT: &[Check] = &[
    ("kb_mdt32", &[], "wgsl", Model::Sequential),
    ("kb_mdt32", &[], "wgsl", Model::Relaxed),
    ("kb_mdt32", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];
const RANGES: &[Check] = &[
    ("depth_partition", &[("sync", "spin_lock")], "wgsl", Model::Sequential),
    ("depth_partition", &[("storage.near", "200000"), ("storage.far", "600000")], "wgsl", Model::Sequential),
    // Every range but the last is empty. The fifth candidate is one millionth behind the beginning of the last.
    ("depth_partition", &[("storage.near", "188795"), ("storage.far", "188795")], "wgsl", Model::Sequential),
    ("depth_partition", &[("sync", "interlock")], "spirv", Model::Relaxed),
];

const STREAM: &[Check] = &[
    ("kb_stream", &[("sync", "spin_lock")], "wgsl", Model::Sequential),
    ("kb_stream", &[("sync", "spin_lock")], "spirv", Model::Relaxed),
];
const CHECKED: &[Check] = &[
    ("kb_mha", &[("sync", "spin_lock"), ("storage.retries", "1")], "wgsl", Model::Sequential),
    // With three slots a fragment can be in two of them.
    ("kb_mha", &[("storage.retries", "0")], "wgsl", Model::Sequential),
];
const REPEATED: &[Check] = &[
    ("kb_multi", &[], "wgsl", Model::Sequential),
    ("kb_multi", &[], "wgsl", Model::Relaxed),
    ("kb_multi", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];

const PEELED: &[Check] = &[
    ("k_peeling", &[], "wgsl", Model::Sequential),
    ("k_peeling", &[("counters", "all"), ("sync", "interlock")], "spirv", Model::Relaxed),
    // Several passes over the scene in each iteration.
    ("mdt32_coplanar", &[("peeling", "k_layers")], "wgsl", Model::Sequential),
    // An iteration that is the last although fragments remain.
    ("mdt32_coplanar", &[("peeling", "k_layers"), ("peeling.iterations", "2")], "wgsl", Model::Sequential),
];

const LAYERS: &[Check] = &[
    ("f2b_fab", &[], "wgsl", Model::Sequential),
    ("f2b_kb", &[("counters", "all")], "wgsl", Model::Relaxed),
    ("ab_sb", &[("peeling", "depth_layers"), ("counters", "all")], "wgsl", Model::Sequential),
    ("f2b_fab", &[("peeling.iterations", "2")], "wgsl", Model::Sequential),
    ("dual", &[("peeling", "depth_layers")], "wgsl", Model::Sequential),
];
const SIDES: &[Check] = &[
    ("dual_fab", &[], "wgsl", Model::Sequential),
    ("dual_kb", &[("counters", "all")], "wgsl", Model::Relaxed),
    ("ab_sb", &[("peeling", "both_sides"), ("counters", "all")], "wgsl", Model::Sequential),
    ("dual_fab", &[("peeling.iterations", "1")], "wgsl", Model::Sequential),
];
const BUCKET_LAYERS: &[Check] = &[
    ("bun", &[], "wgsl", Model::Sequential),
    ("ab_sb", &[("peeling", "bucket_layers"), ("counters", "all")], "wgsl", Model::Sequential),
    ("f2b_kb", &[("peeling", "bucket_layers"), ("peeling.buckets", "2")], "wgsl", Model::Relaxed),
    // The whole range is one bucket.
    ("f2b_fab", BUCKET_CUT, "wgsl", Model::Sequential),
];
const BUCKET_CUT: &[(&str, &str)] =
    &[("peeling", "bucket_layers"), ("peeling.buckets", "1"), ("peeling.iterations", "2")];
const IDS: &[Check] = &[
    ("f2b_2p", &[("counters", "all")], "wgsl", Model::Sequential),
    ("ab_sb", &[("peeling", "id_pairs")], "wgsl", Model::Relaxed),
    ("f2b_fab", &[("peeling", "id_pairs"), ("peeling.iterations", "1")], "wgsl", Model::Sequential),
];
const IDS_ON_DEMAND: &[Check] = &[
    ("f2b_1p", &[("counters", "all")], "wgsl", Model::Sequential),
    ("f2b_1p", &[("peeling.iterations", "2")], "wgsl", Model::Sequential),
    ("f2b_1p", &[("peeling.iterations", "1")], "wgsl", Model::Relaxed),
];
const IDS_TESTED: &[Check] = &[
    ("f2b_3p", &[("counters", "all")], "glsl", Model::Sequential),
    ("ab_sb", &[("peeling", "id_pairs_tested")], "spirv", Model::Relaxed),
    ("f2b_fab", &[("peeling", "id_pairs_tested"), ("peeling.iterations", "2")], "glsl", Model::Sequential),
];
const IDS_OF_BOTH_SIDES: &[Check] = &[
    ("dual_2p", &[("counters", "all")], "wgsl", Model::Sequential),
    ("ab_sb", &[("peeling", "id_pairs_both_sides")], "wgsl", Model::Relaxed),
    ("f2b_fab", &[("peeling", "id_pairs_both_sides"), ("peeling.iterations", "1")], "wgsl", Model::Sequential),
];
const SLOTS: &[Check] = &[
    ("dual", &[], "wgsl", Model::Sequential),
    ("f2b_2p", &[("counters", "all")], "wgsl", Model::Relaxed),
    ("bun", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];
const PARTS: &[Check] = &[
    ("bad", &[("k", "2"), ("counters", "all")], "wgsl", Model::Sequential),
    ("bad", &[("k", "8"), ("fragment.color", "vec4")], "wgsl", Model::Relaxed),
    ("bad", &[("k", "33"), ("storage.words", "1")], "wgsl", Model::Sequential),
];
const FRONT_TO_BACK: &[Check] = &[
    ("kplus_array", SINGLE_PEELED, "wgsl", Model::Sequential),
    ("kplus_array", SINGLE_CUT, "wgsl", Model::Sequential),
    ("kplus_array", SINGLE_AFTER_PREPASS, "spirv", Model::Relaxed),
];
const SINGLE_PEELED: &[(&str, &str)] =
    &[("storage", "single"), ("k", "1"), ("peeling", "front_to_back"), ("counters", "all")];
const SINGLE_CUT: &[(&str, &str)] =
    &[("storage", "single"), ("k", "1"), ("peeling", "front_to_back"), ("peeling.iterations", "2")];
const SINGLE_AFTER_PREPASS: &[(&str, &str)] =
    &[("storage", "single"), ("k", "1"), ("peeling", "front_to_back"), ("cull", "z_prepass")];

const MUTATED: [(&str, &str, &[Check]); 31] = [
    ("storage", "stream_array", STREAM),
    ("storage", "checksummed_array", CHECKED),
    ("storage", "multipass_array", REPEATED),
    ("storage", "paged_list", PAGES),
    ("storage", "bucket_lists", BUCKETS),
    ("storage", "max_heap", HEAP),
    ("storage", "cascade", CASCADE),
    ("storage", "fixed_array", ARRAY),
    ("storage", "max_array", KPLUS),
    ("storage", "sorted_array", SORTED),
    ("storage", "linked_list", LIST),
    ("storage", "exact_regions", REGIONS),
    ("storage", "revised_array", REVISED),
    ("storage", "ordered_list", ORDERED),
    ("storage", "bounded_regions", BOUNDED),
    ("storage", "wide_cascade", WIDE),
    ("storage", "distinct_cascade", DISTINCT),
    ("storage", "depth_ranges", RANGES),
    ("sync", "spin_lock", KPLUS),
    ("sync", "slot_counter", LIST),
    ("peeling", "k_layers", PEELED),
    ("peeling", "depth_layers", LAYERS),
    ("peeling", "both_sides", SIDES),
    ("peeling", "front_to_back", FRONT_TO_BACK),
    ("peeling", "bucket_layers", BUCKET_LAYERS),
    ("peeling", "id_pairs", IDS),
    ("peeling", "id_pairs_tested", IDS_TESTED),
    ("peeling", "ids_on_demand", IDS_ON_DEMAND),
    ("peeling", "id_pairs_both_sides", IDS_OF_BOTH_SIDES),
    ("storage", "layer_slots", SLOTS),
    ("storage", "adaptive_ranges", PARTS),
];

/// The checks of a storage that the table does not list, with a technique of the storage and default choices.
const STORAGE_ONLY: &[Check] =
    &[(STORAGE_ONLY_KEY, &[], "wgsl", Model::Sequential), (STORAGE_ONLY_KEY, &[], "spirv", Model::Relaxed)];
const STORAGE_ONLY_KEY: &str = "alone";

/// Returns every mutated row with its checks: those of the table, and every other storage whose shaders share memory. Depth
/// test, stencil test and blending have no memory accesses to interleave.
fn mutated() -> Vec<(&'static str, String, &'static [Check])> {
    let listed = MUTATED.iter().map(|(axis, key, checks)| (*axis, (*key).to_owned(), *checks));
    let registry = Registry::builtin();
    let is_unlisted = |row: &&Row| {
        let is_listed = MUTATED.iter().any(|(axis, key, _)| *axis == row.axis && *key == row.key);
        !is_listed && !row.provides.contains(&Capability::FixedFunction)
    };
    let others = registry.rows_of("storage").filter(is_unlisted).map(|row| ("storage", row.key.clone(), STORAGE_ONLY));
    listed.chain(others.collect::<Vec<_>>()).collect()
}

/// Returns the registry with a technique of one storage and default choices.
fn with_storage_only(registry: &Registry, storage: &str) -> Registry {
    let key: &'static str = String::leak(storage.to_owned());
    let is_one = |row: &Row| row.conditions.iter().any(|condition| &*condition.formula.0 == "keep == 1");
    let keeps_all = |row: &Row| row.provides.contains(&Capability::KeepsAll);
    let row = registry.row("storage", storage);
    let keep = match row {
        Some(row) if keeps_all(row) => KeepDefault::All,
        Some(row) if is_one(row) => KeepDefault::Best(1),
        _ => KeepDefault::Best(8),
    };
    let choices = vec![("storage", key)];
    registry.clone().with_technique(Technique {
        key: STORAGE_ONLY_KEY.to_owned(),
        title: "",
        paper: "",
        summary: "",
        keep,
        choices,
    })
}

#[test]
fn every_check_holds_without_a_mutation() {
    for (_, key, checks) in mutated() {
        let registry = with_storage_only(&Registry::builtin(), &key);
        for (technique, set, target, model) in checks {
            let deep = DEEP.contains(&&*key).then(|| deep(*model));
            for limits in std::iter::once(limits(2, *model)).chain(deep) {
                let report = report(technique, set, target, &limits, &registry).unwrap();
                let failure = report.failure.filter(|_| !report.is_declared);
                assert_eq!(failure, None, "{key}, {technique} {set:?} {target} {model:?}");
            }
        }
    }
}

#[test]
fn every_mutant_is_killed() {
    let work: Vec<(&str, String, &[Check], Mutant)> = mutated()
        .into_iter()
        .flat_map(|(axis, key, checks)| {
            let text = Registry::builtin().row(axis, &key).unwrap().template.clone().unwrap().source;
            let is_judged = |mutant: &Mutant| !JUDGED_ELSEWHERE.contains(&mutant.function.as_str());
            let judged: Vec<Mutant> = mutants(&text).into_iter().filter(is_judged).collect();
            judged.into_iter().map(move |mutant| (axis, key.clone(), checks, mutant))
        })
        .collect();
    let queue = Mutex::new(work.into_iter());
    let results: Mutex<Vec<(Outcome, String)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let next = queue.lock().unwrap().next();
                    let Some((axis, key, checks, mutant)) = next else { break };
                    let outcome = outcome(axis, &key, checks, &mutant);
                    let name = format!("{axis}/{key}: `{}` -> `{}`", mutant.before, mutant.after);
                    results.lock().unwrap().push((outcome, name));
                }
            });
        }
    });
    let results = results.into_inner().unwrap();
    let count = |expected: Outcome| results.iter().filter(|(outcome, _)| *outcome == expected).count();
    let (killed, illegal) = (count(Outcome::Killed), count(Outcome::Illegal));
    let survived = results.iter().filter(|(outcome, _)| *outcome == Outcome::Survived).map(|(_, name)| name);
    let mut survivors: Vec<&String> = survived.collect();
    survivors.sort();
    println!("{} mutants: {killed} killed, {illegal} not valid WGSL, {} survive", results.len(), survivors.len());
    let explained: Vec<String> = SURVIVORS
        .iter()
        .chain(OF_RACES)
        .chain(OF_PEELING)
        .chain(OF_SLOTS)
        .map(|(row, before, after, _)| format!("{row}: `{before}` -> `{after}`"))
        .collect();
    // A line that occurs twice in a template gives two mutants of the same name, which need two reasons.
    let count_of = |name: &String, all: &[&String]| all.iter().filter(|other| **other == name).count();
    let explained: Vec<&String> = explained.iter().collect();
    let unexplained: Vec<&&String> =
        survivors.iter().filter(|name| count_of(name, &survivors) > count_of(name, &explained)).collect();
    assert!(unexplained.is_empty(), "survive without a reason:\n{unexplained:#?}");
    let outdated: Vec<&&String> =
        explained.iter().filter(|name| count_of(name, &survivors) < count_of(name, &explained)).collect();
    assert!(outdated.is_empty(), "listed as survivors, but killed:\n{outdated:#?}");
    assert!(killed > 400, "only {killed} mutants");
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outcome {
    Killed,
    Survived,
    /// naga or the linker rejects it.
    Illegal,
}

/// The rows with mutants that only more entries, or more initial fragments, kill: an error below the second level of a heap, a counter
/// of repairs that starts too high, and pages that are skipped.
const DEEP: [&str; 4] = ["max_heap", "bounded_regions", "checksummed_array", "paged_list"];

/// Returns limits of seven fragments for heaps of five and six, with a few random schedules. All initial fragments are displaced,
/// so that an error deep in the heap reaches its root.
fn deep(model: Model) -> Limits {
    Limits { fragments: vec![7], entries: vec![5, 6], random_schedules: Some(2), ..limits(2, model) }
}

/// Checks a mutant; returns its outcome.
pub(crate) fn outcome(axis: &str, key: &str, checks: &[Check], mutant: &Mutant) -> Outcome {
    let registry = with_storage_only(&Registry::builtin(), key);
    let old: &Row = registry.row(axis, key).unwrap();
    let path = old.template.clone().unwrap().path;
    let row = Row { template: Some(Template::new(path, mutant.text.clone())), ..old.clone() };
    let registries = registries(&registry, row);
    for (number, (technique, set, target, model)) in checks.iter().enumerate() {
        let deep = deep(*model);
        // The first check uses every registry, the others only that of the changed row.
        let count = if number == 0 { registries.len() } else { 1 };
        let checked = registries[..count].iter().map(|(registry, limits)| (limits(*model), registry));
        let deep = DEEP.contains(&key).then_some((deep, &registries[0].0));
        for (limits, registry) in checked.chain(deep) {
            let limits = Limits { shortest: false, ..limits };
            match report(technique, set, target, &limits, registry) {
                Ok(report) if report.failure.is_some() && !report.is_declared => return Outcome::Killed,
                Ok(_) => {}
                Err(Error::Unable(_) | Error::NotApplicable(_)) => return Outcome::Killed,
                Err(Error::Description(diagnostics)) => {
                    let messages: String = diagnostics.iter().map(|one| one.message.clone()).collect();
                    let illegal = messages.contains("naga rejects") || messages.contains("not a declaration");
                    return if illegal { Outcome::Illegal } else { Outcome::Killed };
                }
            }
        }
    }
    Outcome::Survived
}

/// A registry, and the limits of its check.
type LimitedRegistry = (Registry, fn(Model) -> Limits);

/// Returns the registry with a changed row, and further registries that show more errors of the row.
fn registries(registry: &Registry, row: Row) -> Vec<LimitedRegistry> {
    let two = |model| limits(2, model);
    let mut all: Vec<LimitedRegistry> = Vec::new();
    // With few iterations, a hazard permits what races leave. With enough iterations it does not.
    if is_repeated(&row) {
        let three = |model| Limits { fragments: vec![3], entries: vec![2], ..limits(3, model) };
        all.extend([(registry.clone().with(with_iterations(row.clone(), 8)), three as fn(Model) -> Limits)]);
    }
    // Two racing fragments lose none between them where both ends of a pixel are found.
    if row.axis == "peeling" && row.requires.contains(&Capability::KeepsAll) {
        let three = |model| Limits { fragments: vec![3], ..limits(3, model) };
        all.push((registry.clone().with(row.clone()), three));
    }
    // The operator *over* does not use the fragment behind.
    if row.provides.contains(&Capability::Streams) {
        let old = registry.row("resolve", "stream").unwrap().clone();
        let both = Row { template: Some(Template::new("rows/both_neighbours.wgsl", BOTH)), ..old };
        all.push((registry.clone().with(row.clone()).with(both), two));
    }
    all.insert(0, (registry.clone().with(row), two));
    all
}
