//! Axis `storage`: where the fragments of a pixel are kept. Each row is what a plan starts from: memory and passes.

use crate::vocabulary::{Access, Blend, Element, Fact, Hazard, Host, Pass, Repeat, Resource, Row, Step, Until};

pub(crate) fn rows() -> Vec<Row> {
    vec![linked_list(), exact_regions(), fixed_array(), sorted_array(), max_array(), max_heap(), cascade()]
}

fn linked_list() -> Row {
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
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new("storage", "linked_list", "a list per pixel through one pool of nodes", "Yang et al. 2010; K15 §2")
    }
}

fn exact_regions() -> Row {
    let scan = |anchor: &str, groups: &'static str| Pass::compute(anchor, anchor, groups, "1");
    Row {
        template: Some(template!("storage/exact_regions")),
        resources: vec![
            Resource::new("counts", Element::Word, "fragments of the pixel; the store pass counts them down again")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new(
                "offsets",
                Element::Word,
                "where the pixel's region begins; one more for the end of the last",
            )
            .by("pixel", "pixels + 1"),
            Resource::new("block_sums", Element::Word, "fragments before each block of 1024 pixels")
                .by("block", "ceil_div(pixels, 1024)"),
            Resource::new("entries", Element::Entry, "the fragments, pixel after pixel").by("place", "fragments"),
        ],
        steps: vec![
            Step::Pass(Pass::geometry("count", "count").uses("counts", Access::Atomic)),
            Step::Pass(
                scan("scan_blocks", "ceil_div(pixels, 1024)")
                    .uses("counts", Access::Read)
                    .uses("offsets", Access::Plain)
                    .uses("block_sums", Access::Plain),
            ),
            Step::Pass(scan("scan_sums", "1").uses("offsets", Access::Plain).uses("block_sums", Access::Plain)),
            Step::Pass(
                scan("scan_add", "ceil_div(pixels, 1024)")
                    .uses("offsets", Access::Plain)
                    .uses("block_sums", Access::Read),
            ),
            Step::Host(Host {
                function: "allocate".to_owned(),
                reads: vec!["offsets[pixels]".to_owned()],
                sets: vec!["fragments".to_owned()],
            }),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses("counts", Access::Atomic)
                    .uses("offsets", Access::Read)
                    .uses("entries", Access::Plain),
            ),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("offsets", Access::Read)
                    .uses("entries", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["overflow", "counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::Counted, Fact::Indexed],
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new(
            "storage",
            "exact_regions",
            "count, prefix sum, store: a region of exactly its size per pixel",
            "Vasilakis & Fudos 2012 (S-buffer); K15 §4.2",
        )
    }
}

fn sorted_array() -> Row {
    Row {
        template: Some(template!("storage/sorted_array")),
        resources: array_resources("keys in ascending order; EMPTY past the last"),
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
        offers: vec![Fact::KeepsBest, Fact::BoundAnyInstant, Fact::CanReplace, Fact::Indexed, Fact::SurvivesRaces],
        // Entries are in the order of their keys.
        implies: vec![(Fact::DepthKey, Fact::Sorted)],
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into()), ("sort".into(), "none".into())],
        hazards: vec![
            Hazard {
                name: "lost-update".into(),
                what: "two fragments read the same entry and the later store wins: one is lost, unseen and uncounted"
                    .into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "duplicate".into(),
                what: "an entry moved by one fragment while another moves it too stands in two slots".into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "torn".into(),
                what: "key and payload of a slot come from two fragments".into(),
                unless: Some(Fact::Critical),
            },
            Hazard {
                name: "unsorted".into(),
                what: "the entries of a pixel are not in the order of their keys".into(),
                unless: Some(Fact::Critical),
            },
        ],
        ..Row::new(
            "storage",
            "sorted_array",
            "k entries per pixel, kept in order by insertion",
            "B06 §3; Bavoil et al. 2007",
        )
    }
}

fn max_array() -> Row {
    Row {
        template: Some(template!("storage/max_array")),
        ..worst_first(Row::new("storage", "max_array", "k entries per pixel, the worst at slot 0", "K15 §3.2"))
    }
}

