//! Rows of a test's own, planned and run on a small frame; scenes of triangles in clip space; the oracle for them.

use std::ops::Range;
use std::sync::Arc;

use fragbuf_codegen::plan;
use fragbuf_cpu::{Code, Device, Error, Mesh, Order, Picture, Settings};
use fragbuf_frame::Sizing;
use fragbuf_model::{Draft, Origin, Selection, Variant, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Blend, Element, Fact, KeepDefault, Pass, Resource, Row, Step, Technique, Template, TextureFormat,
};

/// Pixels along each side of the frame.
pub const SIZE: u32 = 16;

/// Samples that no fragment has written are behind everything.
pub const FAR: u32 = 0x3f80_0000;

pub fn texture(name: &str, format: TextureFormat) -> Resource {
    Resource::new(name, Element::Texture(format), "").by("pixel", "pixels")
}

pub fn sampled(name: &str, format: TextureFormat) -> Resource {
    Resource::new(name, Element::Texture(format), "").by("sample", "k").by("pixel", "pixels")
}

/// A storage of resources and steps, with the WGSL of its skeletons, in which `binding(name)` is the binding of that resource;
/// `keep`: how many fragments stay.
pub fn code(storage: Row, skeletons: &[(&str, &str)], keep: Option<u32>) -> Result<Arc<Code>, Error> {
    code_with(Registry::builtin(), storage, skeletons, keep)
}

/// The same beside other rows of a test's own.
pub fn code_with(
    registry: Registry,
    storage: Row,
    skeletons: &[(&str, &str)],
    keep: Option<u32>,
) -> Result<Arc<Code>, Error> {
    let texts: Vec<(&str, String)> = skeletons.iter().map(|(key, text)| (*key, (*text).to_owned())).collect();
    let (variant, first) = checked(registry.clone(), &storage, &texts, keep);
    let plan = plan(&variant, &Selection::first(&variant), &first)?;
    let bound = |text: &str| {
        plan.resources.iter().fold(text.to_owned(), |text, planned| {
            let name = format!("binding({})", planned.resource.name);
            text.replace(&name, &format!("binding({})", planned.binding))
        })
    };
    let texts: Vec<(&str, String)> = texts.iter().map(|(key, text)| (*key, bound(text))).collect();
    let (variant, registry) = checked(registry, &storage, &texts, keep);
    Code::of(&variant, &registry).map(Arc::new)
}

fn checked(registry: Registry, storage: &Row, skeletons: &[(&str, String)], keep: Option<u32>) -> (Variant, Registry) {
    let technique = Technique {
        key: "tried".to_owned(),
        title: "",
        paper: "",
        summary: "",
        keep: keep.map_or(KeepDefault::All, KeepDefault::Best),
        choices: vec![("storage", "tried"), ("sync", "as_it_comes")],
    };
    let mut registry = registry
        .with(Row::new("sync", "as_it_comes", "", ""))
        .with(Row { offers: vec![Fact::KeepsAll, Fact::KeepsBest, Fact::Sorted], ..storage.clone() })
        .with_technique(technique);
    for (key, text) in skeletons {
        let path = format!("pass/{key}.wgsl");
        registry = registry.with(Row {
            template: Some(Template::new(path, text.clone())),
            calls: vec!["addressing"],
            ..Row::new("pass", key, "", "")
        });
    }
    let draft = Draft::from_technique("tried", &Origin::new("tried", 1, 1));
    (check(&draft, &registry).unwrap_or_else(|faults| panic!("{faults}")), registry)
}

pub fn storage(resources: Vec<Resource>, steps: Vec<Step>) -> Row {
    Row { resources, steps, ..Row::new("storage", "tried", "", "") }
}

pub fn device(code: &Arc<Code>, order: Order) -> Device {
    let settings = Settings { width: SIZE, height: SIZE, sizing: Sizing::Auto, order };
    Device::new(code.clone(), settings).unwrap_or_else(|error| panic!("{error}"))
}

/// One of the built-in techniques, on the same frame.
pub fn built_in(key: &str) -> Device {
    let registry = Registry::builtin();
    let draft = Draft::from_technique(key, &Origin::new(key, 1, 1));
    let variant = check(&draft, &registry).unwrap_or_else(|faults| panic!("{faults}"));
    device(&Arc::new(Code::of(&variant, &registry).unwrap()), Order::Submission)
}

/// A fullscreen pass that makes the picture.
pub fn picture(skeleton: &str) -> Pass {
    Pass::fullscreen(skeleton, skeleton).target("output", Blend::Over)
}

