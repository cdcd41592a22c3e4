//! Front-to-back peeling (Everitt 2001) by a depth test, a depth texture, two swapped resources and an occlusion count.

use fragbuf_cpu::{Code, Order};
use fragbuf_frame::LoopEnd;
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, DepthState, Objects, Pass, Repeat, Resource, Row, Step, TextureFormat, Until,
};
use std::sync::Arc;

use crate::stage::{FAR, built_in, code, device, different, draw, scattered, stacked, storage, texture};

pub const PEEL: &str = "
@fragment
fn peel(varyings: Varyings) -> @location(0) vec4<f32> {
    if varyings.position.z <= last_load(pixel_index(varyings.position.xy)) {
        discard;
    }
    let color = varyings_fragment(varyings).color;
    drawn_atomic_add(1u);
    return vec4<f32>(color.rgb * color.a, color.a);
}
";

pub const BLEND: &str = "
@fragment
fn blend(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return peeled_load(pixel_index(position.xy));
}
";

pub fn depth(resource: &str, compare: Compare, write: bool) -> Option<DepthState> {
    Some(DepthState { resource: resource.to_owned(), compare, write, early: false })
}

/// Each round draws what lies behind the last round's nearest; `before`: what is done in a round before that.
pub fn rows(at_most: &'static str, objects: Objects, before: Option<Pass>) -> Row {
    let mut peel = Pass::geometry("peel", "peel").uses("last", Access::Sampled).uses("drawn", Access::Atomic);
    peel.state.depth = depth("next", Compare::Less, true);
    let peel = Pass { objects, ..peel.target("peeled", Blend::Replace) };
    let blend = Pass::fullscreen("blend", "blend").uses("peeled", Access::Sampled).target("output", Blend::Under);
    let mut body = vec![
        Step::Clear { resource: "next".to_owned(), value: FAR },
        Step::Clear { resource: "peeled".to_owned(), value: 0 },
    ];
    body.extend(before.map(Step::Pass));
    body.extend([Step::Pass(peel), Step::Pass(blend), Step::Swap("last".to_owned(), "next".to_owned())]);
    let until = Until::NoSamples("peel".to_owned());
    storage(
        vec![
            texture("last", TextureFormat::Depth32Float).cleared(0),
            texture("next", TextureFormat::Depth32Float),
            texture("peeled", TextureFormat::Rgba16Float),
            Resource::new("drawn", fragbuf_templates::vocabulary::Element::Word, "").cleared(0),
        ],
        vec![Step::Repeat(Repeat { body, until, at_most: at_most.into() })],
    )
}

/// The same with a copy where resources are swapped.
fn copied(mut rows: Row) -> Row {
    if let Some(Step::Repeat(repeat)) = rows.steps.first_mut() {
        repeat.body.pop();
        repeat.body.push(Step::Copy { from: "next".to_owned(), to: "last".to_owned() });
    }
    rows
}

fn peeling(at_most: &'static str) -> Arc<Code> {
    code(rows(at_most, Objects::All, None), &[("peel", PEEL), ("blend", BLEND)], None).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn peeling_ends_when_nothing_is_left_and_is_the_picture() {
    let code = peeling("64");
    for (name, triangles) in [("stacked", stacked(12, 3)), ("scattered", scattered(9, 5))] {
        let expected = draw(&mut built_in("ab_ll"), &triangles);
        for order in [Order::Submission, Order::Shuffled(4)] {
            let mut device = device(&code, order);
            // A second frame begins where the first began.
            for _ in 0..2 {
                let seen = draw(&mut device, &triangles);
                assert_eq!(different(&seen.pixels, &expected.pixels, 1.0 / 128.0), 0, "{name}, {order:?}");
                let [looped] = seen.loops.as_slice() else { panic!("one loop") };
                assert_eq!((looped.until.as_str(), looped.end), ("no sample passes in `peel`", LoopEnd::Reached));
                assert!((3..64).contains(&looped.rounds), "{name}: {looped:?}");
                assert_eq!(seen.samples[0], 0, "nothing passes in the last round");
            }
        }
    }
}

#[test]
fn a_copy_hands_over_as_a_swap_does() {
    let triangles = stacked(12, 3);
    let expected = draw(&mut device(&peeling("64"), Order::Submission), &triangles);
    let rows = copied(rows("64", Objects::All, None));
    let code = code(rows, &[("peel", PEEL), ("blend", BLEND)], None).unwrap_or_else(|error| panic!("{error}"));
    let seen = draw(&mut device(&code, Order::Submission), &triangles);
    assert!(seen.pixels == expected.pixels && seen.loops == expected.loops);
}

#[test]
fn a_bound_that_comes_first_is_reported() {
    let triangles = stacked(12, 3);
    let expected = draw(&mut built_in("ab_ll"), &triangles);
    let seen = draw(&mut device(&peeling("2"), Order::Submission), &triangles);
    assert_eq!((seen.loops[0].rounds, seen.loops[0].end), (2, LoopEnd::Cut));
    assert!(seen.samples[0] > 0, "a layer was still found");
    assert!(different(&seen.pixels, &expected.pixels, 1.0 / 128.0) > 20);
}
