//! Storages of linked lists per pixel, whose nodes are in one pool.

use super::parts::resolve;
use crate::vocabulary::{Access, Capability, Element, Feature, Parameter, Pass, Resource, Row, Soundness, Step};

pub(super) fn linked_list() -> Row {
    let store =
        |pass: Pass| pass.uses("heads", Access::Atomic).uses("links", Access::Plain).uses("nodes", Access::Plain);
    Row {
        template: Some(template!("storage/linked_list")),
        resources: resources([
            "the first node of the pixel's list, plus one; 0: empty",
            "the node after this one, plus one; 0: the last",
            "the fragment of this node",
        ]),
        provides: vec![Capability::LockFree, Capability::KeepsAll, Capability::ReportsWholeFragments],
        implies: vec![("limited".into(), Capability::AcceptsKBestOnly)],
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

/// Returns the row of a list that is sorted at every instant.
pub(super) fn ordered_list() -> Row {
    // A link that is read may be old: the compare-exchange then fails. The link of a node that is not in the list yet is the
    // fragment's own, and a fence precedes the exchange that inserts it.
    let store =
        |pass: Pass| pass.uses("heads", Access::Hinted).uses("links", Access::Hinted).uses("nodes", Access::Coherent);
    Row {
        template: Some(template!("storage/ordered_list")),
        resources: resources([
            "the pixel's best node, plus one; 0: none",
            "the next best node after this one, plus one; 0: the last",
            "the fragment of this node, written once",
        ]),
        provides: vec![
            Capability::LockFree,
            Capability::KeepsBest,
            Capability::KeepsEqualKeys,
            Capability::AcceptsKBestOnly,
            Capability::AllocatesKBestOnly,
            Capability::ReportsWholeFragments,
        ],
        // The list is sorted by key.
        implies: vec![("depth_key".into(), Capability::Sorted)],
        defaults: vec![("sync".into(), "slot_counter".into()), ("sort".into(), "none".into())],
        parameters: vec![Parameter::retry_limit(
            "retries",
            "LINK_TRIES",
            "4096",
            (1, 1 << 24),
            "tries to link a node before its fragment times out and is counted",
        )],
        // Readers follow an atomic link to words that its writer stored with plain stores.
        soundness: Soundness::Lock,
        ..list(
            store,
            Row::new(
                "storage",
                "ordered_list",
                "a sorted list per pixel, linked by compare-exchange and read up to k nodes",
                "Yu et al. 2012; K15 §2 (KB-LL)",
            ),
        )
    }
}

/// Returns the resources of a list with these summaries of heads, links and nodes.
fn resources([heads, links, nodes]: [&'static str; 3]) -> Vec<Resource> {
    vec![
        Resource::new("heads", Element::Word, heads).by("pixel", "pixels").cleared(0),
        Resource::new("links", Element::Word, links).by("node", "fragments"),
        Resource::new("nodes", Element::Entry, nodes).by("node", "fragments"),
        Resource::new("pool", Element::Word, "nodes allocated so far").cleared(0),
    ]
}

/// Adds what lists share to a row; `store` declares how fragments access links and nodes.
fn list(store: impl Fn(Pass) -> Pass, row: Row) -> Row {
    let pass = store(Pass::geometry("store", "store"));
    Row {
        steps: vec![Step::Pass(pass.uses("pool", Access::Atomic)), resolve(&["heads", "links", "nodes"])],
        calls: vec!["overflow", "counters"],
        needs: vec![Feature::FragmentAtomics],
        ..row
    }
}
