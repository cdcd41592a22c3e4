//! What no technique of today needs and a frame can say: exchanged resources, loops that end by an occlusion query, objects
//! by their boxes, a host step that reads many words and sets k. Rows of the tests' own, on the driver; the CPU device runs
//! the same commands in `backends/run/cpu/tests`.

use std::cell::RefCell;

use fragbuf_targets::{Request, generate, target};
use fragbuf_codegen::{Form, plan};
use fragbuf_model::{Draft, Origin, Selection, Variant, check};
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{LoopEnd, Looped, ObjectBox, Output, Renderer, Room, Settings, Shaders, Sizing, block_on};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, DepthState, Edit, Element, Fact, Host, HostCall, HostFunction, KeepDefault, Objects, Pass,
    Repeat, Resource, Row, Step, Technique, Template, TextureFormat, Until,
};

use crate::capture::scattered;
use crate::oracle::{PLAIN, fragments, picture, pixels as pixels_of_the_frame};
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{BACKGROUND, FORMAT, device, renderer, settings, vertex_buffer};

const FAR: u32 = 0x3f80_0000;

const PEEL: &str = "
@fragment
fn peel(varyings: Varyings) -> @location(0) vec4<f32> {
    if varyings.position.z <= last_load(pixel_index(varyings.position.xy)) {
        discard;
    }
    let color = varyings_fragment(varyings).color;
    let before = drawn_atomic_add(1u);
    return vec4<f32>(color.rgb * color.a, color.a);
}
";

const BLEND: &str = "
@fragment
fn blend(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return peeled_load(pixel_index(position.xy));
}
";

const PUT: &str = "
@fragment
fn put(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return sum_load(pixel_index(position.xy));
}
";

const BOXES: &str = "
@fragment
fn boxes() {}
";

const HISTOGRAM: &str = "
@compute @workgroup_size(64)
fn histogram(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x < pixel_count() {
        let before = bins_atomic_add(min(counts_load(invocation.x), 63u), 1u);
    }
}
";

fn texture(name: &str, format: TextureFormat) -> Resource {
    Resource::new(name, Element::Texture(format), "").by("pixel", "pixels")
}

fn depth(resource: &str, compare: Compare, write: bool) -> Option<DepthState> {
    Some(DepthState { resource: resource.to_owned(), compare, write, early: false })
}

/// Front-to-back peeling (Everitt 2001): each round draws what lies behind the last round's nearest, and ends when there is
/// nothing.
fn peeling(at_most: &'static str, objects: Objects, before: Option<Pass>) -> Row {
    let mut peel = Pass::geometry("peel", "peel").uses("last", Access::Sampled).uses("drawn", Access::Atomic);
    peel.state.depth = depth("next", Compare::Less, true);
    let peel = Pass { objects, ..peel.target("peeled", Blend::Replace) };
    let blend = Pass::fullscreen("blend", "blend").uses("peeled", Access::Sampled).target("sum", Blend::Under);
    let put = Pass::fullscreen("put", "put").uses("sum", Access::Sampled).target("output", Blend::Over);
    let mut body = vec![
        Step::Clear { resource: "next".to_owned(), value: FAR },
        Step::Clear { resource: "peeled".to_owned(), value: 0 },
    ];
    body.extend(before.map(Step::Pass));
    body.extend([Step::Pass(peel), Step::Pass(blend), Step::Swap("last".to_owned(), "next".to_owned())]);
    let until = Until::NoSamples("peel".to_owned());
    Row {
        resources: vec![
            texture("last", TextureFormat::Depth32Float).cleared(0),
            texture("next", TextureFormat::Depth32Float),
            texture("peeled", TextureFormat::Rgba16Float),
            texture("sum", TextureFormat::Rgba16Float).cleared(0),
            Resource::new("drawn", Element::Word, "").cleared(0),
        ],
        steps: vec![Step::Repeat(Repeat { body, until, at_most: at_most.into() }), Step::Pass(put)],
        offers: vec![Fact::KeepsAll, Fact::FixedFunction, Fact::Sorted],
        ..Row::new("storage", "tried", "", "")
    }
}

/// The registry with a storage, or another row, and the skeletons of its passes.
fn registry(
    row: Row,
    skeletons: &[(&str, &str)],
    choices: Vec<(&'static str, &'static str)>,
    keep: KeepDefault,
) -> Registry {
    let technique = Technique { key: "tried".to_owned(), title: "", paper: "", summary: "", keep, choices };
    let skeletons = skeletons.iter().map(|(key, text)| Row {
        template: Some(Template::new(format!("pass/{key}.wgsl"), (*text).to_owned())),
        calls: vec!["addressing"],
        ..Row::new("pass", key, "", "")
    });
    let registry =
        Registry::builtin().with(row).with(Row::new("sync", "as_it_comes", "", "")).with_technique(technique);
    skeletons.fold(registry, Registry::with)
}

