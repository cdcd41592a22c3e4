//! A storage that fragments pass through: what leaves it is composited in order.

use super::{array_resources, reset};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{Access, Blend, Capability, Element, Fact, Hazard, Pass, Permits, Resource, Row, Step};

/// The k nearest of those to come; the nearest of all leaves for every one that comes.
pub(super) fn stream_array() -> Row {
    let mut resources = array_resources("keys in ascending order; EMPTY past the last");
    resources.push(
        Resource::new("colors", Element::Word, "the premultiplied colour of what has left, as floats")
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
        offers: vec![Fact::Streams, Fact::Indexed, Fact::Sorted],
        requires: vec![
            Fact::Critical,
            Fact::ValuesPairs,
            // What leaves is composited for the whole pixel.
            Fact::OneSample,
        ],
        conditions: vec![depth_key(), limited()],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "spin_lock".into()),
            ("sort".into(), "none".into()),
            ("resolve".into(), "stream".into()),
        ],
        hazards: vec![Hazard::new(
            "out-of-order",
            "a fragment that comes more than k places late is composited behind those it lies before, and \
                   counted; equal depths are composited in the order of arrival",
            Permits::NOTHING,
        )],
        ..Row::new(
            "storage",
            "stream_array",
            "k entries per pixel in order, the nearest composited whenever another comes",
            "B06 §3, §4.3; Callahan et al. 2005",
        )
    }
}