/// A triangle in pixels and depth, in a colour with straight alpha.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub corners: [[f32; 3]; 3],
    pub color: [f32; 4],
}

/// Words of vertices, and an index list.
pub fn mesh(triangles: &[Triangle]) -> (Vec<u32>, Vec<u32>) {
    let half = SIZE as f32 / 2.0;
    let vertex = |corner: [f32; 3], color: [f32; 4]| {
        let position = [corner[0] / half - 1.0, 1.0 - corner[1] / half, corner[2]];
        position.into_iter().chain(color).map(f32::to_bits)
    };
    let vertices = triangles.iter().flat_map(|triangle| triangle.corners.map(|corner| vertex(corner, triangle.color)));
    (vertices.flatten().collect(), (0..3 * triangles.len() as u32).collect())
}

pub fn draw(device: &mut Device, triangles: &[Triangle]) -> Picture {
    draw_objects(device, triangles, &[])
}

pub fn draw_objects(device: &mut Device, triangles: &[Triangle], objects: &[Range<u32>]) -> Picture {
    let (vertices, indices) = mesh(triangles);
    let mesh = Mesh { vertices: &vertices, indices: &indices };
    device.set_objects(objects);
    let picture = device.render(&mesh, &|_| {}).unwrap_or_else(|error| panic!("{error}"));
    assert!(picture.out_of_bounds.is_empty(), "{:?}", picture.out_of_bounds);
    picture
}

/// Fragments of each pixel, by a plan that counts them.
pub fn fragments(triangles: &[Triangle]) -> Vec<u32> {
    const COUNT: &str = "
@fragment
fn count_each(varyings: Varyings) {
    let counted = counts_atomic_add(pixel_index(varyings.position.xy), 1u);
}
";
    let counts = Resource::new("counts", Element::Word, "").by("pixel", "pixels").cleared(0);
    let pass = Pass::geometry("count_each", "count_each").uses("counts", Access::Atomic);
    let code = code(storage(vec![counts], vec![Step::Pass(pass)]), &[("count_each", COUNT)], None);
    let mut device = device(&code.unwrap_or_else(|error| panic!("{error}")), Order::Submission);
    draw(&mut device, triangles);
    device.words("counts").unwrap()
}

/// Two triangles that cover whole pixels at one depth.
pub fn quad([x0, x1, y0, y1]: [u32; 4], depth: f32, color: [f32; 4]) -> [Triangle; 2] {
    let [x0, x1, y0, y1] = [x0, x1, y0, y1].map(|pixel| pixel as f32);
    let (a, b, c, d) = ([x0, y0, depth], [x0, y1, depth], [x1, y1, depth], [x1, y0, depth]);
    [Triangle { corners: [a, b, c], color }, Triangle { corners: [a, c, d], color }]
}

/// Numbers from 0 to 1 from a seed.
pub fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// Triangles anywhere, steep and flat, whose edges run through pixels.
pub fn scattered(count: usize, seed: u64) -> Vec<Triangle> {
    let mut number = numbers(seed);
    let mut channel = || (number() * 255.0).round() / 255.0;
    let mut corner = || [channel() * 20.0 - 2.0, channel() * 20.0 - 2.0, 0.05 + 0.9 * channel()];
    let corners: Vec<[[f32; 3]; 3]> = (0..count).map(|_| [corner(), corner(), corner()]).collect();
    corners
        .into_iter()
        .map(|corners| Triangle { corners, color: [channel(), channel(), channel(), 0.2 + 0.6 * channel()] })
        .collect()
}

/// Quads anywhere, each at a depth of its own.
pub fn stacked(count: usize, seed: u64) -> Vec<Triangle> {
    let mut number = numbers(seed);
    let mut below = |end: u32| ((number() * end as f32) as u32).min(end - 1);
    let mut quads = Vec::new();
    for index in 0..count as u32 {
        let (x0, y0) = (below(SIZE - 1), below(SIZE - 1));
        let (x1, y1) = (x0 + 1 + below(SIZE - x0), y0 + 1 + below(SIZE - y0));
        // A step that shares no divisor with the count: in no order, and none twice.
        let depth = (1 + index * 7919 % count as u32) as f32 / (count + 2) as f32;
        let color = [below(256), below(256), below(256), 64 + below(128)].map(|byte| byte as f32 / 255.0);
        quads.extend(quad([x0, x1.min(SIZE), y0, y1.min(SIZE)], depth, color));
    }
    quads
}

/// How many pictures differ by more than `apart` in some channel, pixel by pixel.
pub fn different(a: &[[f32; 4]], b: &[[f32; 4]], apart: f32) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > apart)).count()
}
