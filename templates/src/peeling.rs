//! Axis `peeling`: whether the scene is drawn again for the fragments that are not kept.

use crate::conditions::{depth_key, keeps_all, keeps_one};
use crate::vocabulary::{
    Access, Blend, Capability, Edit, Element, Feature, Hazard, Parameter, Pass, Permits, Repeat, Resource, Row, Split,
    State, Step, Until, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("peeling/none")),
            ..Row::new("peeling", "none", "no: what is not kept is handed to the overflow", "")
        },
        k_layers(),
        depth_layers(),
        both_sides(),
        front_to_back(),
    ]
}

/// The capabilities of the other choices that every kind of peeling requires: the effect continues, one pass resolves all pixels.
const CONTINUES: [Capability; 4] =
    [Capability::DropsDisplaced, Capability::OneSample, Capability::OneResolve, Capability::Resumes];

/// Repeats all passes of a k-buffer, each time with the fragments behind those kept so far.
fn k_layers() -> Row {
    Row {
        template: Some(template!("peeling/k_layers")),
        resources: resources(),
        uses: vec![Use::new("boundary", Access::Read), Use::new("unpeeled", Access::Atomic)],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater],
        requires: [
            // The shader of a fragment counts it: a depth test would hide fragments from it that a later iteration keeps.
            &[Capability::KeepsBest, Capability::KeepsEqualKeys, Capability::CullInShader, Capability::TotalOrder],
            CONTINUES.as_slice(),
        ]
        .concat(),
        // Effects continue from front to back.
        conditions: vec![depth_key()],
        needs: vec![Feature::FragmentAtomics],
        edits: edits(&["boundary", "unpeeled"], Vec::new()),
        parameters: vec![iterations("limit of iterations; fragments that remain after the last are counted")],
        hazards: vec![not_peeled()],
        ..Row::new(
            "peeling",
            "k_layers",
            "yes, until none is left: each iteration keeps the k best of the fragments behind those kept before",
            "K15 §4.3",
        )
    }
}

/// Repeats all passes of an A-buffer, each time with the fragments of the next depth.
fn depth_layers() -> Row {
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
            accumulated("4", FROM_THE_FRONT),
        ]
        .concat(),
        edits: layer_edits(),
        ..layers(
            "depth_layers",
            "yes, until none is left: each iteration stores the fragments of the next depth, all of them",
            "D13 §3.1.3, §3.2.1; Everitt 2001",
        )
    }
}

/// As [`depth_layers`], from the front and from the back.
fn both_sides() -> Row {
    let keys = |name: &str, summary: &'static str| {
        let keys = Resource::new(name, Element::Word, summary).by("side", "2").by("pixel", "pixels");
        keys.cleared(u32::MAX).over_iterations()
    };
    let colors = "the colour of the layers composited from the front, premultiplied, and the transmittance behind them; then the \
                  same of the layers from the back";
    let by_side = Split {
        name: "resolve".to_owned(),
        copies: "2".into(),
        constants: vec![("PEELING_SIDE".to_owned(), "copy".into())],
        before_last: Vec::new(),
    };
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
            accumulated("8", colors),
        ]
        .concat(),
        edits: [
            layer_edits(),
            vec![Edit::SetSkeleton("resolve".to_owned(), "accumulate_side".to_owned()), Edit::Split(by_side)],
        ]
        .concat(),
        ..layers(
            "both_sides",
            "yes, until none is left: each iteration stores the nearest and the farthest depth that are left",
            "D13 §3.1.3, §3.2.1; Bavoil & Myers 2008",
        )
    }
}

/// Returns the common part of rows that peel layers of equal depth, whose store pass finds the next ones.
fn layers(key: &str, summary: &'static str, paper: &'static str) -> Row {
    Row {
        uses: vec![
            Use::new("layer_keys", Access::Read),
            Use::new("next_keys", Access::Atomic),
            Use::new("remaining", Access::Atomic),
        ],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater],
        requires: [&[Capability::KeepsAll], CONTINUES.as_slice()].concat(),
        conditions: vec![depth_key(), keeps_all()],
        needs: vec![Feature::FragmentAtomics],
        parameters: vec![iterations("limit of iterations; fragments of further layers are counted")],
        hazards: vec![not_peeled()],
        ..Row::new("peeling", key, summary, paper)
    }
}

