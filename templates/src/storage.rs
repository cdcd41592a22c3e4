//! Axis `storage`: where the fragments of a pixel are stored. A plan starts from the resources and passes of a storage
//! row.

mod checksummed;
mod fixed_function;
mod list;
mod lists;
mod minima;
mod multipass;
mod parts;
mod ranges;
mod regions;
mod stream;
mod worst_first;

use crate::conditions::keeps_one;
use crate::vocabulary::{Access, Capability, Element, Feature, Hazard, Parameter, Pass, Permits, Resource, Row, Step};
use parts::{REPLACES_WORST, SLOTS, array_resources, reset, resolve};

pub(crate) use ranges::DEPTH_RANGE;

pub(crate) fn rows() -> Vec<Row> {
    vec![
        list::linked_list(),
        regions::exact_regions(),
        fixed_array(),
        claimed_array(),
        layer_slots(),
        sorted_array(),
        worst_first::max_array(),
        worst_first::max_heap(),
        minima::cascade(),
        minima::distinct_cascade(),
        minima::wide_cascade(),
        worst_first::revised_array(),
        list::ordered_list(),
        ranges::depth_ranges(),
        ranges::adaptive_ranges(),
        regions::bounded_regions(),
        lists::paged_list(),
        lists::bucket_lists(),
        stream::stream_array(),
        checksummed::checksummed_array(),
        multipass::multipass_array(),
        fixed_function::depth_tested(),
        fixed_function::stencil_routed(),
        single(),
    ]
}

fn single() -> Row {
    let entries = Resource::new("entries", Element::Entry, "the pixel's best fragment; all ones: none");
    Row {
        template: Some(template!("storage/single")),
        resources: vec![entries.by("pixel", "pixels").cleared(u32::MAX)],
        steps: vec![
            Step::Pass(Pass::geometry("store", "store").uses("entries", Access::Atomic)),
            resolve(&["entries"]),
        ],
        calls: vec!["overflow"],
        provides: vec![
            Capability::KeepsBest,
            Capability::KeepsEqualKeys,
            Capability::AcceptsKBestOnly,
            Capability::ConservativeBound,
            Capability::ReportsWholeFragments,
            Capability::Sorted,
        ],
        requires: vec![Capability::MutualExclusion, Capability::OneSample],
        conditions: vec![keeps_one()],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "spin_lock".into()),
            ("cull".into(), "early".into()),
            ("sort".into(), "none".into()),
        ],
        ..Row::new(
            "storage",
            "single",
            "the best fragment of a pixel, for any criterion and a payload of any size",
            "K15 §4.3",
        )
    }
}

