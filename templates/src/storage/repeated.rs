//! A storage that is written again until nothing changes: races are repaired, not prevented.

use super::{array_resources, reset, resolve};
use crate::vocabulary::{Access, Capability, Element, Fact, Hazard, Pass, Permits, Repeat, Resource, Row, Step, Until};

pub(super) fn repeated_array() -> Row {
    let mut resources = array_resources("keys in no order, each once; EMPTY: no fragment");
    resources.push(Resource::new("changed", Element::Word, "not 0: this round has changed a slot"));
    let store = Pass::geometry("store", "store_again")
        .uses("keys", Access::Atomic)
        .uses("entries", Access::Atomic)
        .uses("changed", Access::Atomic);
    Row {
        template: Some(template!("storage/repeated_array")),
        resources,
        steps: vec![
            reset(&["keys"]),
            Step::Repeat(Repeat {
                body: vec![Step::Clear { resource: "changed".to_owned(), value: 0 }, Step::Pass(store)],
                until: Until::Zero("changed".to_owned()),
                at_most: "k + 1".into(),
            }),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["counters"],
        offers: vec![Fact::KeepsBest, Fact::SurvivesRaces],
        // Of two triangles that share an edge it keeps one: several samples would show cracks.
        requires: vec![Fact::Race, Fact::OneSample],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into())],
        hazards: hazards(),
        ..Row::new(
            "storage",
            "repeated_array",
            "k entries per pixel, written again by every pass until one changes nothing",
            "Liu et al. 2009; K15 §2 (KB-Multi)",
        )
    }
}

fn hazards() -> Vec<Hazard> {
    vec![
        Hazard::new(
            "equal-keys",
            "of fragments with equal keys one is kept, the last to write",
            Permits::ONE_OF_EQUAL_KEYS,
        ),
        Hazard::new(
            "torn-equal-keys",
            "what stands beside a key comes from several fragments of that key, where it is several words",
            Permits::TORN_EQUAL_KEYS,
        ),
        Hazard::new(
            "unsettled",
            "where the last of the k + 1 rounds still changes a slot, entries are lost, double or torn; the fragments that \
             changed one are counted",
            Permits::UNSETTLED,
        ),
        Hazard::new(
            "uncounted",
            "losses are counted in the first round alone, as if its fragments had not raced",
            Permits::UNCOUNTED,
        ),
    ]
}
