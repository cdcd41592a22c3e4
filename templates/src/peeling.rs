//! Axis `peeling`: whether the scene is drawn again for the fragments that are not kept.

mod ids;
mod layers;

use crate::conditions::keeps_one;
use crate::vocabulary::{
    Access, Blend, Capability, Edit, Element, Feature, Hazard, Parameter, Pass, Permits, Repeat, Resource, Row, State,
    Step, Until, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("peeling/none")),
            provides: vec![Capability::LayersInOrder],
            ..Row::new("peeling", "none", "no: the scene is drawn once, and what is not kept goes to the overflow", "")
        },
        k_layers(),
        layers::depth_layers(),
        layers::both_sides(),
        layers::bucket_layers(),
        ids::id_pairs(),
        ids::id_pairs_tested(),
        ids::id_pairs_both_sides(),
        ids::ids_on_demand(),
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
        constants: layers::slots("1"),
        uses: vec![Use::new("boundary", Access::Read), Use::new("unpeeled", Access::Atomic)],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater],
        implies: vec![("depth_key".into(), Capability::LayersInOrder)],
        requires: [
            // The shader of a fragment counts it: a depth test would hide fragments from it that a later iteration keeps.
            &[Capability::KeepsBest, Capability::KeepsEqualKeys, Capability::CullInShader, Capability::TotalOrder],
            CONTINUES.as_slice(),
        ]
        .concat(),
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

/// Repeats all passes of a buffer of one fragment, each time with the fragments behind it.
fn front_to_back() -> Row {
    let last = Resource::new("last_keys", Element::Word, "the key of the fragment kept last; EMPTY: none")
        .by("pixel", "pixels")
        .cleared(u32::MAX)
        .over_iterations();
    Row {
        template: Some(template!("peeling/front_to_back")),
        resources: [vec![last], accumulated()].concat(),
        constants: layers::slots("1"),
        uses: vec![Use::new("last_keys", Access::Read), Use::new("remaining", Access::Atomic)],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater],
        implies: vec![("depth_key".into(), Capability::LayersInOrder)],
        requires: [&[Capability::KeepsBest], CONTINUES.as_slice()].concat(),
        conditions: vec![keeps_one()],
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
    [own, accumulated()].concat()
}

/// Returns what the effect continues with, and the word that ends the loop.
fn accumulated() -> Vec<Resource> {
    let summary = "for each slot, what the effect has computed so far: of `over` the premultiplied colour, and the transmittance behind it";
    let words = Resource::new("accumulated", Element::Word, summary).by("word", "resumed_words * PEELING_SLOTS");
    vec![
        words.by("pixel", "pixels").cleared(0).over_iterations(),
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
