//! The effects of `examples/effects` by OpenGL, over several storages: the image is that of the reference.

use fragbuf_codegen::Form;
use fragbuf_follow::Object;
use fragbuf_opengl_host::{Api, Scene, Texels};
use fragbuf_templates::Registry;

use crate::draw::{context, generated, host, inputs};
use crate::hosts::effects::{BACKGROUND, EFFECTS, SIZE};
use crate::hosts::technique::IDENTITY;

#[test]
fn every_effect() {
    let context = context(Api::OpenGl);
    for effect in EFFECTS {
        let solids = effect.solids();
        let (expected, textures) = (effect.expected(&solids), effect.textures(&solids));
        for (what, variant) in effect.variants() {
            let generation = generated(context.api, Form::Program, &variant, &Registry::builtin());
            let generation = generation.unwrap_or_else(|why| panic!("{what}: {why}"));
            let mut host = host(&context, &generation, SIZE).unwrap_or_else(|error| panic!("{what}: {error}"));
            host.set_symbol("fragments", u64::from(solids.count() * SIZE[0] * SIZE[1])).unwrap();
            effect.uniforms.iter().for_each(|(name, number)| host.set_uniform(name, &number.bytes()).unwrap());
            for (name, texels) in &textures {
                host.set_texels(name, &Texels { size: texels.size, values: &texels.values }).unwrap();
            }
            let inputs = inputs(&host);
            let vertices = solids.vertices(&inputs.iter().map(String::as_str).collect::<Vec<_>>());
            let bounds = [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]];
            let objects = [Object { first: 0, count: solids.count(), bounds }];
            let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
            let [r, g, b] = BACKGROUND.map(|channel| channel as f32);
            let image = host.render(&scene, [r, g, b, 1.0]).unwrap_or_else(|error| panic!("{what}: {error}"));
            effect.assert_image(&what, &image.pixels, &expected);
        }
    }
}
