//! A storage of depth ranges: one fragment in each.

use super::{array_resources, reset, resolve};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{Access, Capability, Fact, Hazard, Kept, Parameter, Pass, Permits, Row, Step};

/// The range of a depth, one of k equal ones; what lies outside of all belongs to the first or the last.
pub(crate) const DEPTH_RANGE: &str = "min(k - 1, (max(depth_millionths, NEAR_MILLIONTHS) - NEAR_MILLIONTHS) * k / \
     (max(FAR_MILLIONTHS, NEAR_MILLIONTHS + 1) - NEAR_MILLIONTHS))";

/// The nearest fragment of each of k ranges of depth.
pub(super) fn depth_ranges() -> Row {
    Row {
        template: Some(template!("storage/depth_ranges")),
        resources: array_resources("key of the nearest fragment in the range of this number; EMPTY: none"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(
                Pass::geometry("store", "store").uses("keys", Access::Coherent).uses("entries", Access::Coherent),
            ),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::DisplacesInTurn, Fact::Indexed, Fact::Sorted, Fact::LosesWhole],
        // Of two triangles that share an edge it keeps one: several samples would show cracks.
        requires: vec![Fact::Critical, Fact::OneSample],
        conditions: vec![depth_key(), limited()],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("sort".into(), "none".into())],
        parameters: vec![
            depth("near", "NEAR_MILLIONTHS", "0", "depth at which the first range begins, in millionths"),
            depth("far", "FAR_MILLIONTHS", "1000000", "depth at which the last range ends, in millionths"),
        ],
        keeps: Some(Kept::best_of_each(DEPTH_RANGE)),
        hazards: vec![Hazard::new(
            "one-per-range",
            "of the fragments in one range of depth the nearest is kept; the others are counted",
            Permits::NOTHING,
        )],
        ..Row::new("storage", "depth_ranges", "the nearest fragment in each of k equal ranges of depth", "B06 §4.2")
    }
}

fn depth(name: &'static str, constant: &'static str, default: &'static str, summary: &'static str) -> Parameter {
    Parameter::number(name, constant, default, (0, 1_000_000), summary)
}
