//! Storages that count first, and give every pixel a region of exactly the size it needs.

use super::{OF_THE_K_BEST, reset_pass, resolve};
use crate::vocabulary::{Access, Capability, Element, Fact, Host, Parameter, Pass, Resource, Row, Step};

pub(super) fn exact_regions() -> Row {
    let mut resources = counted_resources("fragments of the pixel; the store pass counts them down again");
    resources
        .push(Resource::new("entries", Element::Entry, "the fragments, pixel after pixel").by("place", "fragments"));
    let mut steps = counted_steps("fragments");
    steps.push(Step::Pass(
        Pass::geometry("store", "store")
            .uses("counts", Access::Atomic)
            .uses("offsets", Access::Read)
            .uses("entries", Access::Plain),
    ));
    steps.push(resolve(&["offsets", "entries"]));
    Row {
        template: Some(template!("storage/exact_regions")),
        resources,
        steps,
        calls: vec!["overflow", "counters"],
        offers: vec![Fact::OwnAtomics, Fact::KeepsAll, Fact::Counted, Fact::Indexed, Fact::LosesWhole],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new(
            "storage",
            "exact_regions",
            "count, prefix sum, store: a region of exactly its size per pixel",
            "Vasilakis & Fudos 2012 (S-buffer); K15 §4.2",
        )
    }
}

/// Regions of min(f, k): fragments that all find room need no lock.
pub(super) fn bounded_regions() -> Row {
    let store = Pass::geometry("store", "store_reserving")
        .borrows("array", "max_array")
        .borrows("heap", "max_heap")
        .uses("counts", Access::Atomic)
        .uses("offsets", Access::Read)
        .uses_rechecked("region_keys")
        .uses("region_entries", Access::Coherent);
    let mut steps = counted_steps("kept");
    steps.push(Step::Pass(
        reset_pass().uses("counts", Access::Plain).uses("offsets", Access::Read).uses("region_keys", Access::Plain),
    ));
    steps.push(Step::Pass(store));
    steps.push(resolve(&["counts", "offsets", "region_keys", "region_entries"]));
    let mut resources = counted_resources("fragments of the pixel, then those to come; of crowded pixels those kept");
    resources.push(
        Resource::new("region_keys", Element::Word, "keys, pixel after pixel; of a crowded pixel the worst first")
            .by("place", "kept"),
    );
    resources.push(
        Resource::new("region_entries", Element::Beside, "what the fragments carry beside their keys")
            .by("place", "kept"),
    );
    Row {
        template: Some(template!("storage/bounded_regions")),
        resources,
        steps,
        calls: vec!["overflow", "counters"],
        offers: [OF_THE_K_BEST.as_slice(), &[Fact::Counted]].concat(),
        requires: vec![Fact::Critical],
        needs: vec![Capability::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        parameters: vec![Parameter::number(
            "array",
            "ARRAY_MOST",
            "16",
            (0, 1024),
            "the greatest k for which a crowded pixel keeps an array; beyond it keeps a heap",
        )],
        ..Row::new(
            "storage",
            "bounded_regions",
            "count, prefix sum, store: a region of min(f, k) per pixel, the worst first where f > k",
            "K15 §4.1, Alg. 3, mended",
        )
    }
}

/// What counting first keeps, whatever is stored afterwards.
fn counted_resources(counts: &'static str) -> Vec<Resource> {
    vec![
        Resource::new("counts", Element::Word, counts).by("pixel", "pixels").cleared(0),
        Resource::new("offsets", Element::Word, "where the pixel's region begins; one more for the end of the last")
            .by("pixel", "pixels + 1"),
        Resource::new("block_sums", Element::Word, "fragments before each block of 1024 pixels")
            .by("block", "ceil_div(pixels, 1024)"),
    ]
}

/// A pass that counts, a prefix sum over what every pixel needs, and room for all of it: the host sets `symbol`.
fn counted_steps(symbol: &str) -> Vec<Step> {
    let scan = |anchor: &str, groups: &'static str| Pass::compute(anchor, anchor, groups, "1");
    vec![
        Step::Pass(Pass::geometry("count", "count").uses("counts", Access::Atomic)),
        Step::Pass(
            scan("scan_blocks", "ceil_div(pixels, 1024)")
                .uses("counts", Access::Read)
                .uses("offsets", Access::Plain)
                .uses("block_sums", Access::Plain),
        ),
        Step::Pass(scan("scan_sums", "1").uses("offsets", Access::Plain).uses("block_sums", Access::Plain)),
        Step::Pass(
            scan("scan_add", "ceil_div(pixels, 1024)").uses("offsets", Access::Plain).uses("block_sums", Access::Read),
        ),
        Step::Host(Host::new("allocate").reads_word("offsets", "pixels").sets(symbol)),
    ]
}
