//! Storages of several lists or pages per pixel, through one pool.

use super::resolve;
use crate::conditions::depth_key;
use crate::vocabulary::{Access, Capability, Element, Fact, Hazard, Parameter, Pass, Permits, Resource, Row, Step};

/// Lists whose links lead from page to page.
pub(super) fn paged_list() -> Row {
    let pages = "fragments / PAGE_ENTRIES";
    Row {
        template: Some(template!("storage/paged_list")),
        resources: vec![
            Resource::new("cursors", Element::Word, "the place after the pixel's last fragment; 0: it has none")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("links", Element::Word, "the end of the page before this one of the pool").by("page", pages),
            Resource::new("entries", Element::Entry, "the fragments, page after page; the first are the pixels' own")
                .by("place", "(pixels + fragments / PAGE_ENTRIES) * PAGE_ENTRIES"),
            Resource::new("pool", Element::Word, "pages taken so far").cleared(0),
        ],
        steps: vec![
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("cursors", Access::Atomic)
                    .uses("links", Access::Plain)
                    .uses("entries", Access::Plain)
                    .uses("pool", Access::Atomic),
            ),
            resolve(&["cursors", "links", "entries"]),
        ],
        calls: vec!["addressing", "overflow", "counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::LosesWhole],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        parameters: vec![
            Parameter::number(
                "page",
                "PAGE_ENTRIES",
                "4",
                (1, 256),
                "fragments of a page; powers of two are divided by without a division",
            ),
            Parameter::number(
                "retries",
                "PAGE_TRIES",
                "4096",
                (1, 1 << 24),
                "tries to move the cursor before a fragment is given up and counted",
            ),
        ],
        hazards: vec![Hazard::new(
            "leaked-page",
            "of pages that several fragments of a pixel take at once one is used: the others are missing from the \
                   pool, and fragments may find it empty that there was room for; both are counted",
            Permits::NOTHING,
        )],
        ..Row::new(
            "storage",
            "paged_list",
            "a list of pages per pixel, the first its own, the others through one pool",
            "after Crassin 2010",
        )
    }
}

/// A list per depth bucket of every pixel.
pub(super) fn bucket_lists() -> Row {
    let ends = "the pixel's range of keys: the nearest with its bits flipped, the farthest; 0: none";
    Row {
        template: Some(template!("storage/bucket_lists")),
        resources: vec![
            Resource::new("ranges", Element::Word, ends).by("end", "2").by("pixel", "pixels").cleared(0),
            Resource::new("heads", Element::Word, "first node of the bucket's list, plus one; 0: empty")
                .by("bucket", "5")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("links", Element::Word, "the node after this one, plus one; 0: the last")
                .by("node", "fragments"),
            Resource::new("nodes", Element::Entry, "the fragment of this node").by("node", "fragments"),
            Resource::new("pool", Element::Word, "nodes taken so far").cleared(0),
        ],
        steps: vec![
            Step::Pass(Pass::geometry("survey", "survey").uses("ranges", Access::Atomic)),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("ranges", Access::Read)
                    .uses("heads", Access::Atomic)
                    .uses("links", Access::Plain)
                    .uses("nodes", Access::Plain)
                    .uses("pool", Access::Atomic),
            ),
            resolve(&["ranges", "heads", "links", "nodes"]),
        ],
        calls: vec!["overflow", "counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::LosesWhole],
        conditions: vec![depth_key()],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into()), ("sort".into(), "insertion".into())],
        ..Row::new(
            "storage",
            "bucket_lists",
            "a list per depth bucket of each pixel's range, through one pool of nodes",
            "Vasilakis & Fudos 2013 (D13 §3.1.4, BUN-LL)",
        )
    }
}
