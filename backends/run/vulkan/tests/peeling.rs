//! What no built-in technique uses: exchanged resources, a loop that ends when no sample passes, and objects whose
//! boxes are tested. And what the description of a caller uses: a closure and uniforms, a closure that iterations interrupt.

use fragbuf_model::check;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Objects;
use fragbuf_vulkan_host::{Object, Scene, Validation};

use crate::hosts::continued::{assert_continued, continued};
use crate::hosts::numbers::Numbers;
use crate::hosts::peeled_scene::{SIZE, assert_peeled, layers, object, registry, registry_with_boxes};
use crate::hosts::scene::{Quad, quads, vertices};
use crate::hosts::technique::{BACKGROUND, IDENTITY};
use crate::hosts::tested_storage::tested;
use crate::stage::{Generated, context, draw, inputs};

/// Peels the layers in three frames, whole and in slices: each frame begins like the first.
fn peel(registry: &Registry) {
    let context = context(Validation::On);
    let variant = tested(registry);
    let mut host = Generated::of(&variant, registry).host(&context, SIZE).unwrap_or_else(|error| panic!("{error}"));
    let (quads, inputs) = (layers(), inputs(&host));
    let vertices = vertices(&quads, SIZE, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let objects: Vec<Object> = quads.iter().enumerate().map(|(index, quad)| object(index, quad)).collect();
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    for rows in [None, None, Some(2)] {
        host.set_rows(rows).unwrap();
        // Layers are blended under what is there, so the image begins transparent.
        let peeled = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}")).pixels;
        assert_peeled(&format!("slices of {rows:?} rows"), &peeled, &quads);
    }
}

#[test]
fn exchanged_resources_and_a_loop_on_an_occlusion_query_peel_the_scene() {
    peel(&registry(Objects::All, None));
}

#[test]
fn objects_are_drawn_if_their_boxes_are_visible() {
    peel(&registry_with_boxes());
}

/// A description with a closure, uniforms and a constraint. The expected colours are computed here.
#[test]
fn a_closure_gets_the_uniforms_of_the_caller() {
    let text = "buffer Tinted from kplus_array {
        fragment { color: rgba8, depth: f32 }
        uniform { cut: f32, tint: vec4 }
        keep 4 least |f| f.depth;
        where |f, u| f.depth > u.cut;
        resolve |fragments, u| {
            let mut count = 0.0;
            for f in fragments { count += 1.0; }
            vec4(count / 16.0, 0.0, 0.0, 1.0) * u.tint
        }
    }";
    let parsed = fragbuf_syntax::parse(text, "test.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    let variant = check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let context = context(Validation::On);
    let mut host = Generated::of(&variant, &Registry::builtin()).host(&context, SIZE).unwrap();
    let quads = quads(9, SIZE, &mut Numbers::seeded(5));
    let error = draw(&mut host, &quads, SIZE).unwrap_err().to_string();
    assert!(error.contains("`cut`") && error.contains("set_uniform"), "{error}");
    host.set_uniform("cut", &0.3_f32.to_le_bytes()).unwrap();
    let tint: Vec<u8> = [0.5_f32, 1.0, 1.0, 1.0].iter().flat_map(|channel| channel.to_le_bytes()).collect();
    let error = host.set_uniform("tint", &tint[..8]).unwrap_err().to_string();
    assert!(error.contains("16 bytes"), "{error}");
    host.set_uniform("tint", &tint).unwrap();
    let seen = draw(&mut host, &quads, SIZE).unwrap();
    for (index, pixel) in (0..).zip(&seen.pixels) {
        let [x, y] = [index % SIZE[0], index / SIZE[0]];
        let covers = |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
        let count = quads.iter().filter(covers).filter(|quad| quad.depth > 0.3).count().min(4);
        // A pixel without fragments keeps the background.
        let expected = if count == 0 { BACKGROUND[0] as f32 } else { count as f32 / 32.0 };
        assert!((pixel[0] - expected).abs() < 1.0 / 255.0, "pixel {index}: {pixel:?}, not {expected}");
    }
}

#[test]
fn a_closure_continues_in_the_next_iteration() {
    let context = context(Validation::On);
    let quads = quads(14, SIZE, &mut Numbers::seeded(5));
    for technique in ["f2b_ll", "k_peeling"] {
        let generated = Generated::of(&continued(technique), &Registry::builtin());
        let mut host = generated.host(&context, SIZE).unwrap_or_else(|error| panic!("{error}"));
        for rows in [None, Some(2)] {
            host.set_rows(rows).unwrap();
            let seen = draw(&mut host, &quads, SIZE).unwrap_or_else(|error| panic!("{error}"));
            assert_continued(&format!("{technique}, slices of {rows:?} rows"), &seen.pixels, &quads, SIZE);
        }
    }
}
