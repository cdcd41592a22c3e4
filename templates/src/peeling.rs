//! Axis `peeling`: whether the scene is drawn again for the fragments that are not kept.

use crate::conditions::depth_key;
use crate::vocabulary::{
    Access, Blend, Capability, Edit, Element, Feature, Hazard, Parameter, Pass, Permits, Repeat, Resource, Row, State,
    Step, Until, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("peeling/none")),
            ..Row::new("peeling", "none", "no: what is not kept is handed to the overflow", "")
        },
        k_layers(),
    ]
}

/// Repeats all passes of a k-buffer, each time with the fragments behind those kept so far.
fn k_layers() -> Row {
    Row {
        template: Some(template!("peeling/k_layers")),
        resources: resources(),
        uses: vec![Use::new("boundary", Access::Read), Use::new("unpeeled", Access::Atomic)],
        calls: vec!["addressing", "counters"],
        provides: vec![Capability::KeepsLater],
        requires: vec![
            Capability::KeepsBest,
            Capability::KeepsEqualKeys,
            // The shader of a fragment counts it: a depth test would hide fragments from it that a later iteration keeps.
            Capability::CullInShader,
            Capability::DropsDisplaced,
            Capability::TotalOrder,
            Capability::OneSample,
            Capability::OneResolve,
            Capability::Resumes,
        ],
        // Effects continue from front to back.
        conditions: vec![depth_key()],
        needs: vec![Feature::FragmentAtomics],
        edits: edits(),
        parameters: vec![Parameter::number(
            "iterations",
            "PEELING_ITERATIONS",
            "1024",
            (1, 4096),
            "limit of iterations; fragments that remain after the last are counted",
        )],
        hazards: vec![Hazard::new(
            "not-peeled",
            "if fragments remain after the last iteration, they are missing and counted",
            Permits::NOT_PEELED,
        )],
        ..Row::new(
            "peeling",
            "k_layers",
            "yes, until none is left: each iteration keeps the k best of the fragments behind those kept before",
            "K15 §4.3",
        )
    }
}

fn resources() -> Vec<Resource> {
    let boundary = "the worst fragment that an iteration has kept; EMPTY: the first iteration has not ended";
    let unpeeled = "fragments that no iteration has kept, and copies of the boundary that this iteration has met";
    let accumulated = "the colour of the fragments kept so far, premultiplied, and the transmittance behind them";
    vec![
        Resource::new("boundary", Element::Entry, boundary).by("pixel", "pixels").cleared(u32::MAX).over_iterations(),
        Resource::new("unpeeled", Element::Word, unpeeled)
            .by("part", "2")
            .by("pixel", "pixels")
            .cleared(0)
            .over_iterations(),
        Resource::new("accumulated", Element::Word, accumulated)
            .by("channel", "4")
            .by("pixel", "pixels")
            .cleared(0)
            .over_iterations(),
        Resource::new("remaining", Element::Word, "not 0: fragments of some pixel have not been kept").cleared(0),
    ]
}

fn edits() -> Vec<Edit> {
    let resolve = |resource: &str, access: Access| Edit::AddUse("resolve".to_owned(), Use::new(resource, access));
    let composite = Pass::fullscreen("composite", "composite").uses("accumulated", Access::Read);
    let until = Until::WordIsZero("remaining".to_owned());
    let restart = Repeat { restarts: true, ..Repeat::new(Vec::new(), until, "PEELING_ITERATIONS") };
    vec![
        Edit::SetSkeleton("resolve".to_owned(), "accumulate".to_owned()),
        Edit::SetState("resolve".to_owned(), State::default()),
        resolve("boundary", Access::Plain),
        resolve("unpeeled", Access::Plain),
        resolve("accumulated", Access::Plain),
        resolve("remaining", Access::Atomic),
        Edit::After("resolve".to_owned(), vec![Step::Pass(composite.target("output", Blend::Over))]),
        Edit::Repeat("resolve".to_owned(), restart),
    ]
}
