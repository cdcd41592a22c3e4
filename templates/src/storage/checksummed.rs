//! A storage whose fragments race, and detect and repair most races.

use super::parts::{array_resources, reset, resolve};
use crate::conditions::{depth_key, limited};
use crate::vocabulary::{Access, Capability, Condition, Feature, Hazard, Parameter, Pass, Permits, Row, Step};

/// Returns the row of the sorted array with a checksum in every entry.
pub(super) fn checksummed_array() -> Row {
    Row {
        template: Some(template!("storage/checksummed_array")),
        former_key: Some("checked_array"),
        resources: array_resources("keys in ascending order, each with a checksum of its entry; EMPTY past the last"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic).uses("entries", Access::Atomic)),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        provides: vec![Capability::KeepsBest, Capability::Indexed, Capability::RaceTolerant, Capability::SlotsPerPixel],
        conditions: vec![
            depth_key(),
            Condition::new(
                "payload_words <= 2",
                "at most one word in the payload besides depth",
                "keep only depth and one attribute of one word, such as `color: rgba8`, in the fragment",
            ),
            limited(),
        ],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into()), ("sort".into(), "insertion".into())],
        parameters: vec![Parameter::number(
            "retries",
            "REPAIRS",
            "4",
            (0, 64),
            "retries of a fragment that another overwrote",
        )],
        hazards: vec![
            Hazard::new(
                "equal-fragments",
                "of fragments with equal words, or equal keys if `ties: unordered`, one is kept; others are counted",
                Permits::ONE_OF_EQUAL_FRAGMENTS,
            ),
            Hazard::new(
                "lost-update",
                "a fragment is overwritten after its last check of the slots, undetected and uncounted",
                Permits::LOST,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new(
                "timed-out",
                "a fragment that is overwritten before every check times out after its last retry, and is counted",
                Permits::TIMED_OUT,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new(
                "torn",
                "a slot with words of two fragments passes the check, in one of four cases",
                Permits::TORN,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new(
                "stale",
                "a key is visible before its value words, and the words from before the frame pass the check",
                Permits::STALE,
            )
            .unless(Capability::MutualExclusion),
            Hazard::new(
                "counted-twice",
                "a fragment that races displace several times is counted each time",
                Permits::COUNTED_TWICE,
            )
            .unless(Capability::MutualExclusion),
        ],
        ..Row::new(
            "storage",
            "checksummed_array",
            "k sorted entries per pixel, each with a checksum; entries that races broke are dropped and stored again",
            "after Zhang 2014, internals ours; K15 §2 (KB-MHA)",
        )
    }
}
