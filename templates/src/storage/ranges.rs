//! A storage of one fragment per depth range.

use super::parts::{array_resources, reset, resolve};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{Access, Capability, Feature, Hazard, KeptFragments, Parameter, Pass, Permits, Row, Step};

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
