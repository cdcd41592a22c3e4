//! Storages of atomic minima: no lock, each slot keeps the lesser.

use super::{array_resources, reset, resolve};
use crate::vocabulary::{
    Access, Capability, Condition, Element, Fact, Hazard, Pass, Permits, Repeat, Resource, Row, Step, Until,
};

pub(super) fn cascade() -> Row {
    let mut resources = array_resources("the k least keys in ascending order, equal ones each; EMPTY past the last");
    resources.truncate(1);
    resources.push(
        Resource::new("tails", Element::Word, "what the fragments carry beside their keys, word by word")
            .by("slot", "k")
            .by("pixel", "pixels")
            .by("word", "beside_words"),
    );
    let settle = Pass::geometry("settle", "settle").uses("keys", Access::Read).uses("tails", Access::Atomic);
    Row {
        template: Some(template!("storage/cascade")),
        resources,
        steps: vec![
            reset(&["keys", "tails"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic)),
            Step::Repeat(Repeat {
                body: vec![Step::Pass(settle)],
                until: Until::Times("beside_words".into()),
                at_most: "beside_words".into(),
            }),
            resolve(&["keys", "tails"]),
        ],
        ..by_minima(Row::new(
            "storage",
            "cascade",
            "k entries per pixel in order, settled word by word by cascades of atomic minima",
            "after Liu et al. 2010 (multidepth); K15 §2",
        ))
    }
}

/// The papers' 32-bit multidepth: one slot per key, the rest of an entry in a second pass. Of two triangles that share an edge it
/// keeps one, so it takes one sample per pixel: others would show cracks.
pub(super) fn distinct_cascade() -> Row {
    Row {
        template: Some(template!("storage/distinct_cascade")),
        resources: array_resources("the k least keys in ascending order, equal ones once; EMPTY past the last"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic)),
            Step::Pass(Pass::geometry("settle", "settle").uses("keys", Access::Read).uses("entries", Access::Atomic)),
            resolve(&["keys", "entries"]),
        ],
        requires: vec![Fact::OneSample],
        needs: vec![Capability::FragmentAtomics],
        hazards: vec![
            Hazard::new(
                "equal-keys",
                "of fragments with equal keys one is kept, the last to write; the others are counted",
                Permits::ONE_OF_EQUAL_KEYS,
            ),
            Hazard::new(
                "torn-equal-keys",
                "what stands beside a key comes from several fragments of that key, where it is several words",
                Permits::TORN_EQUAL_KEYS,
            ),
        ],
        ..by_minima(Row::new(
            "storage",
            "distinct_cascade",
            "the k least distinct keys by a cascade of atomic minima, the rest by a second pass",
            "Liu et al. 2010 (multidepth); K15 §2",
        ))
    }
}

/// The papers' 64-bit multidepth: key and payload move together.
pub(super) fn wide_cascade() -> Row {
    let slots = Resource::new(
        "slots",
        Element::Word64,
        "the k least fragments in ascending order, the key above what stands beside it; all ones past the last",
    );
    let row = by_minima(Row::new(
        "storage",
        "wide_cascade",
        "k entries of at most two words per pixel in order, by a cascade of 64-bit atomic minima",
        "K15 §2 (KB-MDT64)",
    ));
    Row {
        template: Some(template!("storage/wide_cascade")),
        resources: vec![slots.by("slot", "k").by("pixel", "pixels")],
        steps: vec![
            reset(&["slots"]),
            Step::Pass(Pass::geometry("store", "store").uses("slots", Access::Atomic)),
            resolve(&["slots"]),
        ],
        calls: vec!["overflow"],
        offers: [row.offers.as_slice(), &[Fact::LosesWhole]].concat(),
        conditions: vec![Condition::new(
            "entry_words <= 2",
            "at most one word beside the key: the payload is depth and one word, or with a criterion depth alone",
            "leave depth and one attribute of one word in the fragment, or with a criterion depth alone",
        )],
        needs: vec![Capability::FragmentAtomics, Capability::U64Atomics],
        ..row
    }
}

/// What storages share whose keys are settled by a cascade of minima.
fn by_minima(row: Row) -> Row {
    Row {
        calls: vec!["counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsBest, Fact::BestSuffice, Fact::BoundAnyInstant],
        implies: vec![("depth_key".into(), Fact::Sorted)],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "slot_counter".into()),
            ("cull".into(), "early".into()),
            ("sort".into(), "none".into()),
        ],
        ..row
    }
}