fn sorted_array() -> Row {
    Row {
        template: Some(template!("storage/sorted_array")),
        resources: array_resources("keys in ascending order; EMPTY past the last"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses_exclusively("keys", Access::Atomic, Access::Hinted)
                    .uses_exclusively("entries", Access::Atomic, Access::Coherent),
            ),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        provides: [REPLACES_WORST.as_slice(), &SLOTS, &[Capability::RaceTolerant, Capability::KeepsArrival]].concat(),
        // Entries are sorted by key.
        implies: vec![("depth_key".into(), Capability::Sorted), ("depth_key".into(), Capability::OrderedSlots)],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into()), ("sort".into(), "none".into())],
        hazards: vec![
            Hazard::new(
                "lost-update",
                "two fragments read the same entry and the later store wins: one is lost, undetected and uncounted",
                Permits::LOST,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new(
                "duplicate",
                "two fragments move the same entry concurrently, and it is then in two slots",
                Permits::DUPLICATE,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new("torn", "key and payload of a slot come from two fragments", Permits::TORN)
                .unless(Capability::MutualExclusion),
            Hazard::new(
                "stale",
                "a key is visible before its value words, and moves on with the previous words of the slot",
                Permits::STALE,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new("unsorted", "the entries of a pixel are not sorted by key", Permits::UNSORTED)
                .unless(Capability::MutualExclusion),
        ],
        ..Row::new("storage", "sorted_array", "k entries per pixel, sorted by insertion", "B06 §3; Bavoil et al. 2007")
    }
}

fn fixed_array() -> Row {
    Row {
        template: Some(template!("storage/fixed_array")),
        resources: vec![
            Resource::new("counts", Element::Word, "fragments of the pixel, including those without a slot")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("entries", Element::Entry, "the fragments, in the order of arrival")
                .by("slot", "n")
                .by("pixel", "pixels"),
        ],
        steps: vec![
            Step::Pass(Pass::geometry("store", "store").uses("counts", Access::Atomic).uses("entries", Access::Plain)),
            resolve(&["counts", "entries"]),
        ],
        calls: vec!["overflow"],
        ..all_in_array(
            "fixed_array",
            "n slots per pixel, reserved by an atomic counter",
            "Liu et al. 2010 (FreePipe); K15 §2",
        )
    }
}

fn claimed_array() -> Row {
    let store = Pass::geometry("store", "store").uses("keys", Access::Atomic).uses("entries", Access::Plain);
    Row {
        template: Some(template!("storage/claimed_array")),
        resources: vec![
            Resource::new("keys", Element::Word, "the keys of the fragments, in the order of arrival; EMPTY: free")
                .by("slot", "n")
                .by("pixel", "pixels")
                .cleared(u32::MAX),
            Resource::new("entries", Element::Value, "the value words of the fragments")
                .by("slot", "n")
                .by("pixel", "pixels"),
        ],
        steps: vec![Step::Pass(store), resolve(&["keys", "entries"])],
        calls: vec!["overflow"],
        parameters: vec![Parameter::retry_limit(
            "retries",
            "CLAIM_TRIES",
            "4096",
            (1, 1 << 24),
            "failed exchanges after which a fragment times out and is counted",
        )],
        ..all_in_array(
            "claimed_array",
            "n slots per pixel, each taken by an atomic exchange of its key: no counter, but a slot is searched for",
            "after D13 §3.2.1 (Alg. 3)",
        )
    }
}

/// Returns the row that keeps one fragment for each slot of an iteration of peeling.
fn layer_slots() -> Row {
    let slots = |name: &str, element: Element, summary: &'static str| {
        Resource::new(name, element, summary).by("slot", "PEELING_SLOTS").by("pixel", "pixels")
    };
    let row = all_in_array(
        "layer_slots",
        "one fragment for each slot of an iteration of peeling: of a side, of an id, of a bucket",
        "Bavoil & Myers 2008; D13 §3.1",
    );
    let store = Pass::geometry("store", "store").uses("keys", Access::Atomic).uses("entries", Access::Plain);
    Row {
        template: Some(template!("storage/layer_slots")),
        resources: vec![
            slots("keys", Element::Word, "the key of the slot's fragment; EMPTY: none").cleared(u32::MAX),
            slots("entries", Element::Value, "the value words of the fragment"),
        ],
        steps: vec![Step::Pass(store), resolve(&["keys", "entries"])],
        calls: vec!["overflow", "peeling"],
        // A slot holds one fragment.
        provides: [row.provides.as_slice(), &[Capability::Sorted, Capability::OnePerSlot]].concat(),
        defaults: [row.defaults.as_slice(), &[("sort".into(), "none".into())]].concat(),
        requires: vec![Capability::DividesLayers, Capability::OneSample],
        hazards: vec![
            Hazard::new(
                "equal-keys",
                "of fragments with equal depths one per layer is kept; the others are counted",
                Permits::ONE_OF_EQUAL_KEYS,
            )
            .unless(Capability::TellsIdsApart),
            Hazard::new(
                "equal-ids",
                "of fragments with equal depths and equal ids one is kept; the others are counted",
                Permits::ONE_OF_EQUAL_IDS,
            ),
        ],
        ..row
    }
}

/// Returns the common part of rows that store every fragment in n slots per pixel without a lock.
fn all_in_array(key: &str, summary: &'static str, paper: &'static str) -> Row {
    Row {
        provides: vec![
            Capability::LockFree,
            Capability::KeepsAll,
            Capability::Indexed,
            Capability::ReportsWholeFragments,
        ],
        implies: vec![("limited".into(), Capability::AcceptsKBestOnly)],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new("storage", key, summary, paper)
    }
}
