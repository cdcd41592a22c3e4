//! What no built-in technique uses: exchanged resources, a loop that ends when no sample passes, and objects whose boxes are tested.

use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_opengl_host::{Object, Scene};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Compare, KeepDefault, Objects, Pass, Row, Step, Technique, Template};

use crate::numbers::Numbers;
use crate::peeling_loop::{BLEND, PEEL, depth, peeling_loop, peeling_resources};
use crate::pixels::{BACKGROUND, IDENTITY, context, host_with, inputs};
use crate::scene::{Quad, image, over_background, quads, vertices};

const SIZE: [u32; 2] = [13, 7];

const BOXES: &str = "
@fragment
fn boxes() {}
";

/// Returns the registry with front-to-back peeling as a storage.
fn registry(objects: Objects, before: Option<Pass>) -> Registry {
    let choices = vec![("storage", "tested"), ("sync", "as_it_comes")];
    let keep = KeepDefault::All;
    let technique = Technique { key: "tested".to_owned(), title: "", paper: "", summary: "", keep, choices };
    let storage = Row {
        resources: peeling_resources(),
        steps: vec![Step::Repeat(peeling_loop("peel", "64", objects, before, "output"))],
        provides: vec![Capability::KeepsAll, Capability::FixedFunction, Capability::Sorted],
        ..Row::new("storage", "tested", "", "")
    };
    let skeleton = |(key, source): (&str, &str)| Row {
        template: Some(Template::new(format!("pass/{key}.wgsl"), source.to_owned())),
        calls: vec!["addressing"],
        ..Row::new("pass", key, "", "")
    };
    let registry = Registry::builtin().with(storage).with(Row::new("sync", "as_it_comes", "", ""));
    let skeletons = [("peel", PEEL), ("blend", BLEND), ("boxes", BOXES)];
    skeletons.map(skeleton).into_iter().fold(registry.with_technique(technique), Registry::with)
}

/// The quad as an object. Its box is flat.
fn object(index: usize, quad: &Quad) -> Object {
    let x = quad.x.map(|x| 2.0 * x as f32 / SIZE[0] as f32 - 1.0);
    let y = quad.y.map(|y| 1.0 - 2.0 * y as f32 / SIZE[1] as f32);
    let bounds = [[x[0], y[1], quad.depth], [x[1], y[0], quad.depth]];
    Object { first: 6 * index as u32, count: 6, bounds }
}

/// Peels nine quads of different depths, twice: the second frame begins like the first.
fn assert_peeled(registry: &Registry) {
    let context = context();
    let draft = Draft::from_technique("tested", &SourceSpan::new("tested", 1, 1));
    let variant = check(&draft, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let mut host = host_with(&context, &variant, registry, SIZE).unwrap_or_else(|error| panic!("{error}"));
    let mut quads = quads(9, SIZE, &mut Numbers::seeded(11));
    // Peeling keeps one of several equal depths.
    quads.iter_mut().enumerate().for_each(|(index, quad)| quad.depth = 0.05 + 0.1 * (index * 4 % 9) as f32);
    let inputs = inputs(&host);
    let vertices = vertices(&quads, SIZE, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let objects: Vec<Object> = quads.iter().enumerate().map(|(index, quad)| object(index, quad)).collect();
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    let expected = image(&quads, SIZE, None, BACKGROUND);
    for frame in 0..2 {
        // Layers are blended under what is there, so the image begins transparent.
        let peeled = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}")).pixels;
        for (pixel, (seen, expected)) in peeled.iter().zip(&expected).enumerate() {
            let seen = over_background(seen.map(f64::from), BACKGROUND);
            // Half floats round each layer.
            let is_near = seen.iter().zip(expected).all(|(seen, expected)| (seen - expected).abs() < 2.0 / 255.0);
            assert!(is_near, "frame {frame}, pixel {pixel}: {seen:?}, not {expected:?}");
        }
    }
}

#[test]
fn exchanged_resources_and_a_loop_on_an_occlusion_query_peel_the_scene() {
    assert_peeled(&registry(Objects::All, None));
}

#[test]
fn objects_are_drawn_if_their_boxes_are_visible() {
    let mut boxes = Pass::geometry("boxes", "boxes");
    boxes.state.depth = depth("last", Compare::Greater, false);
    let boxes = Pass { objects: Objects::Boxes, ..boxes };
    assert_peeled(&registry(Objects::Visible("boxes".to_owned()), Some(boxes)));
}
