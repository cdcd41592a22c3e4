//! The effects of `examples/effects` by SPIR-V, over several storages: the image is that of the reference.

use fragbuf_follow::Object;
use fragbuf_templates::Registry;
use fragbuf_vulkan_host::{Scene, Texels, Validation};

use crate::hosts::effects::{BACKGROUND, EFFECTS, SIZE};
use crate::hosts::technique::IDENTITY;
use crate::stage::{Generated, context, inputs};

#[test]
fn every_effect() {
    let context = context(Validation::On);
    for effect in EFFECTS {
        let solids = effect.solids();
        let (expected, textures) = (effect.expected(&solids), effect.textures(&solids));
        for (what, variant) in effect.variants() {
            let generated = Generated::of(&variant, &Registry::builtin());
            let mut host = generated.host(&context, SIZE).unwrap_or_else(|error| panic!("{what}: {error}"));
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
            drop(host);
            context.check().unwrap_or_else(|error| panic!("{what}: {error}"));
        }
    }
}
