//! Storages of one fragment per depth range.

use super::parts::{array_resources, reset, resolve};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{
    Access, Capability, Element, Feature, Hazard, KeptFragments, Parameter, Pass, Permits, Resource, Row, Step,
};

/// The range of a depth, one of k equal ranges; depths outside all of them belong to the first or the last.
pub(crate) const DEPTH_RANGE: &str = "min(k - 1, (max(depth_millionths, NEAR_MILLIONTHS) - NEAR_MILLIONTHS) * k / \
     (max(FAR_MILLIONTHS, NEAR_MILLIONTHS + 1) - NEAR_MILLIONTHS))";

/// Returns the row that keeps the nearest fragment of each of k depth ranges.
pub(super) fn depth_ranges() -> Row {
    Row {
        template: Some(template!("storage/depth_ranges")),
        resources: array_resources("the key of the nearest fragment in this range; EMPTY: none"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(
                Pass::geometry("store", "store").uses("keys", Access::Coherent).uses("entries", Access::Coherent),
            ),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        provides: vec![
            Capability::DisplacesUnderLock,
            Capability::Indexed,
            Capability::Sorted,
            Capability::ReportsWholeFragments,
        ],
        // It keeps one of two triangles that share an edge: several samples would show cracks.
        requires: vec![Capability::MutualExclusion, Capability::OneSample],
        conditions: vec![depth_key(), limited()],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("sort".into(), "none".into())],
        parameters: vec![
            depth("near", "NEAR_MILLIONTHS", "0", "depth at which the first range begins, in millionths"),
            depth("far", "FAR_MILLIONTHS", "1000000", "depth at which the last range ends, in millionths"),
        ],
        keeps: Some(KeptFragments::best_of_each(DEPTH_RANGE)),
        hazards: vec![Hazard::new(
            "one-per-range",
            "of the fragments in one depth range only the nearest is kept; the others are counted",
            Permits::NOTHING,
        )],
        ..Row::new("storage", "depth_ranges", "the nearest fragment in each of k equal ranges of depth", "B06 §4.2")
    }
}

fn depth(name: &'static str, constant: &'static str, default: &'static str, summary: &'static str) -> Parameter {
    Parameter::number(name, constant, default, (0, 1_000_000), summary)
}

/// The bucket of a depth, one of equal parts of the pixel's depth range.
const BUCKET_OF_RANGE: &str =
    "(depth_steps - nearest_steps) * 32 * OCCUPANCY_WORDS / (farthest_steps - nearest_steps + 1)";

/// Returns the row that keeps the nearest fragment of up to k depth ranges, which follow the fragments of the pixel.
pub(super) fn adaptive_ranges() -> Row {
    let by_pixel = |name: &str, extent: (&str, &'static str), summary: &'static str| {
        Resource::new(name, Element::Word, summary).by(extent.0, extent.1).by("pixel", "pixels").cleared(0)
    };
    let ends = "the pixel's range of keys: the nearest with its bits inverted, the farthest; 0: none";
    let mut slots = array_resources("the least key in this part of the range; EMPTY: none");
    slots[0] = slots[0].clone().cleared(u32::MAX);
    // The passes that find the range, mark its buckets and find the least key of each part.
    let find = |number: u32, name: &str| {
        let mut pass = Pass::geometry(name, "prepass");
        pass.constants.push(("PREPASS".to_owned(), number));
        pass
    };
    let mark = find(1, "mark_buckets").uses("ranges", Access::Read).uses_rechecked("occupancy");
    let least = find(2, "find_least").uses("ranges", Access::Read).uses("occupancy", Access::Read);
    let store = Pass::geometry("store", "store").uses("ranges", Access::Read).uses("occupancy", Access::Read);
    let store = store.uses("keys", Access::Read).uses("claims", Access::Atomic).uses("entries", Access::Plain);
    Row {
        template: Some(template!("storage/adaptive_ranges")),
        resources: [
            by_pixel("ranges", ("end", "2"), ends),
            by_pixel("occupancy", ("word", "OCCUPANCY_WORDS"), "a bit per bucket of the range that holds a fragment"),
            by_pixel("claims", ("word", "OCCUPANCY_WORDS"), "a bit per part whose fragment is stored"),
        ]
        .into_iter()
        .chain(slots)
        .collect(),
        steps: vec![
            Step::Pass(find(0, "find_range").uses("ranges", Access::Atomic)),
            Step::Pass(mark),
            Step::Pass(least.uses_rechecked("keys")),
            Step::Pass(store),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        provides: vec![
            Capability::LockFree,
            Capability::Indexed,
            Capability::Sorted,
            Capability::ReportsWholeFragments,
        ],
        // It keeps one of two triangles that share an edge: several samples would show cracks.
        requires: vec![Capability::OneSample],
        conditions: vec![depth_key(), limited()],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into()), ("sort".into(), "none".into())],
        parameters: vec![Parameter::number(
            "words",
            "OCCUPANCY_WORDS",
            "4",
            (1, 8),
            "words of 32 buckets that divide the depth range of a pixel",
        )],
        keeps: Some(KeptFragments::best_of_each_of_k(BUCKET_OF_RANGE)),
        hazards: vec![
            Hazard::new(
                "one-per-range",
                "of the fragments in one part of the depth range only the nearest is kept; the others are counted",
                Permits::NOTHING,
            ),
            Hazard::new(
                "equal-keys",
                "of fragments with equal depths one is kept; the others are counted",
                Permits::ONE_OF_EQUAL_KEYS,
            ),
        ],
        ..Row::new(
            "storage",
            "adaptive_ranges",
            "the nearest fragment in each of up to k parts of the depth range, cut where fragments are",
            "Liu et al. 2009; D13 §3.1.4 (BAD)",
        )
    }
}
