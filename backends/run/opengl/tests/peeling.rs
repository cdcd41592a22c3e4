//! What no built-in technique uses: exchanged resources, a loop that ends when no sample passes, and objects whose boxes are tested.

use fragbuf_codegen::Form;
use fragbuf_opengl_host::{Api, Object, Scene};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Objects;

use crate::draw::{context, generated, host, inputs};
use crate::hosts::peeled_scene::{SIZE, assert_peeled, layers, object, registry, registry_with_boxes};
use crate::hosts::scene::vertices;
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
