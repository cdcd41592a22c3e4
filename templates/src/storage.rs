//! Axis `storage`: where the fragments of a pixel are kept. Each row is what a plan starts from: memory and passes.

mod checked;
mod fixed_function;
mod list;
mod lists;
mod minima;
mod ranges;
mod regions;
mod repeated;
mod stream;
mod worst_first;

use crate::vocabulary::{Access, Blend, Element, Fact, Hazard, Pass, Resource, Row, Step};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        list::linked_list(),
        regions::exact_regions(),
        fixed_array(),
        sorted_array(),
        worst_first::max_array(),
        worst_first::max_heap(),
        minima::cascade(),
        minima::distinct_cascade(),
        minima::wide_cascade(),
        worst_first::revised_array(),
        list::ordered_list(),
        ranges::depth_ranges(),
        regions::bounded_regions(),
        lists::paged_list(),
        lists::bucket_lists(),
        stream::stream_array(),
        checked::checked_array(),
        repeated::repeated_array(),
        fixed_function::depth_tested(),
        fixed_function::stencil_routed(),
    ]
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
        offers: vec![
            Fact::KeepsBest,
            Fact::BestSuffice,
            Fact::BoundAnyInstant,
            Fact::DisplacesInTurn,
            Fact::CanReplace,
            Fact::Indexed,
            Fact::SurvivesRaces,
            Fact::KeepsArrival,
            Fact::LosesWhole,
        ],
        // Entries are in the order of their keys.
        implies: vec![(Fact::DepthKey, Fact::Sorted), (Fact::DepthKey, Fact::OrderedSlots)],
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
                name: "stale".into(),
                what: "a key is seen before what stands beside it, and moves on with what the slot held before".into(),
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
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::Indexed, Fact::LosesWhole],
        implies: vec![(Fact::Limited, Fact::BestSuffice)],
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