fn max_heap() -> Row {
    Row {
        template: Some(template!("storage/max_heap")),
        ..worst_first(Row::new("storage", "max_heap", "k entries per pixel in a heap, the worst at slot 0", "K15 §3.2"))
    }
}

/// What storages share that keep the worst entry at slot 0 and are written inside a critical section.
fn worst_first(row: Row) -> Row {
    let mut resources = array_resources("slot 0 holds the worst kept key, EMPTY until k fragments are in");
    resources.push(Resource::new("filled", Element::Word, "fragments kept, at most k").by("pixel", "pixels"));
    Row {
        resources,
        steps: vec![
            Step::Pass(reset_pass().uses("keys", Access::Plain).uses("filled", Access::Plain)),
            Step::Pass(
                Pass::geometry("store", "store")
                    .uses_rechecked("keys")
                    .uses("entries", Access::Coherent)
                    .uses("filled", Access::Coherent),
            ),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("keys", Access::Read)
                    .uses("entries", Access::Read)
                    .uses("filled", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::KeepsBest, Fact::BoundAnyInstant, Fact::CanReplace, Fact::Indexed],
        requires: vec![Fact::FragmentAtomics, Fact::Critical],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        ..row
    }
}

fn fixed_array() -> Row {
    Row {
        template: Some(template!("storage/fixed_array")),
        resources: vec![
            Resource::new("counts", Element::Word, "fragments of the pixel, those included that found no slot")
                .by("pixel", "pixels")
                .cleared(0),
            Resource::new("entries", Element::Entry, "the fragments, in the order of arrival")
                .by("slot", "n")
                .by("pixel", "pixels"),
        ],
        steps: vec![
            Step::Pass(Pass::geometry("store", "store").uses("counts", Access::Atomic).uses("entries", Access::Plain)),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("counts", Access::Read)
                    .uses("entries", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::Indexed],
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new(
            "storage",
            "fixed_array",
            "n slots per pixel, filled by a counter",
            "Liu et al. 2010 (FreePipe); K15 §2",
        )
    }
}

fn cascade() -> Row {
    let mut resources = array_resources("the k least keys in ascending order, equal ones each; EMPTY past the last");
    resources.truncate(1);
    resources.push(
        Resource::new("tails", Element::Word, "what the fragments carry beside their keys, word by word")
            .by("slot", "k")
            .by("pixel", "pixels")
            .by("word", "beside_words"),
    );
    let settle = Pass::geometry("settle", "settle").uses("keys", Access::Read).uses("tails", Access::Atomic);
    Row {
        template: Some(template!("storage/cascade")),
        resources,
        steps: vec![
            Step::Pass(reset_pass().uses("keys", Access::Plain).uses("tails", Access::Plain)),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic)),
            Step::Repeat(Repeat {
                body: vec![Step::Pass(settle)],
                until: Until::Times("beside_words".into()),
                at_most: "beside_words".into(),
            }),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("keys", Access::Read)
                    .uses("tails", Access::Read)
                    .target("output", Blend::Over),
            ),
        ],
        calls: vec!["counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsBest, Fact::BoundAnyInstant],
        implies: vec![(Fact::DepthKey, Fact::Sorted)],
        requires: vec![Fact::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "slot_counter".into()),
            ("cull".into(), "early".into()),
            ("sort".into(), "none".into()),
        ],
        ..Row::new(
            "storage",
            "cascade",
            "k entries per pixel in order, settled word by word by cascades of atomic minima",
            "after Liu et al. 2010 (multidepth); K15 §2",
        )
    }
}

/// Keys apart from the rest: the early cull reads one atomic word, the critical section reads the others plainly.
fn array_resources(keys: &'static str) -> Vec<Resource> {
    vec![
        Resource::new("keys", Element::Word, keys).by("slot", "k").by("pixel", "pixels"),
        Resource::new("entries", Element::Beside, "what the fragments carry beside their keys")
            .by("slot", "k")
            .by("pixel", "pixels"),
    ]
}

fn reset_pass() -> Pass {
    Pass::compute("reset", "reset", "ceil_div(width, 8)", "ceil_div(height, 8)")
}
