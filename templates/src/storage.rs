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

use crate::conditions::keeps_one;
use crate::vocabulary::{Access, Blend, Capability, Element, Fact, Hazard, Pass, Permits, Resource, Row, Step};

pub(crate) use ranges::DEPTH_RANGE;

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
        single(),
    ]
}

fn single() -> Row {
    let entries = Resource::new("entries", Element::Entry, "the pixel's best fragment; all ones: none");
    Row {
        template: Some(template!("storage/single")),
        resources: vec![entries.by("pixel", "pixels").cleared(u32::MAX)],
        steps: vec![
            Step::Pass(Pass::geometry("store", "store").uses("entries", Access::Atomic)),
            resolve(&["entries"]),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::KeepsBest, Fact::BestSuffice, Fact::BoundAnyInstant, Fact::LosesWhole, Fact::Sorted],
        requires: vec![Fact::Critical, Fact::OneSample],
        conditions: vec![keeps_one()],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![
            ("sync".into(), "spin_lock".into()),
            ("cull".into(), "early".into()),
            ("sort".into(), "none".into()),
        ],
        ..Row::new(
            "storage",
            "single",
            "the best fragment of a pixel: any criterion, a payload of any size",
            "K15 §4.3",
        )
    }
}

fn sorted_array() -> Row {
    Row {
        template: Some(template!("storage/sorted_array")),
        resources: array_resources("keys in ascending order; EMPTY past the last"),
        steps: vec![
            reset(&["keys"]),
            Step::Pass(Pass::geometry("store", "store").uses("keys", Access::Atomic).uses("entries", Access::Atomic)),
            resolve(&["keys", "entries"]),
        ],
        calls: vec!["overflow"],
        offers: [OF_THE_K_BEST.as_slice(), &[Fact::SurvivesRaces, Fact::KeepsArrival]].concat(),
        // Entries are in the order of their keys.
        implies: vec![("depth_key".into(), Fact::Sorted), ("depth_key".into(), Fact::OrderedSlots)],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "none".into()), ("sort".into(), "none".into())],
        hazards: vec![
            Hazard::new(
                "lost-update",
                "two fragments read the same entry and the later store wins: one is lost, unseen and uncounted",
                Permits::LOST,
            )
            .unless(Fact::Critical),
            Hazard::new(
                "duplicate",
                "an entry moved by one fragment while another moves it too stands in two slots",
                Permits::DUPLICATE,
            )
            .unless(Fact::Critical),
            Hazard::new("torn", "key and payload of a slot come from two fragments", Permits::TORN)
                .unless(Fact::Critical),
            Hazard::new(
                "stale",
                "a key is seen before what stands beside it, and moves on with what the slot held before",
                Permits::STALE,
            )
            .unless(Fact::Critical),
            Hazard::new("unsorted", "the entries of a pixel are not in the order of their keys", Permits::UNSORTED)
                .unless(Fact::Critical),
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
            resolve(&["counts", "entries"]),
        ],
        calls: vec!["overflow"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::Indexed, Fact::LosesWhole],
        implies: vec![("limited".into(), Fact::BestSuffice)],
        needs: vec![Capability::FragmentAtomics],
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

/// What arrays of the k best offer, whose worst entry gives way inside a critical section.
const OF_THE_K_BEST: [Fact; 7] = [
    Fact::KeepsBest,
    Fact::BestSuffice,
    Fact::BoundAnyInstant,
    Fact::DisplacesInTurn,
    Fact::CanReplace,
    Fact::Indexed,
    Fact::LosesWhole,
];

/// The pass that empties every pixel, by writing these.
fn reset(resources: &[&str]) -> Step {
    Step::Pass(resources.iter().fold(reset_pass(), |pass, resource| pass.uses(resource, Access::Plain)))
}

/// The pass that makes a colour of every pixel, by reading these.
fn resolve(resources: &[&str]) -> Step {
    let pass = Pass::fullscreen("resolve", "resolve").target("output", Blend::Over);
    Step::Pass(resources.iter().fold(pass, |pass, resource| pass.uses(resource, Access::Read)))
}

fn reset_pass() -> Pass {
    Pass::compute("reset", "reset", "ceil_div(width, 8)", "ceil_div(height, 8)")
}
