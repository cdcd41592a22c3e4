//! The image is turned upside down on its way, and front faces stay front faces.

use fragbuf_codegen::Form;
use fragbuf_opengl_host::{Api, Object, Scene};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Blend, Pass, Step};

use crate::draw::{context, generated, host};
use crate::hosts::sides::{assert_sides, sides, tetrahedron};
use crate::hosts::technique::IDENTITY;
use crate::hosts::tested_storage::{registry, tested};

const FACING: &str = "
@fragment
fn facing(inputs: FragmentInput, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(select(0.25, 0.75, front), inputs.position.y, inputs.position.z, 1.0);
}
";

/// A triangle that is counterclockwise as it is seen is a front face (WebGPU, `frontFace`), its upper rows are the first of the
/// image, and the position of a fragment counts from them.
#[test]
fn front_faces_and_rows_are_those_of_webgpu() {
    let steps = vec![Step::Pass(Pass::geometry("facing", "facing").target("output", Blend::Replace))];
    let registry = registry(Vec::new(), steps, &[("facing", FACING)]);
    let variant = tested(&registry);
    // The upper half of the frame, counterclockwise, and the lower half, clockwise.
    let half = |[left, first, right, last]: [f32; 4], depth: f32| {
        [[left, first], [left, last], [right, last], [left, first], [right, last], [right, first]]
            .map(|[x, y]| [x, y, depth, 0.0, 0.0, 0.0, 0.0])
    };
    let vertices = [half([-1.0, 1.0, 1.0, 0.0], 0.25), half([-1.0, -1.0, 1.0, 0.0], 0.5)];
    let vertices: Vec<u8> = vertices.iter().flatten().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let objects = [Object { first: 0, count: 12, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] }];
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let context = context(api);
        let generation = generated(api, Form::Program, &variant, &registry).unwrap_or_else(|why| panic!("{why}"));
        let mut host = host(&context, &generation, [1, 4]).unwrap_or_else(|error| panic!("{error}"));
        let image = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}"));
        let expected = [[0.75, 0.5, 0.25], [0.75, 1.5, 0.25], [0.25, 2.5, 0.5], [0.25, 3.5, 0.5]];
        let seen: Vec<[f32; 3]> = image.pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
        assert_eq!(seen, expected, "{api}");
    }
}

#[test]
fn sides_of_a_closed_body_alternate() {
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let context = context(api);
        let generation = generated(api, Form::Program, &sides(), &Registry::builtin());
        let generation = generation.unwrap_or_else(|why| panic!("{why}"));
        for is_mirrored in [false, true] {
            let vertices = tetrahedron(is_mirrored);
            let objects = [Object { first: 0, count: 12, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] }];
            let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
            let mut host = host(&context, &generation, [37, 23]).unwrap_or_else(|error| panic!("{error}"));
            let image = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}"));
            assert_sides(&image.pixels, is_mirrored, &api.to_string());
        }
    }
}
