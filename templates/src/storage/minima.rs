//! Storages that sort by cascades of atomic minima, without a lock.

use super::parts::{array_resources, reset, resolve};
use crate::vocabulary::{
    Access, Capability, Condition, Element, Feature, Hazard, Pass, Permits, Repeat, Resource, Row, Step, Until,
};

pub(super) fn cascade() -> Row {
    let mut resources = array_resources("the k least keys in ascending order, with duplicates; EMPTY past the last");
    resources.truncate(1);
    resources.push(
        Resource::new("value_words", Element::Word, "the value words of the fragments, by word")
            .by("slot", "k")
            .by("pixel", "pixels")
            .by("word", "value_words"),
    );
    let refine = Pass::geometry("refine", "refine").uses("keys", Access::Read).uses("value_words", Access::Atomic);
    let row = by_minima(Row::new(
        "storage",
        "cascade",
        "k sorted entries per pixel, refined word by word by cascades of atomic minima",
        "after Liu et al. 2010 (multidepth); K15 §2",
    ));
    Row {
        template: Some(template!("storage/cascade")),
        resources,
        steps: vec![
            reset(&["keys", "value_words"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic)),
            Step::Repeat(Repeat::new(vec![Step::Pass(refine)], Until::Times("value_words".into()), "value_words")),
            resolve(&["keys", "value_words"]),
        ],
        provides: [row.provides.as_slice(), &[Capability::KeyPerSlot, Capability::KeepsEqualKeys]].concat(),
        ..row
    }
}

/// Returns the row of the papers' 32-bit multidepth: one slot per key, value words in a second pass. It keeps one of
/// two triangles that share an edge, so it requires one sample per pixel: several would show cracks.
pub(super) fn distinct_cascade() -> Row {
    Row {
        template: Some(template!("storage/distinct_cascade")),
        resources: array_resources("the k least distinct keys in ascending order; EMPTY past the last"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic)),
            Step::Pass(Pass::geometry("refine", "refine").uses("keys", Access::Read).uses("entries", Access::Atomic)),
            resolve(&["keys", "entries"]),
        ],
        requires: vec![Capability::OneSample],
        needs: vec![Feature::FragmentAtomics],
        hazards: vec![
            Hazard::new(
                "equal-keys",
                "of fragments with equal keys only the last to write is kept; the others are counted",
                Permits::ONE_OF_EQUAL_KEYS,
            ),
            Hazard::new(
                "torn-equal-keys",
                "several value words of an entry may come from different fragments with its key",
                Permits::TORN_EQUAL_KEYS,
            ),
        ],
        ..by_minima(Row::new(
            "storage",
            "distinct_cascade",
            "the k least distinct keys by a cascade of atomic minima, value words by a second pass",
            "Liu et al. 2010 (multidepth); K15 §2",
        ))
    }
}

/// Returns the row of the papers' 64-bit multidepth: key and payload move together.
pub(super) fn wide_cascade() -> Row {
    let slots = Resource::new(
        "slots",
        Element::Word64,
        "the k least fragments in ascending order, the key above the value word; all ones past the last",
    );
    let row = by_minima(Row::new(
        "storage",
        "wide_cascade",
        "k sorted entries of at most two words per pixel, by a cascade of 64-bit atomic minima",
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
        provides: [row.provides.as_slice(), &[Capability::ReportsWholeFragments, Capability::KeepsEqualKeys]].concat(),
        conditions: vec![Condition::new(
            "entry_words <= 2",
            "at most one value word: a payload of depth and one word, or with a criterion only depth",
            "keep only depth and one attribute of one word in the fragment, or with a criterion only depth",
        )],
        needs: vec![Feature::FragmentAtomics, Feature::U64Atomics],
        ..row
    }
}

/// Adds what storages share that sort keys by a cascade of minima.
fn by_minima(row: Row) -> Row {
    Row {
        calls: vec!["counters"],
        provides: vec![
            Capability::LockFree,
            Capability::KeepsBest,
            Capability::AcceptsKBestOnly,
            Capability::ConservativeBound,
            Capability::SlotsPerPixel,
        ],
        implies: vec![("depth_key".into(), Capability::Sorted)],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "slot_counter".into()),
            ("cull".into(), "early".into()),
            ("sort".into(), "none".into()),
        ],
        ..row
    }
}