fn tried(registry: &Registry) -> Variant {
    let draft = Draft::from_technique("tried", &Origin::new("tried", 1, 1));
    check(&draft, registry).unwrap_or_else(|faults| panic!("{faults}"))
}

fn shaders(registry: &Registry) -> Shaders {
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&tried(registry), &request, registry).unwrap_or_else(|faults| panic!("{faults}"));
    Shaders::from_generation(&generation, "wgsl", 0).unwrap()
}

fn peeling_shaders(at_most: &'static str, objects: Objects, before: Option<Pass>) -> Shaders {
    let texts = [("peel", PEEL), ("blend", BLEND), ("put", PUT), ("boxes", BOXES)];
    let choices = vec![("storage", "tried"), ("sync", "as_it_comes")];
    shaders(&registry(peeling(at_most, objects, before), &texts, choices, KeepDefault::All))
}

/// Draws quads over the background, those of the objects that are asked for; the picture, and how the loops ended.
fn draw(stage: &Headless, renderer: &mut Renderer, quads: &[Quad]) -> (Vec<[f32; 4]>, Vec<Looped>) {
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let buffer = vertex_buffer(stage, &vertices(quads, renderer.vertex_inputs()));
    let [r, g, b] = BACKGROUND;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
    let all: Vec<u32> = (0..quads.len() as u32).collect();
    let drawn = renderer.render(&output, &mut |pass, call| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        for object in call.objects.unwrap_or(&all) {
            pass.draw(6 * object..6 * object + 6, 0..1);
        }
    });
    (offscreen.colors(&stage.device, &stage.queue).unwrap(), drawn.unwrap())
}

