//! Storages that keep the worst entry at slot 0 and replace it inside a critical section.

use super::parts::{REPLACES_WORST, SLOTS, array_resources, reset, resolve};
use crate::vocabulary::{Access, Capability, Element, Feature, Parameter, Pass, Resource, Row, Soundness, Step};

pub(super) fn max_array() -> Row {
    Row {
        template: Some(template!("storage/max_array")),
        ..worst_first(Row::new("storage", "max_array", "k entries per pixel, the worst at slot 0", "K15 §3.2"))
    }
}

pub(super) fn max_heap() -> Row {
    Row {
        template: Some(template!("storage/max_heap")),
        ..worst_first(Row::new("storage", "max_heap", "k entries per pixel in a heap, the worst at slot 0", "K15 §3.2"))
    }
}

/// Returns the row of the array whose first k-1 fragments need no lock.
pub(super) fn revised_array() -> Row {
    let mut resources = array_resources("slot 0 holds the worst kept key, EMPTY until k fragments are kept");
    resources.push(Resource::new("tickets", Element::Word, "fragments that requested a slot").by("pixel", "pixels"));
    Row {
        template: Some(template!("storage/revised_array")),
        resources,
        steps: vec![
            reset(&["keys", "tickets"]),
            // A waiting fragment reads keys that others write outside the lock, so their loads must be exact.
            Step::Pass(
                Pass::geometry("store", "store_reserving")
                    .uses("keys", Access::Atomic)
                    .uses("entries", Access::Coherent)
                    .uses("tickets", Access::Atomic),
            ),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        provides: [REPLACES_WORST.as_slice(), &SLOTS].concat(),
        requires: vec![Capability::MutualExclusion],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        parameters: vec![Parameter::retry_limit(
            "wait",
            "WAIT_LIMIT",
            "4096",
            (1, 1 << 24),
            "checks of the other slots before a fragment times out and is counted",
        )],
        // Fences order stores outside the critical section before it, whatever implements the section.
        soundness: Soundness::Lock,
        ..Row::new(
            "storage",
            "revised_array",
            "k entries per pixel, the worst at slot 0; the first k-1 are stored without the lock",
            "K15 §3.2.1, Alg. 2, corrected",
        )
    }
}

/// Adds what storages share that keep the worst entry at slot 0 and are written inside a critical section.
fn worst_first(row: Row) -> Row {
    let mut resources = array_resources("slot 0 holds the worst kept key, EMPTY until k fragments are kept");
    resources.push(Resource::new("kept_counts", Element::Word, "fragments kept, at most k").by("pixel", "pixels"));
    Row {
        resources,
        steps: vec![
            reset(&["keys", "kept_counts"]),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("keys", Access::Hinted)
                    .uses("entries", Access::Coherent)
                    .uses("kept_counts", Access::Coherent),
            ),
            resolve(&["keys", "entries", "kept_counts"]),
        ],
        calls: vec!["allocation", "overflow"],
        provides: [REPLACES_WORST.as_slice(), &SLOTS].concat(),
        requires: vec![Capability::MutualExclusion],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        ..row
    }
}
