//! What no built-in technique uses: exchanged resources, a loop that ends when no sample passes, and objects whose boxes are tested.
//! And a closure that iterations interrupt.

use fragbuf_codegen::Form;
use fragbuf_opengl_host::{Api, Object, Scene};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Objects;

use crate::draw::{context, generated, host, inputs, render};
use crate::hosts::continued::{assert_continued, continued};
use crate::hosts::numbers::Numbers;
use crate::hosts::peeled_scene::{SIZE, assert_peeled, layers, object, registry, registry_with_boxes};
use crate::hosts::scene::{quads, vertices};
use crate::hosts::technique::IDENTITY;
use crate::hosts::tested_storage::tested;

/// Peels the layers twice: the second frame begins like the first.
fn peel(registry: &Registry) {
    let variant = tested(registry);
    let quads = layers();
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let context = context(api);
        let generation = generated(api, Form::Program, &variant, registry).unwrap_or_else(|why| panic!("{why}"));
        let mut host = host(&context, &generation, SIZE).unwrap_or_else(|error| panic!("{error}"));
        let inputs = inputs(&host);
        let vertices = vertices(&quads, SIZE, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
        let objects: Vec<Object> = quads.iter().enumerate().map(|(index, quad)| object(index, quad)).collect();
        let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
        for frame in 0..2 {
            // Layers are blended under what is there, so the image begins transparent.
            let peeled = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}")).pixels;
            assert_peeled(&format!("{api}, frame {frame}"), &peeled, &quads);
        }
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

#[test]
fn a_closure_continues_in_the_next_iteration() {
    let quads = quads(14, SIZE, &mut Numbers::seeded(5));
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let context = context(api);
        for technique in ["f2b_ll", "k_peeling"] {
            let variant = continued(technique);
            for form in [Form::Program, Form::Module] {
                let generation =
                    generated(api, form, &variant, &Registry::builtin()).unwrap_or_else(|why| panic!("{why}"));
                let mut host = host(&context, &generation, SIZE).unwrap_or_else(|error| panic!("{error}"));
                let seen = render(&mut host, form, &quads, SIZE).unwrap_or_else(|error| panic!("{error}"));
                assert_continued(&format!("{technique}, {api}, {form:?}"), &seen, &quads, SIZE);
            }
        }
    }
}
