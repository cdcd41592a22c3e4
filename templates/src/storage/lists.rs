//! Storages of several lists or pages per pixel, which share one pool.

use super::parts::resolve;
use crate::conditions::depth_key;
use crate::vocabulary::{Access, Capability, Element, Feature, Hazard, Parameter, Pass, Permits, Resource, Row, Step};

/// Returns the row of lists of pages.
pub(super) fn paged_list() -> Row {
    let pages = "fragments / PAGE_ENTRIES";
    Row {
        template: Some(template!("storage/paged_list")),
        resources: vec![
            Resource::new("cursors", Element::Word, "one past the slot of the pixel's last fragment; 0: none")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("links", Element::Word, "the end of the page before this page of the pool").by("page", pages),
            Resource::new(
                "entries",
                Element::Entry,
                "the fragments by page; the first pages are reserved for the pixels",
            )
            .by("slot", "(pixels + fragments / PAGE_ENTRIES) * PAGE_ENTRIES"),
            Resource::new("pool", Element::Word, "pages allocated so far").cleared(0),
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
        provides: vec![Capability::LockFree, Capability::KeepsAll, Capability::ReportsWholeFragments],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        parameters: vec![
            Parameter::number(
                "page",
                "PAGE_ENTRIES",
                "4",
                (1, 256),
                "fragments per page; a power of two avoids integer divisions",
            ),
            Parameter::retry_limit(
                "retries",
                "PAGE_TRIES",
                "4096",
                (1, 1 << 24),
                "tries to move the cursor before a fragment times out and is counted",
            ),
        ],
        hazards: vec![Hazard::new(
            "leaked-page",
            "if several fragments of a pixel take a page concurrently, one page is used and the others are missing \
                   from the pool, which may overflow earlier; both are counted",
            Permits::NOTHING,
        )],
        ..Row::new(
            "storage",
            "paged_list",
            "a list of pages per pixel: the first is reserved, the others are from one pool",
            "after Crassin 2010",
        )
    }
}

/// Returns the row of one list per depth bucket of every pixel.
pub(super) fn bucket_lists() -> Row {
    let ends = "the pixel's range of keys: the nearest with its bits inverted, the farthest; 0: none";
    Row {
        template: Some(template!("storage/bucket_lists")),
        resources: vec![
            Resource::new("ranges", Element::Word, ends).by("end", "2").by("pixel", "pixels").cleared(0),
            Resource::new("heads", Element::Word, "the first node of the bucket's list, plus one; 0: empty")
                .by("bucket", "5")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("links", Element::Word, "the node after this one, plus one; 0: the last")
                .by("node", "fragments"),
            Resource::new("nodes", Element::Entry, "the fragment of this node").by("node", "fragments"),
            Resource::new("pool", Element::Word, "nodes allocated so far").cleared(0),
        ],
        steps: vec![
            Step::Pass(Pass::geometry("prepass", "prepass").uses("ranges", Access::Atomic)),
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
        provides: vec![Capability::LockFree, Capability::KeepsAll, Capability::ReportsWholeFragments],
        conditions: vec![depth_key()],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into()), ("sort".into(), "insertion".into())],
        ..Row::new(
            "storage",
            "bucket_lists",
            "a list per depth bucket of each pixel's range, with one pool of nodes",
            "Vasilakis & Fudos 2013 (D13 §3.1.4, BUN-LL)",
        )
    }
}
