//! Plans and runs test rows on a small frame; scenes of triangles in clip space, and an oracle for them.

use std::ops::Range;
use std::sync::Arc;

use fragbuf_codegen::plan;
use fragbuf_cpu::{Code, Device, Error, FragmentOrder, Mesh, Picture, Settings};
use fragbuf_model::{Draft, Selection, SourceSpan, Variant, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Blend, Capability, Element, KeepDefault, Pass, Resource, Row, Step, Technique, Template, TextureFormat,
};

/// The pixels along each side of the frame.
pub const SIZE: u32 = 16;

/// The depth of samples that no fragment has written: behind everything.
pub const FAR: u32 = 0x3f80_0000;

pub fn texture(name: &str, format: TextureFormat) -> Resource {
    Resource::new(name, Element::Texture(format), "").by("pixel", "pixels")
}

pub fn sampled(name: &str, format: TextureFormat) -> Resource {
    Resource::new(name, Element::Texture(format), "").by("sample", "capacity").by("pixel", "pixels")
}

/// Compiles a storage row with the WGSL of its skeletons, in which `binding(name)` is the binding of that resource. `keep` is
/// the number of kept fragments.
pub fn code(storage: Row, skeletons: &[(&str, &str)], keep: Option<u32>) -> Result<Arc<Code>, Error> {
    code_with(Registry::builtin(), storage, skeletons, keep)
}

/// Compiles a storage row with a registry that has other test rows.
pub fn code_with(
    registry: Registry,
    storage: Row,
    skeletons: &[(&str, &str)],
    keep: Option<u32>,
) -> Result<Arc<Code>, Error> {
    let sources: Vec<(&str, String)> = skeletons.iter().map(|(key, source)| (*key, (*source).to_owned())).collect();
    let (variant, first) = checked(registry.clone(), &storage, &sources, keep);
    let plan = plan(&variant, &Selection::first(&variant), &first)?;
    let bound = |source: &str| {
        plan.resources.iter().fold(source.to_owned(), |source, planned| {
            let name = format!("binding({})", planned.resource.name);
            source.replace(&name, &format!("binding({})", planned.binding))
        })
    };
    let sources: Vec<(&str, String)> = sources.iter().map(|(key, source)| (*key, bound(source))).collect();
    let (variant, registry) = checked(registry, &storage, &sources, keep);
    Code::of(&variant, &registry).map(Arc::new)
}

fn checked(registry: Registry, storage: &Row, skeletons: &[(&str, String)], keep: Option<u32>) -> (Variant, Registry) {
    let technique = Technique {
        key: "tested".to_owned(),
        title: "",
        paper: "",
        summary: "",
        keep: keep.map_or(KeepDefault::All, KeepDefault::Best),
        choices: vec![("storage", "tested"), ("sync", "unsynchronised")],
    };
    let mut registry = registry
        .with(Row::new("sync", "unsynchronised", "", ""))
        .with(Row {
            provides: vec![Capability::KeepsAll, Capability::KeepsBest, Capability::Sorted],
            ..storage.clone()
        })
        .with_technique(technique);
    for (key, source) in skeletons {
        let path = format!("pass/{key}.wgsl");
        registry = registry.with(Row {
            template: Some(Template::new(path, source.clone())),
            calls: vec!["addressing"],
            ..Row::new("pass", key, "", "")
        });
    }
    let draft = Draft::from_technique("tested", &SourceSpan::new("tested", 1, 1));
    (check(&draft, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}")), registry)
}

pub fn storage(resources: Vec<Resource>, steps: Vec<Step>) -> Row {
    Row { resources, steps, ..Row::new("storage", "tested", "", "") }
}

pub fn device(code: &Arc<Code>, order: FragmentOrder) -> Device {
    let settings = Settings { order, ..Settings::new(SIZE, SIZE) };
    Device::new(code.clone(), settings).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns a device for a built-in technique, with the same frame.
pub fn built_in(key: &str) -> Device {
    let registry = Registry::builtin();
    let draft = Draft::from_technique(key, &SourceSpan::new(key, 1, 1));
    device(&Arc::new(built_in_of(&draft, &registry)), FragmentOrder::Submission)
}

/// Compiles a draft of built-in rows.
pub fn built_in_of(draft: &Draft, registry: &Registry) -> Code {
    let variant = check(draft, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    Code::of(&variant, registry).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns a fullscreen pass that draws the output.
pub fn picture(skeleton: &str) -> Pass {
    Pass::fullscreen(skeleton, skeleton).target("output", Blend::Over)
}

/// A triangle in pixels and depth, in a colour with straight alpha.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub corners: [[f32; 3]; 3],
    pub color: [f32; 4],
}

/// Returns the words of vertices, and an index list.
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

/// Returns the fragments per pixel, counted by a plan.
pub fn fragments(triangles: &[Triangle]) -> Vec<u32> {
    const COUNT: &str = "
@fragment
fn count_each(inputs: FragmentInput) {
    let counted = counts_atomic_add(pixel_index(inputs.position.xy), 1u);
}
";
    let counts = Resource::new("counts", Element::Word, "").by("pixel", "pixels").cleared(0);
    let pass = Pass::geometry("count_each", "count_each").uses("counts", Access::Atomic);
    let code = code(storage(vec![counts], vec![Step::Pass(pass)]), &[("count_each", COUNT)], None);
    let mut device = device(&code.unwrap_or_else(|error| panic!("{error}")), FragmentOrder::Submission);
    draw(&mut device, triangles);
    device.words("counts").unwrap()
}

/// Returns two triangles that cover whole pixels at one depth.
pub fn quad([x0, x1, y0, y1]: [u32; 4], depth: f32, color: [f32; 4]) -> [Triangle; 2] {
    let [x0, x1, y0, y1] = [x0, x1, y0, y1].map(|pixel| pixel as f32);
    let (a, b, c, d) = ([x0, y0, depth], [x0, y1, depth], [x1, y1, depth], [x1, y0, depth]);
    [Triangle { corners: [a, b, c], color }, Triangle { corners: [a, c, d], color }]
}

/// Returns a seeded generator of numbers from 0 to 1.
pub fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// Returns random triangles, steep and flat, whose edges cross pixels.
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

/// Returns random quads, each at a different depth.
pub fn stacked(count: usize, seed: u64) -> Vec<Triangle> {
    let mut number = numbers(seed);
    let mut below = |end: u32| ((number() * end as f32) as u32).min(end - 1);
    let mut quads = Vec::new();
    for index in 0..count as u32 {
        let (x0, y0) = (below(SIZE - 1), below(SIZE - 1));
        let (x1, y1) = (x0 + 1 + below(SIZE - x0), y0 + 1 + below(SIZE - y0));
        // The step is coprime to the count: the depths are unordered and distinct.
        let depth = (1 + index * 7919 % count as u32) as f32 / (count + 2) as f32;
        let color = [below(256), below(256), below(256), 64 + below(128)].map(|byte| byte as f32 / 255.0);
        quads.extend(quad([x0, x1.min(SIZE), y0, y1.min(SIZE)], depth, color));
    }
    quads
}

/// Returns the number of pixels that differ by more than `tolerance` in some channel.
pub fn different(a: &[[f32; 4]], b: &[[f32; 4]], tolerance: f32) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > tolerance)).count()
}
