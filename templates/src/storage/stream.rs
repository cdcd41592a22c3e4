//! A storage that composites fragments in depth order as they leave it.

use super::parts::{array_resources, reset};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{Access, Blend, Capability, Element, Feature, Hazard, Pass, Permits, Resource, Row, Step};

/// Returns the row of the stream: a full array evicts the nearest fragment for every new one.
pub(super) fn stream_array() -> Row {
    let mut resources = array_resources("keys in ascending order; EMPTY past the last");
    resources.push(
        Resource::new("colors", Element::Word, "the premultiplied colour of the fragments that have left, as floats")
            .by("channel", "4")
            .by("pixel", "pixels")
            .cleared(0),
    );
    resources.push(
        Resource::new("emitted", Element::Word, "the farthest key that has left; 0: none")
            .by("pixel", "pixels")
            .cleared(0),
    );
    Row {
        template: Some(template!("storage/stream_array")),
        resources,
        steps: vec![
            reset(&["keys"]),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("keys", Access::Coherent)
                    .uses("entries", Access::Coherent)
                    .uses("colors", Access::Coherent)
                    .uses("emitted", Access::Coherent),
            ),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve_stream")
                    .uses("keys", Access::Read)
                    .uses("entries", Access::Read)
                    .uses("colors", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["resolve", "counters"],
        provides: vec![Capability::Streams, Capability::Indexed, Capability::Sorted],
        requires: vec![
            Capability::MutualExclusion,
            Capability::PairValues,
            // Fragments that leave are composited for the whole pixel.
            Capability::OneSample,
        ],
        conditions: vec![depth_key(), limited()],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "spin_lock".into()),
            ("sort".into(), "none".into()),
            ("resolve".into(), "stream".into()),
        ],
        hazards: vec![Hazard::new(
            "out-of-order",
            "a fragment that arrives more than k positions late is composited behind farther ones, and counted; \
                   equal depths are composited in the order of arrival",
            Permits::NOTHING,
        )],
        ..Row::new(
            "storage",
            "stream_array",
            "k sorted entries per pixel; a full array composites the nearest for every new fragment",
            "B06 §3, §4.3; Callahan et al. 2005",
        )
    }
}
