//! Closures that read textures, images of other pixels and neighbours along the ray, by GLSL on OpenGL and OpenGL ES.

use fragbuf_codegen::Form;
use fragbuf_opengl_host::Api;
use fragbuf_opengl_host::Texels;
use fragbuf_templates::Registry;

use crate::draw::{context, generated, host, render};
use crate::hosts::lookups::{SIZE, assert_lookup, lookups, scene};

#[test]
fn closures_read_textures_images_and_neighbours() {
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let context = context(api);
        for lookup in lookups() {
            for form in [Form::Program, Form::Module] {
                let what = format!("{}, {api}, {form:?}", lookup.name);
                let generation = generated(api, form, &lookup.variant, &Registry::builtin());
                let generation = generation.unwrap_or_else(|why| panic!("{what}: {why}"));
                let mut host = host(&context, &generation, SIZE).unwrap_or_else(|error| panic!("{what}: {error}"));
                for (name, size, values) in &lookup.textures {
                    host.set_texels(name, &Texels { size: *size, values }).unwrap();
                }
                let quads = scene(5);
                let seen = render(&mut host, form, &quads, SIZE).unwrap_or_else(|error| panic!("{what}: {error}"));
                assert_lookup(&what, &lookup, &seen, &quads);
            }
        }
    }
}

#[test]
fn textures_must_be_set_and_fit() {
    let context = context(Api::OpenGl);
    let lookup = lookups().into_iter().find(|lookup| !lookup.textures.is_empty()).unwrap();
    let generation = generated(Api::OpenGl, Form::Program, &lookup.variant, &Registry::builtin());
    let generation = generation.unwrap_or_else(|why| panic!("{why}"));
    let mut host = host(&context, &generation, SIZE).unwrap();
    let mut refused = |name: &str, size: [u32; 3], count: usize| {
        host.set_texels(name, &Texels { size, values: &vec![[0.0; 4]; count] }).unwrap_err().0
    };
    assert_eq!(refused("lot", [1, 1, 1], 1), "no texture `lot`: the description has `lut`, `volume`");
    assert!(refused("lut", [2, 2, 2], 8).contains("two dimensions"));
    assert!(refused("volume", [2, 2, 2], 7).contains("8 texels, not 7"));
    assert!(refused("lut", [0, 1, 1], 0).contains("from 1 to"));
    let error = render(&mut host, Form::Program, &scene(5), SIZE).unwrap_err().0;
    assert!(error.contains("`lut`"), "{error}");
}
