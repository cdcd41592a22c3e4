//! Peeling by layers of equal depth: the store pass of an iteration finds the layers of the next.

use super::{CONTINUES, accumulated, edits, iterations, not_peeled};
use crate::conditions::{depth_key, keeps_all};
use crate::vocabulary::{
    Access, Capability, Definition, Edit, Element, Feature, Parameter, Pass, Resource, Row, Step, Use,
};

/// Repeats all passes of an A-buffer, each time with the fragments of the next depth.
pub(super) fn depth_layers() -> Row {
    let keys = |name: &str, summary: &'static str| {
        Resource::new(name, Element::Word, summary).by("pixel", "pixels").cleared(u32::MAX).over_iterations()
    };
    Row {
        template: Some(template!("peeling/depth_layers")),
        resources: [
            vec![
                keys("layer_keys", "the key of the layer that this iteration stores; EMPTY: none"),
                keys("next_keys", "the least key behind it; EMPTY: none"),
            ],
            accumulated(),
        ]
        .concat(),
        constants: slots("1"),
        edits: layer_edits(),
        ..layers(
            "depth_layers",
            "yes, until none is left: each iteration stores the fragments of the next depth, all of them",
            "D13 §3.1.3, §3.2.1; Everitt 2001",
        )
    }
}

/// As [`depth_layers`], from the front and from the back.
pub(super) fn both_sides() -> Row {
    let keys = |name: &str, summary: &'static str| {
        let keys = Resource::new(name, Element::Word, summary).by("side", "2").by("pixel", "pixels");
        keys.cleared(u32::MAX).over_iterations()
    };
    let row = layers(
        "both_sides",
        "yes, until none is left: each iteration stores the nearest and the farthest depth that are left",
        "D13 §3.1.3, §3.2.1; Bavoil & Myers 2008",
    );
    Row {
        template: Some(template!("peeling/both_sides")),
        resources: [
            vec![
                keys(
                    "layer_keys",
                    "the keys of the layers that this iteration stores, the farther inverted; EMPTY: none",
                ),
                keys("next_keys", "the least and the greatest between them, alike"),
            ],
            accumulated(),
        ]
        .concat(),
        constants: slots("2"),
        edits: [layer_edits(), vec![by_slot()]].concat(),
        requires: joining(&row),
        ..row
    }
}

/// As [`both_sides`], in each of several buckets of the depth range of a pixel.
pub(super) fn bucket_layers() -> Row {
    let range = Resource::new("range", Element::Word, "the least key of the pixel, and the greatest inverted");
    let keys = |name: &str, summary: &'static str| {
        let keys = Resource::new(name, Element::Word, summary).by("side", "2").by("bucket", "PEELING_BUCKETS");
        keys.by("pixel", "pixels").cleared(u32::MAX).over_iterations()
    };
    let first = Pass::geometry("find_range", "nearest_layer").uses_rechecked("range");
    let row = layers(
        "bucket_layers",
        "yes, until none is left: each iteration stores the nearest and the farthest depth that are left in each bucket",
        "Liu et al. 2009; D13 §3.1.4 (BUN)",
    );
    let requires = joining(&row);
    Row {
        template: Some(template!("peeling/bucket_layers")),
        resources: [
            vec![
                range.by("end", "2").by("pixel", "pixels").cleared(u32::MAX).over_iterations(),
                keys("layer_keys", "the keys of each bucket's two layers, the farther inverted; EMPTY: none"),
                keys("next_keys", "the least and the greatest between them, alike"),
            ],
            accumulated(),
        ]
        .concat(),
        uses: [vec![Use::new("range", Access::Read)], row.uses].concat(),
        parameters: [
            vec![Parameter::number(
                "buckets",
                "PEELING_BUCKETS",
                "4",
                (1, 16),
                "equal parts of a pixel's depth range that are peeled at once",
            )],
            row.parameters,
        ]
        .concat(),
        constants: slots("2 * PEELING_BUCKETS"),
        requires,
        edits: [edits(&[], next_layers()), vec![Edit::First(vec![Step::Pass(first)]), by_slot()]].concat(),
        ..row
    }
}

/// Returns the common part of rows that peel layers of equal depth, whose store pass finds the next ones.
pub(super) fn layers(key: &str, summary: &'static str, paper: &'static str) -> Row {
    Row {
        uses: vec![
            Use::new("layer_keys", Access::Read),
            Use::rechecked("next_keys"),
            Use::new("remaining", Access::Atomic),
        ],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater, Capability::DividesLayers, Capability::LayersInOrder],
        requires: [&[Capability::KeepsAll], CONTINUES.as_slice()].concat(),
        conditions: vec![depth_key(), keeps_all()],
        needs: vec![Feature::FragmentAtomics],
        parameters: vec![iterations("limit of iterations; fragments of further layers are counted")],
        hazards: vec![not_peeled()],
        ..Row::new("peeling", key, summary, paper)
    }
}

/// Returns what a row requires whose iterations store fragments of several depths or ids: their parts are joined later.
pub(super) fn joining(row: &Row) -> Vec<Capability> {
    [row.requires.as_slice(), &[Capability::JoinsParts]].concat()
}

/// Returns the edits that find the first layers before the loop, and exchange the keys at the end of each iteration.
fn layer_edits() -> Vec<Edit> {
    let first = Pass::geometry("nearest_layer", "nearest_layer").uses_rechecked("layer_keys");
    [edits(&[], next_layers()), vec![Edit::First(vec![Step::Pass(first)])]].concat()
}

/// Exchanges the keys of this iteration's layers and of the next one's.
fn next_layers() -> Vec<Step> {
    vec![
        Step::Swap("layer_keys".to_owned(), "next_keys".to_owned()),
        Step::Clear { resource: "next_keys".to_owned(), value: u32::MAX },
    ]
}

/// Returns the number of slots of an iteration's fragments.
pub(super) fn slots(number: &'static str) -> Vec<Definition> {
    vec![Definition { symbol: "PEELING_SLOTS".into(), value: number.into() }]
}

/// Resolves the fragments of an iteration slot by slot.
pub(super) fn by_slot() -> Edit {
    Edit::SetSkeleton("resolve".to_owned(), "accumulate_slots".to_owned())
}
