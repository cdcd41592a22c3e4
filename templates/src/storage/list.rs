//! Storages of lists: nodes of one pool, linked per pixel.

use crate::vocabulary::{Access, Blend, Element, Fact, Parameter, Pass, Resource, Row, Soundness, Step};

pub(super) fn linked_list() -> Row {
    Row {
        template: Some(template!("storage/linked_list")),
        resources: vec![
            Resource::new("heads", Element::Word, "first node of the pixel's list, plus one; 0: empty")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("links", Element::Word, "the node after this one, plus one; 0: the last")
                .by("node", "fragments"),
            Resource::new("nodes", Element::Entry, "the fragment of this node").by("node", "fragments"),
            Resource::new("pool", Element::Word, "nodes taken so far").cleared(0),
        ],
        steps: vec![
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("heads", Access::Atomic)
                    .uses("links", Access::Plain)
                    .uses("nodes", Access::Plain)
                    .uses("pool", Access::Atomic),
            ),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("heads", Access::Read)
                    .uses("links", Access::Read)
                    .uses("nodes", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["overflow", "counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll],
        implies: vec![(Fact::Limited, Fact::BestSuffice)],
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new("storage", "linked_list", "a list per pixel through one pool of nodes", "Yang et al. 2010; K15 §2")
    }
}

/// A list that is in order at every instant.
pub(super) fn ordered_list() -> Row {
    Row {
        template: Some(template!("storage/ordered_list")),
        resources: vec![
            Resource::new("heads", Element::Word, "the pixel's best node, plus one; 0: none")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("links", Element::Word, "the next best node after this one, plus one; 0: the last")
                .by("node", "fragments"),
            Resource::new("nodes", Element::Entry, "the fragment of this node, written once").by("node", "fragments"),
            Resource::new("pool", Element::Word, "nodes taken so far").cleared(0),
        ],
        steps: vec![
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("heads", Access::Atomic)
                    .uses("links", Access::Atomic)
                    .uses("nodes", Access::Coherent)
                    .uses("pool", Access::Atomic),
            ),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("heads", Access::Read)
                    .uses("links", Access::Read)
                    .uses("nodes", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["overflow", "counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsBest, Fact::BestSuffice],
        // The list is in the order of its keys.
        implies: vec![(Fact::DepthKey, Fact::Sorted)],
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into()), ("sort".into(), "none".into())],
        parameters: vec![Parameter {
            name: "retries".into(),
            constant: "LINK_TRIES".into(),
            default: "4096".into(),
            range: (1, 1 << 24),
            summary: "tries to link a node before its fragment is given up and counted".into(),
        }],
        // Readers follow a link to words that its writer stored plainly.
        soundness: Soundness::Lock,
        ..Row::new(
            "storage",
            "ordered_list",
            "a list per pixel in order, linked by compare and exchange, read no further than k nodes",
            "Yu et al. 2012; K15 §2 (KB-LL)",
        )
    }
}
