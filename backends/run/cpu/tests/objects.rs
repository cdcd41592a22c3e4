//! Object culling by box queries (D13 §3.3): completely peeled objects are not drawn again, and the image does not change.

use fragbuf_cpu::{Code, FragmentOrder};
use fragbuf_templates::vocabulary::{Access, Compare, Element, Objects, Pass, Resource, Step};
use std::sync::Arc;

use crate::peeling::rows;
use crate::peeling_loop::{BLEND, PEEL, depth};
use crate::stage::{code, device, draw, draw_objects, quad, scattered, stacked, storage};

const BOXES: &str = "
@fragment
fn boxes() {}
";

fn boxes() -> Pass {
    let mut boxes = Pass::geometry("boxes", "boxes");
    boxes.state.depth = depth("last", Compare::Greater, false);
    Pass { objects: Objects::Boxes, ..boxes }
}

fn peeling(objects: Objects, before: Option<Pass>) -> Arc<Code> {
    let skeletons = [("peel", PEEL), ("blend", BLEND), ("boxes", BOXES)];
    code(rows("64", objects, before), &skeletons, None).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn dropping_objects_does_not_change_the_image() {
    let (plain, culled) = (peeling(Objects::All, None), peeling(Objects::Visible("boxes".to_owned()), Some(boxes())));
    for (name, triangles, of_each) in [("stacked", stacked(12, 3), 6), ("scattered", scattered(9, 5), 3)] {
        let objects: Vec<_> =
            (0..3 * triangles.len() as u32).step_by(of_each).map(|at| at..at + of_each as u32).collect();
        let (mut all, mut seen) =
            (device(&plain, FragmentOrder::Submission), device(&culled, FragmentOrder::Submission));
        let expected = draw_objects(&mut all, &triangles, &objects);
        for _ in 0..2 {
            let picture = draw_objects(&mut seen, &triangles, &objects);
            assert!(picture.pixels == expected.pixels, "{name}");
            assert_eq!(picture.loops[0].iterations, expected.loops[0].iterations, "{name}");
        }
    }
}

/// Three flat objects side by side: after the first pass no part of a box is behind the peeled layer.
#[test]
fn an_object_is_dropped_once_no_part_of_its_box_is_behind() {
    let shaded = "
@fragment
fn draw_once(inputs: FragmentInput) -> @builtin(frag_depth) f32 {
    let before = drawn_atomic_add(1u);
    // Behind the margin of the box.
    return inputs.position.z + 0.05;
}
";
    let triangles: Vec<_> = [(0, 0.25), (5, 0.5), (10, 0.75)]
        .into_iter()
        .flat_map(|(x, depth)| quad([x, x + 5, 0, 4], depth, [1.0; 4]))
        .collect();
    let objects = [0..6, 6..12, 12..18];
    let mut pass = Pass::geometry("draw_once", "draw_once").uses("drawn", Access::Atomic);
    pass.state.depth = depth("last", Compare::Greater, true);
    let pass = Pass { objects: Objects::Visible("boxes".to_owned()), ..pass };
    let resources = || {
        vec![
            crate::stage::texture("last", fragbuf_templates::vocabulary::TextureFormat::Depth32Float).cleared(0),
            Resource::new("drawn", Element::Word, "").cleared(0),
        ]
    };
    // Query, draw, query, draw: the second draw has no objects. Before the first query, all objects are drawn.
    for (steps, expected) in [
        (vec![Step::Pass(boxes()), Step::Pass(pass.clone()), Step::Pass(boxes()), Step::Pass(pass.clone())], 60),
        (vec![Step::Pass(pass.clone()), Step::Pass(boxes()), Step::Pass(pass.clone())], 60),
        (vec![Step::Pass(pass.clone()), Step::Pass(pass.clone()), Step::Pass(boxes())], 120),
    ] {
        let skeletons = [("draw_once", shaded), ("boxes", BOXES)];
        let code = code(storage(resources(), steps), &skeletons, None).unwrap_or_else(|error| panic!("{error}"));
        let mut seen = device(&code, FragmentOrder::Submission);
        draw_objects(&mut seen, &triangles, &objects);
        assert_eq!(seen.words("drawn"), Some(vec![expected]));
        // A mesh without objects is one object, drawn while any part of it is visible.
        let mut whole = device(&code, FragmentOrder::Submission);
        draw(&mut whole, &triangles);
        assert!(whole.words("drawn").is_some_and(|drawn| drawn[0] >= expected));
    }
}

/// The eye is inside the box, so no face of it may be visible although the object is.
#[test]
fn a_box_that_crosses_the_near_plane_is_never_dropped() {
    let mut near = boxes();
    near.state.depth = depth("last", Compare::Less, false);
    let mut pass = Pass::geometry("draw_once", "peel").uses("drawn", Access::Atomic);
    pass.state.targets = Vec::new();
    let skeleton = "
@fragment
fn draw_counted() {
    let before = drawn_atomic_add(1u);
}
";
    let pass = Pass { objects: Objects::Visible("boxes".to_owned()), skeleton: "draw_counted".to_owned(), ..pass };
    let steps = vec![Step::Pass(near), Step::Pass(pass)];
    let resources = vec![
        crate::stage::texture("last", fragbuf_templates::vocabulary::TextureFormat::Depth32Float).cleared(0),
        Resource::new("drawn", Element::Word, "").cleared(0),
    ];
    let code = code(storage(resources, steps), &[("draw_counted", skeleton), ("boxes", BOXES)], None)
        .unwrap_or_else(|error| panic!("{error}"));
    let mut seen = device(&code, FragmentOrder::Submission);
    for (nearest, is_drawn) in [(-0.5, true), (0.25, false)] {
        let mut triangles = quad([0, 4, 0, 4], 0.5, [1.0; 4]).to_vec();
        triangles[0].corners[0][2] = nearest;
        draw_objects(&mut seen, &triangles, &[0..3, 3..6]);
        assert_eq!(seen.words("drawn").is_some_and(|drawn| drawn[0] > 0), is_drawn, "nearest at {nearest}");
    }
}
