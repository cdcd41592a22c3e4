//! A storage that passes write again until nothing changes: races are repaired, not prevented.

use super::parts::{array_resources, reset, resolve};
use crate::vocabulary::{
    Access, Capability, Element, Feature, Hazard, Pass, Permits, Repeat, Resource, Row, Step, Until,
};

pub(super) fn multipass_array() -> Row {
    let mut resources = array_resources("distinct keys, unsorted; EMPTY: no fragment");
    resources.push(Resource::new("changed", Element::Word, "not 0: this iteration has changed a slot"));
    let store = Pass::geometry("store", "store_again")
        .uses("keys", Access::Atomic)
        .uses("entries", Access::Atomic)
        .uses("changed", Access::Atomic);
    Row {
        template: Some(template!("storage/multipass_array")),
        former_key: Some("repeated_array"),
        resources,
        steps: vec![
            reset(&["keys"]),
            Step::Repeat(Repeat::new(
                vec![Step::Clear { resource: "changed".to_owned(), value: 0 }, Step::Pass(store)],
                Until::WordIsZero("changed".to_owned()),
                "k + 1",
            )),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["counters"],
        provides: vec![Capability::KeepsBest, Capability::RaceTolerant, Capability::SlotsPerPixel],
        // It keeps one of two triangles that share an edge: several samples would show cracks.
        requires: vec![Capability::Unsynchronised, Capability::OneSample],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into())],
        hazards: hazards(),
        ..Row::new(
            "storage",
            "multipass_array",
            "k entries per pixel, written again by every pass until a pass changes nothing",
            "Liu et al. 2009; K15 §2 (KB-Multi)",
        )
    }
}

fn hazards() -> Vec<Hazard> {
    vec![
        Hazard::new(
            "equal-keys",
            "of fragments with equal keys only the last to write is kept",
            Permits::ONE_OF_EQUAL_KEYS,
        ),
        Hazard::new(
            "torn-equal-keys",
            "several value words of an entry may come from different fragments with its key",
            Permits::TORN_EQUAL_KEYS,
        ),
        Hazard::new(
            "not-converged",
            "if the last of the k + 1 iterations still changes a slot, entries are lost, duplicated or torn; the \
             fragments that changed one are counted",
            Permits::NOT_CONVERGED,
        ),
        Hazard::new(
            "uncounted",
            "losses are counted only in the first iteration, as if its fragments had not raced",
            Permits::UNCOUNTED,
        ),
    ]
}
