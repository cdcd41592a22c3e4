//! Every small change to a storage or a sync must be noticed. The operators were fixed before the first run: delete a
//! statement, swap two that follow each other, make an atomic operation a read and a write, a number one more or one
//! less, `<` ↔ `<=`. What is not noticed stands in `survivors.rs` with its reason.

use std::sync::Mutex;

use fragbuf_checker::{Error, Limits, Model};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Fact, KeepDefault, Row, Technique, Template};

use crate::mutants::{Mutant, mutants};
use crate::repeated::{is_repeated, with_rounds};
use crate::subjects::{limits, report};
use crate::survivors::SURVIVORS;
use crate::survivors_of_races::OF_RACES;

const BOTH: &str = include_str!("rows/both_neighbours.wgsl");

/// Axis and key of a mutated row, and what checks it: technique, changes, target, model.
pub(crate) type Check = (&'static str, &'static [(&'static str, &'static str)], &'static str, Model);

/// What replaces kept fragments, and so tells when a displaced one is handed over.
const MERGED: &[(&str, &str)] = &[("overflow", "merge_last"), ("sync", "spin_lock"), ("cull", "none")];

const KPLUS: &[Check] = &[
    ("kplus_array", &[], "wgsl", Model::Sequential),
    ("kplus_array", &[], "spirv", Model::Late),
    ("kplus_array", &[("sync", "interlock")], "spirv", Model::Late),
    ("kplus_array", MERGED, "wgsl", Model::Sequential),
];
const SORTED: &[Check] = &[
    ("kb", &[("sync", "spin_lock"), ("cull", "early")], "wgsl", Model::Sequential),
    ("kb", &[("sync", "spin_lock"), ("cull", "early")], "spirv", Model::Late),
    ("kb", MERGED, "wgsl", Model::Sequential),
    ("kb", &[("overflow", "merge_closest"), ("sync", "spin_lock")], "wgsl", Model::Sequential),
];
const LIST: &[Check] = &[("ab_ll", &[], "wgsl", Model::Sequential), ("ab_ll", &[], "wgsl", Model::Late)];
const REGIONS: &[Check] = &[("ab_sb", &[], "wgsl", Model::Sequential), ("ab_sb", &[], "wgsl", Model::Late)];

const PAGES: &[Check] = &[
    ("ab_ll_paged", &[("storage.page", "2")], "wgsl", Model::Sequential),
    ("ab_ll_paged", &[("storage.page", "1")], "wgsl", Model::Sequential),
    ("ab_ll_paged", &[], "wgsl", Model::Late),
    // Helper invocations are of those targets that know them.
    ("ab_ll_paged", &[("storage.page", "2")], "spirv", Model::Sequential),
];
const BUCKETS: &[Check] = &[("ab_ll_bun", &[], "wgsl", Model::Sequential), ("ab_ll_bun", &[], "wgsl", Model::Late)];

const HEAP: &[Check] = &[
    ("kplus_heap", &[], "wgsl", Model::Sequential),
    ("kplus_heap", &[], "spirv", Model::Late),
    ("kplus_heap", MERGED, "wgsl", Model::Sequential),
];
const CASCADE: &[Check] = &[
    ("mdt32_coplanar", &[], "wgsl", Model::Sequential),
    ("mdt32_coplanar", &[], "wgsl", Model::Late),
    // More words beside the key, each settled among equal ones before it.
    ("mdt32_coplanar", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];
const ARRAY: &[Check] = &[("ab_array", &[], "wgsl", Model::Sequential), ("ab_array", &[], "wgsl", Model::Late)];

const REVISED: &[Check] = &[
    ("kplus_array_revised", &[], "wgsl", Model::Sequential),
    ("kplus_array_revised", &[("sync", "interlock")], "spirv", Model::Late),
    ("kplus_array_revised", &[], "spirv", Model::Late),
    ("kplus_array_revised", MERGED, "wgsl", Model::Sequential),
];
const ORDERED: &[Check] = &[("kb_ll", &[], "wgsl", Model::Sequential), ("kb_ll", &[], "spirv", Model::Late)];
const BOUNDED: &[Check] = &[
    ("kplus_ab_sb", &[], "wgsl", Model::Sequential),
    // A heap for every k.
    ("kplus_ab_sb", &[("storage.array", "0")], "wgsl", Model::Sequential),
    ("kplus_ab_sb", &[], "spirv", Model::Late),
    ("kplus_ab_sb", MERGED, "wgsl", Model::Sequential),
];
const WIDE: &[Check] =
    &[("kb_mdt64", &[], "wgsl-native", Model::Sequential), ("kb_mdt64", &[], "wgsl-native", Model::Late)];
const DISTINCT: &[Check] = &[
    ("kb_mdt32", &[], "wgsl", Model::Sequential),
    ("kb_mdt32", &[], "wgsl", Model::Late),
    ("kb_mdt32", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];
const RANGES: &[Check] = &[
    ("depth_partition", &[("sync", "spin_lock")], "wgsl", Model::Sequential),
    ("depth_partition", &[("storage.near", "200000"), ("storage.far", "600000")], "wgsl", Model::Sequential),
    // No range but the last begins before it ends; the fifth candidate lies one millionth behind its beginning.
    ("depth_partition", &[("storage.near", "188795"), ("storage.far", "188795")], "wgsl", Model::Sequential),
    ("depth_partition", &[("sync", "interlock")], "spirv", Model::Late),
];

const STREAM: &[Check] = &[
    ("kb_stream", &[("sync", "spin_lock")], "wgsl", Model::Sequential),
    ("kb_stream", &[("sync", "spin_lock")], "spirv", Model::Late),
];
const CHECKED: &[Check] = &[
    ("kb_mha", &[("sync", "spin_lock"), ("storage.retries", "1")], "wgsl", Model::Sequential),
    // A fragment comes to stand in two slots where there are three.
    ("kb_mha", &[("storage.retries", "0")], "wgsl", Model::Sequential),
];
const REPEATED: &[Check] = &[
    ("kb_multi", &[], "wgsl", Model::Sequential),
    ("kb_multi", &[], "wgsl", Model::Late),
    ("kb_multi", &[("fragment.color", "vec4")], "wgsl", Model::Sequential),
];

const MUTATED: [(&str, &str, &[Check]); 20] = [
    ("storage", "stream_array", STREAM),
    ("storage", "checked_array", CHECKED),
    ("storage", "repeated_array", REPEATED),
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
];

/// Checks of a storage that none is listed for: a technique of nothing but the storage and what suits it.
const ALONE: &[Check] = &[(ALONE_KEY, &[], "wgsl", Model::Sequential), (ALONE_KEY, &[], "spirv", Model::Late)];
const ALONE_KEY: &str = "alone";

/// Every mutated row with its checks: those of the table, and every other storage whose shaders share memory. What depth
/// test, stencil and blending decide is no access to memory that could be tried in another order.
fn mutated() -> Vec<(&'static str, String, &'static [Check])> {
    let listed = MUTATED.iter().map(|(axis, key, checks)| (*axis, (*key).to_owned(), *checks));
    let registry = Registry::builtin();
    let is_open = |row: &&Row| {
        let is_listed = MUTATED.iter().any(|(axis, key, _)| *axis == row.axis && *key == row.key);
        !is_listed && !row.offers.contains(&Fact::FixedFunction)
    };
    let others = registry.rows_of("storage").filter(is_open).map(|row| ("storage", row.key.clone(), ALONE));
    listed.chain(others.collect::<Vec<_>>()).collect()
}

/// The registry with the technique of a storage alone.
fn with_alone(registry: &Registry, storage: &str) -> Registry {
    let key: &'static str = String::leak(storage.to_owned());
    let is_one = |row: &Row| row.conditions.iter().any(|condition| &*condition.formula.0 == "keep == 1");
    let keeps_all = |row: &Row| row.offers.contains(&Fact::KeepsAll);
    let row = registry.row("storage", storage);
    let keep = match row {
        Some(row) if keeps_all(row) => KeepDefault::All,
        Some(row) if is_one(row) => KeepDefault::Best(1),
        _ => KeepDefault::Best(8),
    };
    let choices = vec![("storage", key)];
    registry.clone().with_technique(Technique {
        key: ALONE_KEY.to_owned(),
        title: "",
        paper: "",
        summary: "",
        keep,
        choices,
    })
}

/// Without a change nothing is to be noticed.
#[test]
fn every_check_of_a_change_holds_without_it() {
    for (_, key, checks) in mutated() {
        let registry = with_alone(&Registry::builtin(), &key);
        for (technique, set, target, model) in checks {
            for limits in [limits(2, *model), deep(*model)] {
                let report = report(technique, set, target, &limits, &registry).unwrap();
                let fault = report.failure.filter(|_| !report.is_stated);
                assert_eq!(fault, None, "{key}, {technique} {set:?} {target} {model:?}");
            }
        }
    }
}

#[test]
fn every_small_change_is_noticed() {
    let work: Vec<(&str, String, &[Check], Mutant)> = mutated()
        .into_iter()
        .flat_map(|(axis, key, checks)| {
            let text = Registry::builtin().row(axis, &key).unwrap().template.clone().unwrap().text;
            mutants(&text).into_iter().map(move |mutant| (axis, key.clone(), checks, mutant))
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
                    let outcome = judge(axis, &key, checks, &mutant);
                    let name = format!("{axis}/{key}: `{}` -> `{}`", mutant.before, mutant.after);
                    results.lock().unwrap().push((outcome, name));
                }
            });
        }
    });
    let results = results.into_inner().unwrap();
    let count = |wanted: Outcome| results.iter().filter(|(outcome, _)| *outcome == wanted).count();
    let (noticed, illegal) = (count(Outcome::Noticed), count(Outcome::Illegal));
    let mut survivors: Vec<&String> =
        results.iter().filter(|(outcome, _)| *outcome == Outcome::Survived).map(|(_, name)| name).collect();
    survivors.sort();
    println!("{} changes: {noticed} noticed, {illegal} are no legal WGSL, {} survive", results.len(), survivors.len());
    let excuses: Vec<String> = SURVIVORS
        .iter()
        .chain(OF_RACES)
        .map(|(row, before, after, _)| format!("{row}: `{before}` -> `{after}`"))
        .collect();
    // A line that stands in a template twice has two names that are alike, and needs two reasons.
    let count_of = |name: &String, all: &[&String]| all.iter().filter(|other| **other == name).count();
    let excuses: Vec<&String> = excuses.iter().collect();
    let unexcused: Vec<&&String> =
        survivors.iter().filter(|name| count_of(name, &survivors) > count_of(name, &excuses)).collect();
    assert!(unexcused.is_empty(), "nothing notices:\n{unexcused:#?}");
    let noticed_by_now: Vec<&&String> =
        excuses.iter().filter(|name| count_of(name, &survivors) < count_of(name, &excuses)).collect();
    assert!(noticed_by_now.is_empty(), "noticed by now, though they should survive:\n{noticed_by_now:#?}");
    assert!(noticed > 400, "only {noticed} changes");
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outcome {
    Noticed,
    Survived,
    /// naga or the linker refuses it: it is no program.
    Illegal,
}

