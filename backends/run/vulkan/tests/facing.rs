//! The attribute `front`, which comes from the rasteriser.

use fragbuf_templates::Registry;
use fragbuf_vulkan_host::{Object, Scene, Validation};

use crate::hosts::sides::{assert_sides, sides, tetrahedron};
use crate::hosts::technique::IDENTITY;
use crate::stage::{Generated, context};

#[test]
fn sides_of_a_closed_body_alternate() {
    let context = context(Validation::On);
    let generated = Generated::of(&sides(), &Registry::builtin());
    for is_mirrored in [false, true] {
        let vertices = tetrahedron(is_mirrored);
        let objects = [Object { first: 0, count: 12, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] }];
        let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
        let mut host = generated.host(&context, [37, 23]).unwrap_or_else(|error| panic!("{error}"));
        let image = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}"));
        assert_sides(&image.pixels, is_mirrored, &context.name);
    }
}
