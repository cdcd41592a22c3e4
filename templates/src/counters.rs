//! Axis `counters`: what is counted while the passes run.

use crate::vocabulary::{Access, Capability, Element, Resource, Row, Template, Use};

/// What an event means for the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CounterKind {
    /// The image is as described.
    Event,
    /// A fragment is not kept, because the description limits how many a pixel keeps.
    Displaced,
    /// A fragment is missing from the image.
    Loss,
    /// No fragment need be missing, but the image may differ from the described one.
    Wrong,
}

impl CounterKind {
    /// Whether the image is not as described if an event was counted. Manifests and headers call it `is_loss`.
    pub fn makes_image_wrong(self) -> bool {
        matches!(self, CounterKind::Loss | CounterKind::Wrong)
    }
}

/// The counters in the order of their words: name, kind, meaning. `shared/counter_names.wgsl` has the same order.
pub const COUNTERS: [(&str, CounterKind, &str); 14] = [
    (
        "generated",
        CounterKind::Event,
        "fragments that a geometry pass shaded, that meet the constraints and that no opaque surface hides",
    ),
    ("culled", CounterKind::Event, "fragments that the cull rejected"),
    ("displaced", CounterKind::Displaced, "fragments rejected or evicted because better ones are kept"),
    ("pool_exhausted", CounterKind::Loss, "fragments that did not fit in the storage"),
    ("timed_out", CounterKind::Loss, "fragments that timed out waiting for the lock, a slot or a link"),
    (
        "layers_exceeded",
        CounterKind::Loss,
        "kept fragments beyond the limit of the resolve pass; the farthest are dropped",
    ),
    ("equal_keys", CounterKind::Loss, "fragments dropped because one with an equal key is kept"),
    ("emitted", CounterKind::Event, "fragments that a stream composited in the store pass, not in the resolve pass"),
    (
        "out_of_order",
        CounterKind::Wrong,
        "emitted fragments that arrived after one behind them had been composited: the image is wrong; counted where losses are",
    ),
    ("pages_leaked", CounterKind::Event, "pages that a fragment took from the pool and did not use"),
    (
        "not_converged",
        CounterKind::Loss,
        "fragments left when a loop reached its limit: with peeling they are missing from the image; otherwise entries may be lost or duplicated",
    ),
    ("samples_exhausted", CounterKind::Loss, "fragments that arrived when every sample of their pixel was taken"),
    ("occluded", CounterKind::Event, "fragments that meet the constraints and that an opaque surface hides"),
    (
        "partial_coverage",
        CounterKind::Wrong,
        "fragments of stencil routing with partial coverage: their pixels may lose fragments or store them twice; \
         counted where losses are",
    ),
];

pub(crate) fn rows() -> Vec<Row> {
    vec![
        counting(
            "losses",
            "losses only: no memory access unless a fragment is missing from the image",
            template!("counters/losses"),
        ),
        Row {
            provides: vec![Capability::CountsEvents],
            ..counting("all", "every event, for statistics: every fragment updates counters", template!("counters/all"))
        },
        Row { template: Some(template!("counters/none")), ..Row::new("counters", "none", "nothing", "") },
    ]
}

fn counting(key: &str, summary: &'static str, template: Template) -> Row {
    Row {
        template: Some(template),
        resources: vec![
            Resource::new("counters", Element::Word, "events of the frame, by counter")
                .by("counter", COUNTERS.len().to_string())
                .cleared(0)
                .over_iterations(),
        ],
        uses: vec![Use::new("counters", Access::Atomic)],
        ..Row::new("counters", key, summary, "")
    }
}
