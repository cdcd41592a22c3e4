//! Storages that keep the worst entry at slot 0 and replace it inside a critical section.

use super::{OF_THE_K_BEST, array_resources, reset, resolve};
use crate::vocabulary::{Access, Capability, Element, Fact, Parameter, Pass, Resource, Row, Soundness, Step};

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

/// The array whose first k-1 fragments need no lock.
pub(super) fn revised_array() -> Row {
    let mut resources = array_resources("slot 0 holds the worst kept key, EMPTY until k fragments are in");
    resources.push(Resource::new("tickets", Element::Word, "fragments that asked for a slot").by("pixel", "pixels"));
    Row {
        template: Some(template!("storage/revised_array")),
        resources,
        steps: vec![
            reset(&["keys", "tickets"]),
            // Who waits reads keys that others write outside the lock: no load of them may be weakened.
            Step::Pass(
                Pass::geometry("store", "store_reserving")
                    .uses("keys", Access::Atomic)
                    .uses("entries", Access::Coherent)
                    .uses("tickets", Access::Atomic),
            ),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        offers: OF_THE_K_BEST.to_vec(),
        requires: vec![Fact::Critical],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        parameters: vec![Parameter::number(
            "wait",
            "WAIT_LIMIT",
            "4096",
            (1, 1 << 24),
            "looks at the slots of others before a fragment is given up and counted",
        )],
        // What is stored outside the critical section reaches those inside by fences, whatever the section is made of.
        soundness: Soundness::Lock,
        ..Row::new(
            "storage",
            "revised_array",
            "k entries per pixel, the worst at slot 0; the first k-1 are stored without the lock",
            "K15 §3.2.1, Alg. 2, mended",
        )
    }
}

/// What storages share that keep the worst entry at slot 0 and are written inside a critical section.
fn worst_first(row: Row) -> Row {
    let mut resources = array_resources("slot 0 holds the worst kept key, EMPTY until k fragments are in");
    resources.push(Resource::new("filled", Element::Word, "fragments kept, at most k").by("pixel", "pixels"));
    Row {
        resources,
        steps: vec![
            reset(&["keys", "filled"]),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses_rechecked("keys")
                    .uses("entries", Access::Coherent)
                    .uses("filled", Access::Coherent),
            ),
            resolve(&["keys", "entries", "filled"]),
        ],
        calls: vec!["overflow"],
        offers: OF_THE_K_BEST.to_vec(),
        requires: vec![Fact::Critical],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        ..row
    }
}
