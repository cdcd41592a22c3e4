//! A storage that writers race in, and notice when they have.

use super::{array_resources, reset, resolve};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{Access, Capability, Condition, Fact, Hazard, Parameter, Pass, Permits, Row, Step};

/// The sorted array with a checksum in every entry.
pub(super) fn checked_array() -> Row {
    Row {
        template: Some(template!("storage/checked_array")),
        resources: array_resources("keys in ascending order, each with a checksum of its entry; EMPTY past the last"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic).uses("entries", Access::Atomic)),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::KeepsBest, Fact::Indexed, Fact::SurvivesRaces],
        conditions: vec![
            depth_key(),
            Condition::new(
                "payload_words <= 2",
                "at most one word beside depth in the payload",
                "leave depth and one attribute of one word, such as `color: rgba8`, in the fragment",
            ),
            limited(),
        ],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into()), ("sort".into(), "insertion".into())],
        parameters: vec![Parameter::number(
            "retries",
            "REPAIRS",
            "4",
            (0, 64),
            "times that a fragment which was written over tries again",
        )],
        hazards: vec![
            Hazard::new(
                "equal-fragments",
                "of fragments with the same words, or of one key with `ties: unordered`, one is kept; the others \
                       are counted",
                Permits::ONE_OF_EQUAL_FRAGMENTS,
            ),
            Hazard::new(
                "lost-update",
                "a fragment is written over after its last look at the slots, unseen and uncounted",
                Permits::LOST,
            )
            .unless(Fact::Critical),
            Hazard::new(
                "given-up",
                "a fragment that is written over every time it looks is given up after its last try, and counted",
                Permits::GIVES_UP,
            )
            .unless(Fact::Critical),
            Hazard::new(
                "torn",
                "a slot of two fragments' words passes the check, one time in four that there is one",
                Permits::TORN,
            )
            .unless(Fact::Critical),
            Hazard::new(
                "stale",
                "a key is seen before what stands beside it, and what stood there before the frame passes the check",
                Permits::STALE,
            )
            .unless(Fact::Critical),
            Hazard::new(
                "counted-twice",
                "a fragment that races displaced more than once is counted each time",
                Permits::COUNTED_TWICE,
            )
            .unless(Fact::Critical),
        ],
        ..Row::new(
            "storage",
            "checked_array",
            "k entries per pixel in order, each with a checksum; what races broke is dropped and written again",
            "after Zhang 2014, internals ours; K15 §2 (KB-MHA)",
        )
    }
}
