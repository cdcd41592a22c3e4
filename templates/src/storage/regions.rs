//! Storages that count fragments first and then allocate a region of exactly the required size per pixel.

use super::parts::{REPLACES_WORST, reset_pass, resolve};
use crate::vocabulary::{Access, Capability, Element, Feature, Host, Parameter, Pass, Resource, Row, Step};

pub(super) fn exact_regions() -> Row {
    let mut resources = counted_resources("fragments of the pixel; the store pass decrements them");
    resources.push(Resource::new("entries", Element::Entry, "the fragments, by pixel").by("slot", "fragments"));
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
        provides: vec![
            Capability::LockFree,
            Capability::KeepsAll,
            Capability::Counted,
            Capability::Indexed,
            Capability::ReportsWholeFragments,
        ],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "slot_counter".into())],
        ..Row::new(
            "storage",
            "exact_regions",
            "count, prefix sum, store: a region of exactly the required size per pixel",
            "Vasilakis & Fudos 2012 (S-buffer); K15 §4.2",
        )
    }
}

/// Returns the row of regions of min(f, k) slots: pixels with f <= k need no lock.
pub(super) fn bounded_regions() -> Row {
    let store = Pass::geometry("store", "store_reserving")
        .delegates_to("array", "max_array")
        .delegates_to("heap", "max_heap")
        .uses("counts", Access::Atomic)
        .uses("offsets", Access::Read)
        .uses("region_keys", Access::Hinted)
        .uses("region_entries", Access::Coherent);
    let mut steps = counted_steps("kept");
    steps.push(Step::Pass(
        reset_pass().uses("counts", Access::Plain).uses("offsets", Access::Read).uses("region_keys", Access::Plain),
    ));
    steps.push(Step::Pass(store));
    steps.push(resolve(&["counts", "offsets", "region_keys", "region_entries"]));
    let mut resources = counted_resources("fragments of the pixel, then those not stored yet; if f > k, those kept");
    resources.push(
        Resource::new("region_keys", Element::Word, "keys, by pixel; if f > k, the worst first").by("slot", "kept"),
    );
    resources
        .push(Resource::new("region_entries", Element::Value, "the value words of the fragments").by("slot", "kept"));
    Row {
        template: Some(template!("storage/bounded_regions")),
        resources,
        steps,
        calls: vec!["allocation", "overflow", "counters"],
        provides: [REPLACES_WORST.as_slice(), &[Capability::Counted, Capability::KPerPixel]].concat(),
        requires: vec![Capability::MutualExclusion],
        needs: vec![Feature::FragmentAtomics],
        defaults: vec![("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())],
        parameters: vec![Parameter::number(
            "array",
            "ARRAY_MOST",
            "16",
            (0, 1024),
            "the greatest k for which a pixel with f > k has an array; for a greater k it has a heap",
        )],
        ..Row::new(
            "storage",
            "bounded_regions",
            "count, prefix sum, store: a region of min(f, k) slots per pixel, the worst first if f > k",
            "K15 §4.1, Alg. 3, corrected",
        )
    }
}

/// Returns the resources of the counting passes.
fn counted_resources(counts: &'static str) -> Vec<Resource> {
    vec![
        Resource::new("counts", Element::Word, counts).by("pixel", "pixels").cleared(0),
        Resource::new(
            "offsets",
            Element::Word,
            "the first slot of the pixel's region; one more for the end of the last region",
        )
        .by("pixel", "pixels + 1"),
        Resource::new("block_sums", Element::Word, "fragments before each block of 1024 pixels")
            .by("block", "ceil_div(pixels, 1024)"),
    ]
}

/// Returns the counting pass, the prefix sum over region sizes, and the host step that sets `symbol` to their total.
fn counted_steps(symbol: &str) -> Vec<Step> {
    let scan = |name: &str, groups: &'static str| Pass::compute(name, name, groups, "1");
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