/// Returns the edits that find the first layers before the loop, and exchange the keys at the end of each iteration.
fn layer_edits() -> Vec<Edit> {
    let first = Pass::geometry("nearest_layer", "nearest_layer").uses("layer_keys", Access::Atomic);
    let advance = vec![
        Step::Swap("layer_keys".to_owned(), "next_keys".to_owned()),
        Step::Clear { resource: "next_keys".to_owned(), value: u32::MAX },
    ];
    [edits(&[], advance), vec![Edit::First(vec![Step::Pass(first)])]].concat()
}

/// Repeats all passes of a buffer of one fragment, each time with the fragments behind it.
fn front_to_back() -> Row {
    let last = Resource::new("last_keys", Element::Word, "the key of the fragment kept last; EMPTY: none")
        .by("pixel", "pixels")
        .cleared(u32::MAX)
        .over_iterations();
    Row {
        template: Some(template!("peeling/front_to_back")),
        resources: [vec![last], accumulated("4", FROM_THE_FRONT)].concat(),
        uses: vec![Use::new("last_keys", Access::Read)],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater],
        requires: [&[Capability::KeepsBest], CONTINUES.as_slice()].concat(),
        conditions: vec![depth_key(), keeps_one()],
        needs: vec![Feature::FragmentAtomics],
        edits: edits(&["last_keys"], Vec::new()),
        parameters: vec![iterations(
            "limit of iterations; the last stores nothing, and counts the fragments that remain",
        )],
        hazards: vec![
            not_peeled(),
            Hazard::new(
                "coplanar",
                "of fragments with equal depths one is kept, and the others are not counted",
                Permits { uncounted: true, ..Permits::ONE_OF_EQUAL_KEYS },
            ),
        ],
        ..Row::new(
            "peeling",
            "front_to_back",
            "yes, until none is left: each iteration keeps the nearest of the fragments behind the one before",
            "Everitt 2001; D13 §3.1.1",
        )
    }
}

fn resources() -> Vec<Resource> {
    let boundary = "the worst fragment that an iteration has kept; EMPTY: the first iteration has not ended";
    let unpeeled = "fragments that no iteration has kept, and copies of the boundary that this iteration has met";
    let own = vec![
        Resource::new("boundary", Element::Entry, boundary).by("pixel", "pixels").cleared(u32::MAX).over_iterations(),
        Resource::new("unpeeled", Element::Word, unpeeled)
            .by("part", "2")
            .by("pixel", "pixels")
            .cleared(0)
            .over_iterations(),
    ];
    [own, accumulated("4", FROM_THE_FRONT)].concat()
}

const FROM_THE_FRONT: &str =
    "the colour of the fragments kept so far, premultiplied, and the transmittance behind them";

/// Returns what the effect continues with, and the word that ends the loop.
fn accumulated(channels: &'static str, summary: &'static str) -> Vec<Resource> {
    let colors = Resource::new("accumulated", Element::Word, summary).by("channel", channels).by("pixel", "pixels");
    vec![
        colors.cleared(0).over_iterations(),
        Resource::new("remaining", Element::Word, "not 0: another iteration is needed").cleared(0),
    ]
}

/// Returns the edits that repeat all passes until no pixel needs another iteration. The resolve pass continues the effect, and also
/// writes `advanced`; `last` ends each iteration.
fn edits(advanced: &[&str], last: Vec<Step>) -> Vec<Edit> {
    let resolve = |resource: &str, access: Access| Edit::AddUse("resolve".to_owned(), Use::new(resource, access));
    let composite = Pass::fullscreen("composite", "composite").uses("accumulated", Access::Read);
    let until = Until::WordIsZero("remaining".to_owned());
    let restart = Repeat { restarts: true, ..Repeat::new(last, until, "PEELING_ITERATIONS") };
    let mut edits = vec![
        Edit::SetSkeleton("resolve".to_owned(), "accumulate".to_owned()),
        Edit::SetState("resolve".to_owned(), State::default()),
        resolve("accumulated", Access::Plain),
        resolve("remaining", Access::Atomic),
        Edit::After("resolve".to_owned(), vec![Step::Pass(composite.target("output", Blend::Over))]),
        Edit::Repeat("resolve".to_owned(), restart),
    ];
    edits.extend(advanced.iter().map(|resource| resolve(resource, Access::Plain)));
    edits
}

fn iterations(summary: &'static str) -> Parameter {
    Parameter::number("iterations", "PEELING_ITERATIONS", "1024", (1, 4096), summary)
}

fn not_peeled() -> Hazard {
    Hazard::new(
        "not-peeled",
        "if fragments remain after the last iteration, they are missing and counted",
        Permits::NOT_PEELED,
    )
}