fn drawn(stage: &Headless, renderer: &Renderer) -> u32 {
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let words = renderer.words("drawn", &mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    words.wait(&stage.device).unwrap()[0]
}

/// Whether a picture is that of all fragments, in the order of depth; half floats round each layer.
fn is_right(pixels: &[[f32; 4]], quads: &[Quad]) -> bool {
    let expected = picture(&PLAIN, quads, None, BACKGROUND);
    let is_near = |(a, b): (&f32, &f64)| (f64::from(*a) - b).abs() < 2.0 / 255.0;
    pixels.iter().zip(&expected).all(|(seen, wanted)| seen.iter().zip(wanted).all(is_near))
}

/// Quads of different depths: peeling keeps one of equal ones.
fn layers() -> Vec<Quad> {
    let mut quads = scattered(12, 5);
    for (number, quad) in quads.iter_mut().enumerate() {
        quad.depth = 0.05 + 0.9 * (number * 5 % 12) as f32 / 12.0;
    }
    quads
}

#[test]
fn exchanged_resources_and_a_loop_by_an_occlusion_query_peel_the_picture() {
    let stage = device();
    let quads = layers();
    let mut exact = renderer(&stage, &peeling_shaders("64", Objects::All, None), &settings()).unwrap();
    // A second frame begins where the first began, and slices each go their own way.
    for _ in 0..2 {
        let (pixels, loops) = draw(&stage, &mut exact, &quads);
        assert!(is_right(&pixels, &quads));
        let [looped] = loops.as_slice() else { panic!("{loops:?}") };
        assert_eq!((looped.until.as_str(), looped.end), ("no sample passes in `peel`", LoopEnd::Reached));
        assert!((4..64).contains(&looped.rounds), "{looped:?}");
    }
    let sliced = Settings { slice: Some(5), ..settings() };
    let mut sliced = renderer(&stage, &peeling_shaders("64", Objects::All, None), &sliced).unwrap();
    assert!(is_right(&draw(&stage, &mut sliced, &quads).0, &quads));
}

#[test]
fn where_memory_is_reserved_a_loop_goes_on_to_its_bound() {
    let stage = device();
    let quads = layers();
    let reserved = Settings { sizing: Sizing::Reserve(Room::Fragments(1)), ..settings() };
    let mut whole = renderer(&stage, &peeling_shaders("12", Objects::All, None), &reserved).unwrap();
    let (pixels, loops) = draw(&stage, &mut whole, &quads);
    assert!(is_right(&pixels, &quads) && loops.is_empty());
    // A bound that comes first is said where somebody asks.
    let mut cut = renderer(&stage, &peeling_shaders("2", Objects::All, None), &settings()).unwrap();
    let (pixels, loops) = draw(&stage, &mut cut, &quads);
    assert_eq!((loops[0].rounds, loops[0].end), (2, LoopEnd::Cut));
    assert!(!is_right(&pixels, &quads));
}

#[test]
fn objects_whose_boxes_are_peeled_away_are_drawn_no_more() {
    let stage = device();
    let quads = layers();
    let mut boxes = Pass::geometry("boxes", "boxes");
    boxes.state.depth = depth("last", Compare::Greater, false);
    let boxes = Pass { objects: Objects::Boxes, ..boxes };
    let culled = peeling_shaders("64", Objects::Visible("boxes".to_owned()), Some(boxes));
    let mut plain = renderer(&stage, &peeling_shaders("64", Objects::All, None), &settings()).unwrap();
    let (expected, _) = draw(&stage, &mut plain, &quads);
    let mut seen = renderer(&stage, &culled, &settings()).unwrap();
    // The scene is one object before its boxes are said.
    assert_eq!(draw(&stage, &mut seen, &quads).0, expected);
    let clip = |pixel: u32| pixel as f32 / (SIZE / 2) as f32 - 1.0;
    let around = |quad: &Quad| ObjectBox {
        least: [clip(quad.x0), -clip(quad.y1), quad.depth],
        greatest: [clip(quad.x1), -clip(quad.y0), quad.depth],
    };
    let objects: Vec<ObjectBox> = quads.iter().map(around).collect();
    block_on(&stage.device, seen.set_objects(&objects)).unwrap().unwrap();
    let asked = RefCell::new(Vec::new());
    for _ in 0..2 {
        asked.borrow_mut().clear();
        let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
        let buffer = vertex_buffer(&stage, &vertices(&quads, seen.vertex_inputs()));
        let [r, g, b] = BACKGROUND;
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
        let mut draw = |pass: &mut wgpu::RenderPass<'_>, call: &fragbuf_runtime::Call<'_>| {
            pass.set_vertex_buffer(0, buffer.slice(..));
            let objects = call.objects.expect("objects are said");
            asked.borrow_mut().push(objects.len());
            objects.iter().for_each(|object| pass.draw(6 * object..6 * object + 6, 0..1));
        };
        seen.render(&output, &mut draw).unwrap();
        assert_eq!(offscreen.colors(&stage.device, &stage.queue).unwrap(), expected);
        let asked = asked.borrow();
        assert!(asked.is_sorted_by(|a, b| a >= b), "nothing comes back: {asked:?}");
        assert!(asked[0] == quads.len() && asked[asked.len() - 1] == 0, "{asked:?}");
    }
    // Fragments are drawn as often as their objects are asked for, and no more of them pass.
    assert!(drawn(&stage, &seen) <= drawn(&stage, &plain));
}

/// The deepest pixel's fragments, from a histogram.
fn deepest(call: &HostCall<'_>) -> Vec<u64> {
    let last = call.reads[0].iter().rposition(|pixels| *pixels > 0).unwrap_or(0);
    vec![(last as u64).max(1)]
}

fn by_histogram() -> Registry {
    let histogram = Pass::compute("histogram", "histogram", "ceil_div(pixels, 64)", "1")
        .uses("counts", Access::Read)
        .uses("bins", Access::Atomic);
    let decide = Host::new("deepest").reads_all("bins").sets("k");
    let row = Row {
        edits: vec![
            Edit::AddResource(Resource::new("bins", Element::Word, "pixels by fragments").by("bin", "64").cleared(0)),
            Edit::After("count".to_owned(), vec![Step::Pass(histogram), Step::Host(decide)]),
        ],
        ..Row::new("select", "by_histogram", "", "")
    };
    let choices = vec![("storage", "bounded_regions"), ("sync", "spin_lock"), ("select", "by_histogram")];
    registry(row, &[("histogram", HISTOGRAM)], choices, KeepDefault::Best(16))
        .with(Row { host: Some(HostFunction(deepest)), ..Row::new("host", "deepest", "", "") })
}

#[test]
fn the_host_reads_a_histogram_and_sets_k() {
    let stage = device();
    let registry = by_histogram();
    let plan = plan(&tried(&registry), &Selection::first(&tried(&registry)), &registry).unwrap();
    assert_eq!(plan.frame.decisions().count(), 2, "one for k, one for the memory of what is kept");
    let mut renderer = renderer(&stage, &shaders(&registry), &settings()).unwrap();
    block_on(&stage.device, renderer.set_k(1)).unwrap().unwrap();
    for count in [12, 3, 7] {
        let quads: Vec<Quad> = layers().into_iter().take(count).collect();
        let (pixels, _) = draw(&stage, &mut renderer, &quads);
        let deepest = pixels_of_the_frame().map(|(x, y)| fragments(&quads, x, y).len()).max().unwrap() as u32;
        assert_eq!(renderer.k(), Some(deepest));
        assert!(is_right(&pixels, &quads));
    }
}

#[test]
fn a_host_that_decides_what_there_is_not_is_an_error() {
    let stage = device();
    let registry =
        by_histogram().with(Row { host: Some(HostFunction(|_| vec![17])), ..Row::new("host", "deepest", "", "") });
    let mut renderer = renderer(&stage, &shaders(&registry), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
    let error = renderer.render(&output, &mut |_, _| {}).unwrap_err().to_string();
    assert!(error.contains("`k`, which the host function `deepest` sets to 17, must be from 1 to 16"), "{error}");
}
