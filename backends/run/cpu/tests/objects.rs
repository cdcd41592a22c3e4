//! Objects by their boxes (D13 §3.3): what has been peeled away whole is drawn no more, and the picture stays.

use fragbuf_cpu::{Code, Order};
use fragbuf_templates::vocabulary::{Access, Compare, Element, Objects, Pass, Resource, Step};
use std::sync::Arc;

use crate::peeling::{BLEND, PEEL, depth, rows};
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
    let texts = [("peel", PEEL), ("blend", BLEND), ("boxes", BOXES)];
    code(rows("64", objects, before), &texts, None).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn dropped_objects_are_not_drawn_again_and_the_picture_stays() {
    let (plain, culled) = (peeling(Objects::All, None), peeling(Objects::Visible("boxes".to_owned()), Some(boxes())));
    for (name, triangles, of_each) in [("stacked", stacked(12, 3), 6), ("scattered", scattered(9, 5), 3)] {
        let objects: Vec<_> =
            (0..3 * triangles.len() as u32).step_by(of_each).map(|at| at..at + of_each as u32).collect();
        let (mut all, mut seen) = (device(&plain, Order::Submission), device(&culled, Order::Submission));
        let expected = draw_objects(&mut all, &triangles, &objects);
        for _ in 0..2 {
            let picture = draw_objects(&mut seen, &triangles, &objects);
            assert!(picture.pixels == expected.pixels, "{name}");
            assert_eq!(picture.loops[0].rounds, expected.loops[0].rounds, "{name}");
        }
    }
}

/// Three flat objects side by side: after the first round nothing of any box lies beyond what is peeled.
#[test]
fn an_object_is_dropped_once_nothing_of_its_box_lies_beyond() {
    let shaded = "
@fragment
fn draw_once(varyings: Varyings) -> @builtin(frag_depth) f32 {
    let before = drawn_atomic_add(1u);
    return varyings.position.z;
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
    // Asked, drawn, asked, drawn: of three objects the second draw has none. Before a query is asked all are drawn.
    for (steps, expected) in [
        (vec![Step::Pass(boxes()), Step::Pass(pass.clone()), Step::Pass(boxes()), Step::Pass(pass.clone())], 60),
        (vec![Step::Pass(pass.clone()), Step::Pass(boxes()), Step::Pass(pass.clone())], 60),
        (vec![Step::Pass(pass.clone()), Step::Pass(pass.clone()), Step::Pass(boxes())], 120),
    ] {
        let texts = [("draw_once", shaded), ("boxes", BOXES)];
        let code = code(storage(resources(), steps), &texts, None).unwrap_or_else(|error| panic!("{error}"));
        let mut seen = device(&code, Order::Submission);
        draw_objects(&mut seen, &triangles, &objects);
        assert_eq!(seen.words("drawn"), Some(vec![expected]));
        // One object that nobody names is drawn while any of it is seen.
        let mut whole = device(&code, Order::Submission);
        draw(&mut whole, &triangles);
        assert!(whole.words("drawn").is_some_and(|drawn| drawn[0] >= expected));
    }
}

/// The eye is inside of the box: no face of it may be seen, and yet the object is.
#[test]
fn a_box_that_crosses_the_near_plane_is_never_dropped() {
    let mut near = boxes();
    near.state.depth = depth("last", Compare::Less, false);
    let mut pass = Pass::geometry("draw_once", "peel").uses("drawn", Access::Atomic);
    pass.state.targets = Vec::new();
    let text = "
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
    let code = code(storage(resources, steps), &[("draw_counted", text), ("boxes", BOXES)], None)
        .unwrap_or_else(|error| panic!("{error}"));
    let mut seen = device(&code, Order::Submission);
    for (nearest, is_drawn) in [(-0.5, true), (0.25, false)] {
        let mut triangles = quad([0, 4, 0, 4], 0.5, [1.0; 4]).to_vec();
        triangles[0].corners[0][2] = nearest;
        draw_objects(&mut seen, &triangles, &[0..3, 3..6]);
        assert_eq!(seen.words("drawn").is_some_and(|drawn| drawn[0] > 0), is_drawn, "nearest at {nearest}");
    }
}
