//! Axis `counters`: what is counted while the passes run.

use crate::vocabulary::{Access, Element, Fact, Resource, Row, Template, Use};

/// The counters in the order of their words: name, whether it counts a loss, meaning. `shared/counter_names.wgsl` has the
/// same order.
pub const COUNTERS: [(&str, bool, &str); 14] = [
    (
        "generated",
        false,
        "fragments that reached a geometry pass's last stage, met the constraints and lay behind nothing opaque",
    ),
    ("culled", false, "fragments turned away by the cull"),
    ("displaced", true, "fragments rejected or replaced because better ones were there"),
    ("pool_exhausted", true, "fragments that found no room in the storage"),
    ("spin_exhausted", true, "fragments given up because the lock, a slot or a link was not free in time"),
    ("layers_exceeded", true, "kept fragments beyond what the resolve pass can hold; the farthest are left out"),
    ("equal_keys", true, "fragments dropped because one with an equal key was kept"),
    ("emitted", false, "fragments that a stream composited while it was filled; those at its end are not counted"),
    (
        "out_of_order",
        false,
        "fragments of those that came after one behind them had been composited; counted as losses are",
    ),
    ("pages_leaked", false, "pages taken from a pool by a fragment that found room in another's"),
    (
        "unsettled",
        true,
        "fragments that still changed something in the last round of a loop: entries may be lost or double",
    ),
    ("samples_exhausted", true, "fragments that came when every sample of their pixel had one"),
    ("occluded", false, "fragments that met the constraints, and were turned away behind something opaque"),
    (
        "partly_covered",
        false,
        "fragments of routing that cover some samples of their pixel: it may lose fragments there or store them twice; \
         counted as losses are",
    ),
];

pub(crate) fn rows() -> Vec<Row> {
    vec![
        counting("losses", "losses only: memory is touched when a fragment is lost", template!("counters/losses")),
        Row {
            offers: vec![Fact::CountsEvents],
            ..counting("all", "everything, for statistics: every fragment pays for it", template!("counters/all"))
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
                .cleared(0),
        ],
        uses: vec![Use::new("counters", Access::Atomic)],
        ..Row::new("counters", key, summary, "")
    }
}