/// So many fragments that everything that a heap of six held has been displaced, in a few orders by chance: what is wrong
/// deep in a heap shows only when it comes up.
fn deep(model: Model) -> Limits {
    Limits { fragments: vec![7], entries: vec![6], seeds: Some(2), ..limits(2, model) }
}

pub(crate) fn judge(axis: &str, key: &str, checks: &[Check], mutant: &Mutant) -> Outcome {
    let registry = with_alone(&Registry::builtin(), key);
    let old: &Row = registry.row(axis, key).unwrap();
    let path = old.template.clone().unwrap().path;
    let row = Row { template: Some(Template::new(path, mutant.text.clone())), ..old.clone() };
    let registries = registries(&registry, row);
    for (number, (technique, set, target, model)) in checks.iter().enumerate() {
        let deep = deep(*model);
        // The first check tries all that there is, the others try the row.
        let count = if number == 0 { registries.len() } else { 1 };
        let tried = registries[..count].iter().map(|(registry, limits)| (limits(*model), registry));
        for (limits, registry) in tried.chain([(deep, &registries[0].0)]) {
            match report(technique, set, target, &limits, registry) {
                Ok(report) if report.failure.is_some() && !report.is_stated => return Outcome::Noticed,
                Ok(_) => {}
                Err(Error::Unable(_) | Error::NothingToTry(_)) => return Outcome::Noticed,
                Err(Error::Description(faults)) => {
                    let text: String = faults.iter().map(|fault| fault.message.clone()).collect();
                    let illegal = text.contains("naga refuses") || text.contains("not a declaration");
                    return if illegal { Outcome::Illegal } else { Outcome::Noticed };
                }
            }
        }
    }
    Outcome::Survived
}

/// A registry, and how far it is tried.
type Tried = (Registry, fn(Model) -> Limits);

/// The registry with a changed row; and more, with more fragments, where the row as it is tells less.
fn registries(registry: &Registry, row: Row) -> Vec<Tried> {
    let two = |model| limits(2, model);
    let mut all: Vec<Tried> = Vec::new();
    // Rounds are too few for some races: with enough of them there is no such excuse.
    if is_repeated(&row) {
        let three = |model| Limits { fragments: vec![3], entries: vec![2], ..limits(3, model) };
        all.extend([(registry.clone().with(with_rounds(row.clone(), 8)), three as fn(Model) -> Limits)]);
    }
    // What lies behind a fragment has no part in *over*.
    if row.offers.contains(&Fact::Streams) {
        let old = registry.row("resolve", "stream").unwrap().clone();
        let both = Row { template: Some(Template::new("rows/both_neighbours.wgsl", BOTH)), ..old };
        all.push((registry.clone().with(row.clone()).with(both), two));
    }
    all.insert(0, (registry.clone().with(row), two));
    all
}
