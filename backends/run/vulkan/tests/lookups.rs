//! Closures that read textures, images of other pixels and neighbours along the ray, by SPIR-V.

use fragbuf_templates::Registry;
use fragbuf_vulkan_host::{Texels, Validation};

use crate::hosts::lookups::{SIZE, assert_lookup, lookups, scene};
use crate::stage::{Generated, context, draw};

#[test]
fn closures_read_textures_images_and_neighbours() {
    let context = context(Validation::On);
    for lookup in lookups() {
        let generated = Generated::of(&lookup.variant, &Registry::builtin());
        let mut host = generated.host(&context, SIZE).unwrap_or_else(|error| panic!("{}: {error}", lookup.name));
        for (name, size, values) in &lookup.textures {
            host.set_texels(name, &Texels { size: *size, values }).unwrap();
        }
        for seed in [5, 6] {
            let quads = scene(seed);
            let seen = draw(&mut host, &quads, SIZE).unwrap_or_else(|error| panic!("{}: {error}", lookup.name));
            assert_lookup("Vulkan", &lookup, &seen.pixels, &quads);
        }
    }
}

#[test]
fn textures_must_be_set_and_fit() {
    let context = context(Validation::On);
    let all = lookups();
    let lookup = all.iter().find(|lookup| !lookup.textures.is_empty()).unwrap();
    let mut host = Generated::of(&lookup.variant, &Registry::builtin()).host(&context, SIZE).unwrap();
    let error = draw(&mut host, &scene(5), SIZE).unwrap_err().to_string();
    assert!(error.contains("lut") && error.contains("set_texels"), "{error}");
    let error = host.set_texels("volume", &Texels { size: [2, 2, 9], values: &[] }).unwrap_err().to_string();
    assert!(error.contains("36 texels, not 0"), "{error}");
    // A slice does not have the pixels beside it.
    let images = all.iter().find(|lookup| !lookup.variant.images.is_empty()).unwrap();
    let mut host = Generated::of(&images.variant, &Registry::builtin()).host(&context, SIZE).unwrap();
    let error = host.set_rows(Some(2)).unwrap_err().to_string();
    assert!(error.contains("other pixels"), "{error}");
    host.set_rows(Some(SIZE[1])).unwrap();
}
