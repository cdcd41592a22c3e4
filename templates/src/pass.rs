//! Axis `pass`: skeletons. Each holds the entry points of a pass and the order in which the other axes are called.

use crate::vocabulary::{Row, Template};

pub(crate) fn rows() -> Vec<Row> {
    let store = ["addressing", "storage", "sync", "cull", "overflow", "counters"];
    vec![
        row("geometry", "the vertex stage of every geometry pass", template!("pass/geometry"), vec![]),
        row("fullscreen", "the vertex stage of every fullscreen pass", template!("pass/fullscreen"), vec![]),
        row(
            "reset",
            "brings every pixel's storage to its empty state",
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
            "stores the scene's fragments, without the lock those that have a place of their own",
            template!("pass/store_reserving"),
            &store,
        ),
        drawn(
            "store_reserving_ordered",
            "stores the scene's fragments, outside an interlock those that have a place of their own",
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
            "stores the scene's fragments once more in every round of a loop",
            template!("pass/store_again"),
            &["addressing", "storage", "sync", "counters"],
        ),
        row("route", "sets the stencil of one sample of every pixel", template!("pass/route"), vec![]),
        drawn(
            "store_targets",
            "stores the scene's fragments in targets, by tests that are fixed function",
            template!("pass/store_targets"),
            &["counters"],
        ),
        drawn(
            "store_routed",
            "stores the scene's fragments in targets, and counts those that cover their pixel in part",
            template!("pass/store_routed"),
            &["counters"],
        ),
        row(
            "resolve",
            "makes one colour of each pixel's fragments",
            template!("pass/resolve"),
            vec!["addressing", "storage", "overflow", "samples", "sort", "resolve"],
        ),
        row(
            "resolve_selected",
            "chooses the k best of each pixel's fragments and makes one colour of them",
            template!("pass/resolve_selected"),
            vec!["addressing", "storage", "overflow", "samples", "sort", "resolve"],
        ),
        row(
            "resolve_stream",
            "finishes the stream of each pixel's fragments",
            template!("pass/resolve_stream"),
            vec!["addressing", "storage", "overflow", "resolve"],
        ),
        drawn(
            "survey",
            "draws the scene ahead of the store pass, for a storage that must know what will come",
            template!("pass/survey"),
            &["addressing", "storage"],
        ),
        drawn(
            "measure",
            "draws the scene ahead of the store pass, for the range of each pixel's keys",
            template!("pass/measure"),
            &["addressing", "cull"],
        ),
        drawn(
            "occupy",
            "draws the scene ahead of the store pass, for where in their range each pixel's keys lie",
            template!("pass/occupy"),
            &["addressing", "cull"],
        ),
        row(
            "narrow",
            "narrows the range of each pixel's keys to those that may stay",
            template!("pass/narrow"),
            vec!["addressing", "cull"],
        ),
        row(
            "limit",
            "writes the depth beyond which each pixel's fragments are turned away",
            template!("pass/limit"),
            vec!["addressing", "cull"],
        ),
        drawn(
            "settle",
            "draws the scene again for what a storage could not settle in one pass",
            template!("pass/settle"),
            &["addressing", "storage"],
        ),
    ]
}

/// The axes that `shared/prologue.wgsl` calls. Every pass over the scene begins with it, so an axis that is asked there too
/// is added here and in that file, and in no skeleton.
const PROLOGUE: [&str; 1] = ["opaque"];

/// A pass over the scene.
fn drawn(key: &str, summary: &'static str, template: Template, calls: &[&'static str]) -> Row {
    row(key, summary, template, PROLOGUE.iter().chain(calls).copied().collect())
}

fn row(key: &str, summary: &'static str, template: Template, calls: Vec<&'static str>) -> Row {
    Row { template: Some(template), calls, ..Row::new("pass", key, summary, "") }
}
