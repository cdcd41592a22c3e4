//! Axis `pass`: skeletons. Each has the entry points of a pass and calls the contracts of the other axes in order.

use crate::vocabulary::{Row, Template};

pub(crate) fn rows() -> Vec<Row> {
    let store = ["addressing", "storage", "sync", "cull", "overflow", "counters"];
    vec![
        row("geometry", "the vertex stage of every geometry pass", template!("pass/geometry"), vec![]),
        row("fullscreen", "the vertex stage of every fullscreen pass", template!("pass/fullscreen"), vec![]),
        row(
            "reset",
            "resets every pixel's storage to its empty state",
            template!("pass/reset"),
            vec!["addressing", "storage"],
        ),
        drawn("count", "counts the fragments of each pixel", template!("pass/count"), &["addressing", "storage"]),
        row(
            "scan_blocks",
            "prefix sums inside blocks of 1024 pixels",
            template!("pass/scan_blocks"),
            vec!["addressing", "storage"],
        ),
        row("scan_sums", "prefix sum over the sums of the blocks", template!("pass/scan_sums"), vec!["addressing"]),
        row("scan_add", "adds each block's sum to its pixels", template!("pass/scan_add"), vec!["addressing"]),
        drawn("store", "stores the scene's fragments", template!("pass/store"), &store),
        drawn(
            "store_reserving",
            "stores the scene's fragments; those that reserve a slot do not take the lock",
            template!("pass/store_reserving"),
            &store,
        ),
        drawn(
            "store_reserving_ordered",
            "stores the scene's fragments; those that reserve a slot do so outside the interlock",
            template!("pass/store_reserving_ordered"),
            &["addressing", "storage", "cull", "overflow", "counters"],
        ),
        drawn(
            "store_ordered",
            "stores the scene's fragments inside an interlock",
            template!("pass/store_ordered"),
            &["addressing", "storage", "cull", "overflow", "counters"],
        ),
        drawn(
            "store_again",
            "stores the scene's fragments in every iteration of a loop",
            template!("pass/store_again"),
            &["addressing", "storage", "sync", "counters"],
        ),
        row("route", "sets the stencil of one sample of every pixel", template!("pass/route"), vec![]),
        drawn(
            "store_targets",
            "stores the scene's fragments in render targets, by fixed-function tests",
            template!("pass/store_targets"),
            &["counters"],
        ),
        drawn(
            "store_routed",
            "stores the scene's fragments in render targets, and counts those with partial coverage",
            template!("pass/store_routed"),
            &["counters"],
        ),
        row(
            "resolve",
            "computes one colour from each pixel's fragments",
            template!("pass/resolve"),
            vec!["addressing", "storage", "overflow", "samples", "sort", "resolve"],
        ),
        row(
            "resolve_image",
            "computes an image from each pixel's fragments",
            template!("pass/resolve_image"),
            vec!["addressing", "storage", "samples", "sort", "resolve"],
        ),
        row(
            "resolve_selected_image",
            "selects the k best of each pixel's fragments and computes an image from them",
            template!("pass/resolve_selected_image"),
            vec!["addressing", "storage", "samples", "sort", "resolve"],
        ),
        row(
            "resolve_selected",
            "selects the k best of each pixel's fragments and computes one colour from them",
            template!("pass/resolve_selected"),
            vec!["addressing", "storage", "overflow", "samples", "sort", "resolve"],
        ),
        drawn(
            "nearest_layer",
            "draws the scene before the first iteration of peeling, to find the nearest layer of each pixel",
            template!("pass/nearest_layer"),
            &["addressing"],
        ),
        drawn(
            "find_layer",
            "draws the scene in an iteration of peeling, to find the nearest layer that is left and to write its depth",
            template!("pass/find_layer"),
            &["addressing", "counters"],
        ),
        drawn(
            "find_in_layer",
            "draws the scene in an iteration of peeling, to find which fragments of a layer it stores",
            template!("pass/find_in_layer"),
            &["addressing"],
        ),
        row(
            "accumulate",
            "continues the effect of each pixel with the fragments that an iteration has stored",
            template!("pass/accumulate"),
            vec!["addressing", "storage", "peeling", "samples", "sort", "resolve"],
        ),
        row(
            "accumulate_slots",
            "continues the effect of each pixel with the fragments that an iteration has stored, slot by slot",
            template!("pass/accumulate_slots"),
            vec!["addressing", "storage", "peeling", "samples", "sort", "resolve"],
        ),
        row(
            "reached_depth",
            "writes the depth that all fragments reach which no iteration has stored",
            template!("pass/reached_depth"),
            vec!["addressing", "peeling"],
        ),
        row("boxes", "draws the boxes of objects, and writes nothing", template!("pass/boxes"), vec![]),
        row(
            "composite",
            "writes the colour after the last iteration",
            template!("pass/composite"),
            vec!["addressing", "peeling", "resolve", "overflow"],
        ),
        row(
            "resolve_stream",
            "finishes the stream of each pixel's fragments",
            template!("pass/resolve_stream"),
            vec!["addressing", "storage", "overflow", "resolve"],
        ),
        drawn(
            "prepass",
            "draws the scene before the store pass, for a storage that needs data on all fragments first",
            template!("pass/prepass"),
            &["addressing", "storage"],
        ),
        drawn(
            "key_range",
            "draws the scene before the store pass, to find the range of each pixel's keys",
            template!("pass/key_range"),
            &["addressing", "cull"],
        ),
        drawn(
            "occupancy_map",
            "draws the scene before the store pass, to mark the occupied parts of each pixel's key range",
            template!("pass/occupancy_map"),
            &["addressing", "cull"],
        ),
        drawn(
            "count_complexity",
            "draws the scene before any fragment is stored, to count the fragments of each pixel",
            template!("pass/count_complexity"),
            &["addressing", "allocation"],
        ),
        row(
            "build_histogram",
            "counts the pixels of each number of fragments",
            template!("pass/build_histogram"),
            vec!["addressing", "allocation"],
        ),
        row(
            "count_by_importance",
            "counts the pixels of each importance and each number of fragments",
            template!("pass/count_by_importance"),
            vec!["addressing", "allocation"],
        ),
        row(
            "occupancy_bound",
            "narrows the range of each pixel's keys to those that can be kept",
            template!("pass/occupancy_bound"),
            vec!["addressing", "cull"],
        ),
        drawn(
            "depth_prepass",
            "draws the scene before the store pass, to write the depth of each pixel's nearest fragment",
            template!("pass/depth_prepass"),
            &[],
        ),
        row(
            "limit",
            "writes the depth beyond which each pixel's fragments are rejected",
            template!("pass/limit"),
            vec!["addressing", "cull"],
        ),
        drawn(
            "refine",
            "draws the scene again, so that a storage can write further words of stored fragments",
            template!("pass/refine"),
            &["addressing", "storage"],
        ),
    ]
}

/// The axes that `shared/prologue.wgsl` calls. Every pass over the scene begins with it, so a further axis is added
/// here and in that file, and in no skeleton.
const PROLOGUE: [&str; 2] = ["opaque", "peeling"];

/// Makes the row of a pass over the scene.
fn drawn(key: &str, summary: &'static str, template: Template, calls: &[&'static str]) -> Row {
    row(key, summary, template, PROLOGUE.iter().chain(calls).copied().collect())
}

fn row(key: &str, summary: &'static str, template: Template, calls: Vec<&'static str>) -> Row {
    Row { template: Some(template), calls, ..Row::new("pass", key, summary, "") }
}
