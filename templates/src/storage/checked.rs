//! A storage that writers race in, and notice when they have.

use super::{array_resources, reset_pass};
use crate::vocabulary::{Access, Blend, Fact, Hazard, Parameter, Pass, Row, Step, Takes};

/// The sorted array with a checksum in every entry.
pub(super) fn checked_array() -> Row {
    Row {
        template: Some(template!("storage/checked_array")),
        resources: array_resources("keys in ascending order, each with a checksum of its entry; EMPTY past the last"),
        steps: vec![
            Step::Pass(reset_pass().uses("keys", Access::Plain)),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic).uses("entries", Access::Atomic)),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("keys", Access::Read)
                    .uses("entries", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::KeepsBest, Fact::Indexed, Fact::SurvivesRaces],
        requires: vec![Fact::FragmentAtomics, Fact::DepthKey, Fact::OneWordBesideDepth, Fact::Limited],
        defaults: vec![("sync".into(), "none".into()), ("sort".into(), "insertion".into())],
        parameters: vec![Parameter {
            name: "retries".into(),
            constant: "REPAIRS".into(),
            takes: Takes::Number,
            default: "4".into(),
            range: (0, 64),
            summary: "times that a fragment which was written over tries again".into(),
        }],
        hazards: vec![
            Hazard {
                name: "equal-fragments".into(),
                what:
                    "of fragments with the same words, or of one key with `ties: unordered`, one is kept; the others \
                       are counted"
                        .into(),
                unless: None,
            },
            Hazard {
                name: "lost-update".into(),
                what: "a fragment is written over after its last look at the slots, unseen and uncounted".into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "given-up".into(),
                what: "a fragment that is written over every time it looks is given up after its last try, and counted"
                    .into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "torn".into(),
                what: "a slot of two fragments' words passes the check, one time in four that there is one".into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "stale".into(),
                what:
                    "a key is seen before what stands beside it, and what stood there before the frame passes the check"
                        .into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "counted-twice".into(),
                what: "a fragment that races displaced more than once is counted each time".into(),
                unless: Some(Fact::Critical),
            },
        ],
        ..Row::new(
            "storage",
            "checked_array",
            "k entries per pixel in order, each with a checksum; what races broke is dropped and written again",
            "after Zhang 2014, internals ours; K15 §2 (KB-MHA)",
        )
    }
}
