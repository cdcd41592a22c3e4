//! Targets of floats, and targets that are blended differently: OpenGL ES has them by extensions, which the manifest requires.

use fragbuf_codegen::Form;
use fragbuf_opengl_host::{Api, Object, Scene};
use fragbuf_targets::manifest;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Blend, Element, Pass, Resource, Step, TextureFormat};
use serde_json::{Value, json};

use crate::draw::{context, generated, host};
use crate::hosts::technique::IDENTITY;
use crate::hosts::tested_storage;

const TWO: &str = "
struct Two {
    @location(0) sum: f32,
    @location(1) last: vec4<f32>,
}

@fragment
fn two(inputs: FragmentInput) -> Two {
    return Two(1.0, vec4<f32>(inputs.position.z, 0.0, 0.0, 0.25));
}
";

const SHOW: &str = "
@fragment
fn show(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = pixel_index(position.xy);
    return vec4<f32>(last_load(pixel).xy, sum_load(pixel), 1.0);
}
";

/// Returns the registry with a pass that adds to a texture of 32-bit floats and replaces the texels of another.
fn registry() -> Registry {
    let texture = |name, format| Resource::new(name, Element::Texture(format), "").by("pixel", "pixels").cleared(0);
    let draw = Pass::geometry("two", "two").target("sum", Blend::Add).target("last", Blend::Replace);
    let show = Pass::fullscreen("show", "show").uses("sum", Access::Sampled).uses("last", Access::Sampled);
    let clear = |name: &str| Step::Clear { resource: name.to_owned(), value: 0 };
    let show = show.target("output", Blend::Replace);
    let resources = vec![texture("sum", TextureFormat::R32Float), texture("last", TextureFormat::Rgba8Unorm)];
    let steps = vec![clear("sum"), clear("last"), Step::Pass(draw), Step::Pass(show)];
    tested_storage::registry(resources, steps, &[("two", TWO), ("show", SHOW)])
}

#[test]
fn targets_are_blended_each_in_its_way() {
    let registry = registry();
    let variant = tested_storage::tested(&registry);
    // Two triangles over the whole frame, one behind the other.
    let triangle =
        |depth: f32| [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]].map(|[x, y]| [x, y, depth, 0.0, 0.0, 0.0, 0.0]);
    let vertices = [triangle(0.25), triangle(0.75)];
    let vertices: Vec<u8> = vertices.iter().flatten().flatten().flat_map(|value: &f32| value.to_le_bytes()).collect();
    let objects = [Object { first: 0, count: 6, bounds: [[-1.0, -1.0, 0.0], [3.0, 3.0, 1.0]] }];
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    let in_es = json!(["GL_EXT_color_buffer_float", "GL_EXT_float_blend", "GL_EXT_draw_buffers_indexed"]);
    for (api, extensions) in [(Api::OpenGl, json!([])), (Api::OpenGlEs, in_es)] {
        let context = context(api);
        let generation = generated(api, Form::Program, &variant, &registry).unwrap_or_else(|why| panic!("{why}"));
        let requires: &Value = &manifest(&generation, 0)["requires"][api.target()]["extensions"];
        assert_eq!(*requires, extensions);
        let mut host = host(&context, &generation, [2, 1]).unwrap_or_else(|error| panic!("{error}"));
        let image = host.render(&scene, [0.0; 4]).unwrap_or_else(|error| panic!("{error}"));
        for pixel in image.pixels {
            // The last depth in eight bits, and one from each triangle.
            let [last, _, sum, _] = pixel;
            assert!((last - 0.75).abs() < 1.0 / 255.0 && sum == 2.0, "{api}: {pixel:?}");
        }
    }
}
