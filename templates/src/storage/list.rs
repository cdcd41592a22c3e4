//! Storages of lists: nodes of one pool, linked per pixel.

use super::resolve;
use crate::vocabulary::{Access, Capability, Element, Fact, Parameter, Pass, Resource, Row, Soundness, Step};

pub(super) fn linked_list() -> Row {
    let store = |pass: Pass| pass.uses("links", Access::Plain).uses("nodes", Access::Plain);
    Row {
        template: Some(template!("storage/linked_list")),
        resources: resources([
            "first node of the pixel's list, plus one; 0: empty",
            "the node after this one, plus one; 0: the last",
            "the fragment of this node",
        ]),
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::LosesWhole],
        implies: vec![("limited".into(), Fact::BestSuffice)],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..list(
            store,
            Row::new(
                "storage",
                "linked_list",
                "a list per pixel through one pool of nodes",
                "Yang et al. 2010; K15 §2",
            ),
        )
    }
}

/// A list that is in order at every instant.
pub(super) fn ordered_list() -> Row {
    let store = |pass: Pass| pass.uses("links", Access::Atomic).uses("nodes", Access::Coherent);
    Row {
        template: Some(template!("storage/ordered_list")),
        resources: resources([
            "the pixel's best node, plus one; 0: none",
            "the next best node after this one, plus one; 0: the last",
            "the fragment of this node, written once",
        ]),
        offers: vec![Fact::OwnAtomics, Fact::KeepsBest, Fact::BestSuffice, Fact::SparesRoom, Fact::LosesWhole],
        // The list is in the order of its keys.
        implies: vec![("depth_key".into(), Fact::Sorted)],
        defaults: vec![("sync".into(), "slot_counter".into()), ("sort".into(), "none".into())],
        parameters: vec![Parameter::number(
            "retries",
            "LINK_TRIES",
            "4096",
            (1, 1 << 24),
            "tries to link a node before its fragment is given up and counted",
        )],
        // Readers follow a link to words that its writer stored plainly.
        soundness: Soundness::Lock,
        ..list(
            store,
            Row::new(
                "storage",
                "ordered_list",
                "a list per pixel in order, linked by compare and exchange, read no further than k nodes",
                "Yu et al. 2012; K15 §2 (KB-LL)",
            ),
        )
    }
}

/// What a list keeps in memory: what its heads, links and nodes are.
fn resources([heads, links, nodes]: [&'static str; 3]) -> Vec<Resource> {
    vec![
        Resource::new("heads", Element::Word, heads).by("pixel", "pixels").cleared(0),
        Resource::new("links", Element::Word, links).by("node", "fragments"),
        Resource::new("nodes", Element::Entry, nodes).by("node", "fragments"),
        Resource::new("pool", Element::Word, "nodes taken so far").cleared(0),
    ]
}

/// What lists share; `store` says how fragments touch links and nodes.
fn list(store: impl Fn(Pass) -> Pass, row: Row) -> Row {
    let touched = store(Pass::geometry("store", "store").uses("heads", Access::Atomic));
    Row {
        steps: vec![Step::Pass(touched.uses("pool", Access::Atomic)), resolve(&["heads", "links", "nodes"])],
        calls: vec!["overflow", "counters"],
        needs: vec![Capability::FragmentAtomics],
        ..row
    }
}
