//! Features of frames that no built-in technique uses: exchanged resources, loops that end on an occlusion query, objects with boxes,
//! a host step that reads many words and sets k. The rows are those of the tests, on the driver; the CPU device runs the same
//! commands in `backends/run/cpu/tests`.

use std::collections::BTreeMap;

use fragbuf_codegen::{Form, plan};
use fragbuf_model::{Draft, Selection, SourceSpan, Variant, check};
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{
    LoopEnd, LoopReport, ObjectBox, Output, PoolSize, Renderer, Settings, Shaders, Sizing, block_on,
};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Blend, Capability, Compare, Edit, Element, Host, HostCall, HostFunction, KeepDefault, Objects, Pass,
    Repeat, Resource, Row, Step, Technique, Template, TextureFormat,
};

use crate::capture::scattered;
use crate::oracle::{PLAIN, fragments, image, pixels as pixels_of_the_frame};
use crate::peeling_loop::{BLEND, PEEL, depth, peeling_loop, peeling_resources};
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{BACKGROUND, FORMAT, device, renderer, settings, vertex_buffer};

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

/// Front-to-back peeling: loops, each of which begins with an empty `sum`, and a pass that shows the sum of the last.
fn peeling(loops: Vec<Repeat>) -> Row {
    let put = Pass::fullscreen("put", "put").uses("sum", Access::Sampled).target("output", Blend::Over);
    let clear = |resource: &str| Step::Clear { resource: resource.to_owned(), value: 0 };
    let mut steps = Vec::new();
    for repeat in loops {
        steps.extend([clear("last"), clear("sum"), Step::Repeat(repeat)]);
    }
    steps.push(Step::Pass(put));
    let sum = Resource::new("sum", Element::Texture(TextureFormat::Rgba16Float), "").by("pixel", "pixels");
    Row {
        resources: [peeling_resources(), vec![sum]].concat(),
        steps,
        provides: vec![Capability::KeepsAll, Capability::FixedFunction, Capability::Sorted],
        ..Row::new("storage", "tested", "", "")
    }
}

/// Returns one loop that draws everything.
fn whole_scene(name: &str, at_most: &'static str) -> Repeat {
    peeling_loop(name, at_most, Objects::All, None, "sum")
}

/// Returns a loop that draws the objects whose boxes are not behind the peeled layers.
fn visible_objects(name: &str) -> Repeat {
    let mut boxes = Pass::geometry("boxes", "boxes");
    boxes.state.depth = depth("last", Compare::Greater, false);
    let boxes = Pass { objects: Objects::Boxes, ..boxes };
    peeling_loop(name, "64", Objects::Visible("boxes".to_owned()), Some(boxes), "sum")
}

/// Returns the registry with a storage, or another row, and the skeletons of its passes.
fn registry(
    row: Row,
    skeletons: &[(&str, &str)],
    choices: Vec<(&'static str, &'static str)>,
    keep: KeepDefault,
) -> Registry {
    let technique = Technique { key: "tested".to_owned(), title: "", paper: "", summary: "", keep, choices };
    let skeletons = skeletons.iter().map(|(key, source)| Row {
        template: Some(Template::new(format!("pass/{key}.wgsl"), (*source).to_owned())),
        calls: vec!["addressing"],
        ..Row::new("pass", key, "", "")
    });
    let registry =
        Registry::builtin().with(row).with(Row::new("sync", "as_it_comes", "", "")).with_technique(technique);
    skeletons.fold(registry, Registry::with)
}

fn tested(registry: &Registry) -> Variant {
    let draft = Draft::from_technique("tested", &SourceSpan::new("tested", 1, 1));
    check(&draft, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

fn shaders(registry: &Registry) -> Shaders {
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation =
        generate(&tested(registry), &request, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    Shaders::from_generation(&generation, "wgsl", 0).unwrap()
}

fn peeling_shaders(loops: Vec<Repeat>) -> Shaders {
    let skeletons = [("peel", PEEL), ("blend", BLEND), ("put", PUT), ("boxes", BOXES)];
    let choices = vec![("storage", "tested"), ("sync", "as_it_comes")];
    shaders(&registry(peeling(loops), &skeletons, choices, KeepDefault::All))
}

/// The results of a frame.
struct PeeledFrame {
    pixels: Vec<[f32; 4]>,
    loops: Vec<LoopReport>,
    /// The number of objects of each draw, by pass.
    requested: BTreeMap<String, Vec<usize>>,
}

/// Renders quads over the background. Each draw covers the requested objects, or all.
fn draw(stage: &Headless, renderer: &mut Renderer, quads: &[Quad]) -> PeeledFrame {
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let buffer = vertex_buffer(stage, &vertices(quads, renderer.vertex_inputs()));
    let [r, g, b] = BACKGROUND;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
    let all: Vec<u32> = (0..quads.len() as u32).collect();
    let mut requested: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let loops = renderer.render(&output, &mut |pass, call| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        let objects = call.objects.unwrap_or(&all);
        requested.entry(call.pass.name.clone()).or_default().push(objects.len());
        objects.iter().for_each(|object| pass.draw(6 * object..6 * object + 6, 0..1));
    });
    PeeledFrame { pixels: offscreen.colors(&stage.device, &stage.queue).unwrap(), loops: loops.unwrap(), requested }
}

fn drawn(stage: &Headless, renderer: &Renderer) -> u32 {
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let words = renderer.words("drawn", &mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    words.wait(&stage.device).unwrap()[0]
}

/// Whether an image is that of all fragments in depth order. Half floats round each layer.
fn is_right(pixels: &[[f32; 4]], quads: &[Quad]) -> bool {
    let expected = image(&PLAIN, quads, None, BACKGROUND);
    let is_near = |(a, b): (&f32, &f64)| (f64::from(*a) - b).abs() < 2.0 / 255.0;
    pixels.iter().zip(&expected).all(|(seen, wanted)| seen.iter().zip(wanted).all(is_near))
}

/// Returns quads of different depths, because peeling keeps one of several equal depths.
fn layers() -> Vec<Quad> {
    let mut quads = scattered(12, 5);
    for (number, quad) in quads.iter_mut().enumerate() {
        quad.depth = 0.05 + 0.9 * (number * 5 % 12) as f32 / 12.0;
    }
    quads
}

#[test]
fn exchanged_resources_and_a_loop_on_an_occlusion_query_peel_the_scene() {
    let stage = device();
    let quads = layers();
    let mut exact = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "64")]), &settings()).unwrap();
    // A second frame begins like the first, and each slice has its own iterations.
    for _ in 0..2 {
        let PeeledFrame { pixels, loops, .. } = draw(&stage, &mut exact, &quads);
        assert!(is_right(&pixels, &quads));
        let [looped] = loops.as_slice() else { panic!("{loops:?}") };
        assert_eq!((looped.until.as_str(), looped.end), ("no sample passes in `peel`", LoopEnd::ConditionMet));
        assert!((4..64).contains(&looped.iterations), "{looped:?}");
    }
    let sliced = Settings { slice: Some(5), ..settings() };
    let mut sliced = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "64")]), &sliced).unwrap();
    assert!(is_right(&draw(&stage, &mut sliced, &quads).pixels, &quads));
}

#[test]
fn with_reserved_memory_a_loop_runs_to_its_limit() {
    let stage = device();
    let quads = layers();
    let reserved = Settings { sizing: Sizing::Reserve(PoolSize::Fragments(1)), ..settings() };
    let mut whole = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "12")]), &reserved).unwrap();
    let PeeledFrame { pixels, loops, .. } = draw(&stage, &mut whole, &quads);
    assert!(is_right(&pixels, &quads) && loops.is_empty());
    // With readbacks a limit that is reached first is reported.
    let mut limited = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "2")]), &settings()).unwrap();
    let PeeledFrame { pixels, loops, .. } = draw(&stage, &mut limited, &quads);
    assert_eq!((loops[0].iterations, loops[0].end), (2, LoopEnd::LimitReached));
    assert!(!is_right(&pixels, &quads));
}

/// Returns the boxes around quads.
fn boxes_around(quads: &[Quad]) -> Vec<ObjectBox> {
    let clip = |pixel: u32| pixel as f32 / (SIZE / 2) as f32 - 1.0;
    let around = |quad: &Quad| ObjectBox {
        least: [clip(quad.x0), -clip(quad.y1), quad.depth],
        greatest: [clip(quad.x1), -clip(quad.y0), quad.depth],
    };
    quads.iter().map(around).collect()
}

/// Checks the numbers of objects that the draws of a loop request: all at first, then fewer and fewer. The margin of the boxes keeps
/// those of the last layers.
fn assert_peeled(requested: &[usize], quads: &[Quad]) {
    assert!(requested.is_sorted_by(|a, b| a >= b), "a dropped object returns: {requested:?}");
    assert!(requested[0] == quads.len() && requested[requested.len() - 1] <= quads.len() / 3, "{requested:?}");
}

#[test]
fn objects_whose_boxes_are_peeled_away_are_not_drawn_again() {
    let stage = device();
    let quads = layers();
    let mut plain = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "64")]), &settings()).unwrap();
    let expected = draw(&stage, &mut plain, &quads).pixels;
    let mut culled = renderer(&stage, &peeling_shaders(vec![visible_objects("peel")]), &settings()).unwrap();
    // Without boxes the scene is one object.
    assert_eq!(draw(&stage, &mut culled, &quads).pixels, expected);
    block_on(&stage.device, culled.set_objects(&boxes_around(&quads))).unwrap().unwrap();
    for _ in 0..2 {
        let frame = draw(&stage, &mut culled, &quads);
        assert_eq!(frame.pixels, expected);
        assert_peeled(&frame.requested["peel"], &quads);
    }
    // The fragments of dropped objects would fail anyway, so the number of stored fragments cannot grow.
    assert!(drawn(&stage, &culled) <= drawn(&stage, &plain));
}

/// The query of the first loop's pass comes before those of the second loop's pass and of the boxes.
#[test]
fn a_frame_may_have_queries_of_two_loops_and_of_boxes() {
    let stage = device();
    let quads = layers();
    let mut plain = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "64")]), &settings()).unwrap();
    let expected = draw(&stage, &mut plain, &quads);
    let loops = vec![whole_scene("peel", "64"), visible_objects("peel_visible")];
    let mut both = renderer(&stage, &peeling_shaders(loops), &settings()).unwrap();
    block_on(&stage.device, both.set_objects(&boxes_around(&quads))).unwrap().unwrap();
    for _ in 0..2 {
        let frame = draw(&stage, &mut both, &quads);
        assert_eq!(frame.pixels, expected.pixels);
        let [first, second] = frame.loops.as_slice() else { panic!("{:?}", frame.loops) };
        assert_eq!((first, second.end), (&expected.loops[0], LoopEnd::ConditionMet));
        assert_eq!(
            (second.until.as_str(), second.iterations),
            ("no sample passes in `peel_visible`", first.iterations)
        );
        assert_eq!(frame.requested["peel"], vec![quads.len(); first.iterations as usize]);
        assert_peeled(&frame.requested["peel_visible"], &quads);
    }
}

/// Returns the number of fragments of the deepest pixel, from a histogram.
fn deepest(call: &HostCall<'_>) -> Result<Vec<u64>, String> {
    let last = call.reads[0].iter().rposition(|pixels| *pixels > 0).unwrap_or(0);
    Ok(vec![(last as u64).max(1)])
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
    let plan = plan(&tested(&registry), &Selection::first(&tested(&registry)), &registry).unwrap();
    assert_eq!(plan.frame.decisions().count(), 2, "one for k, one for the memory of the kept fragments");
    let mut renderer = renderer(&stage, &shaders(&registry), &settings()).unwrap();
    block_on(&stage.device, renderer.set_k(1)).unwrap().unwrap();
    for count in [12, 3, 7] {
        let quads: Vec<Quad> = layers().into_iter().take(count).collect();
        let pixels = draw(&stage, &mut renderer, &quads).pixels;
        let deepest = pixels_of_the_frame().map(|(x, y)| fragments(&quads, x, y).len()).max().unwrap() as u32;
        assert_eq!(renderer.k(), Some(deepest));
        assert!(is_right(&pixels, &quads));
    }
}

#[test]
fn a_host_step_that_sets_a_value_out_of_range_is_an_error() {
    let stage = device();
    let registry =
        by_histogram().with(Row { host: Some(HostFunction(|_| Ok(vec![17]))), ..Row::new("host", "deepest", "", "") });
    let mut renderer = renderer(&stage, &shaders(&registry), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
    let error = renderer.render(&output, &mut |_, _| {}).unwrap_err().to_string();
    assert!(error.contains("`k`, which the host function `deepest` sets to 17, must be from 1 to 16"), "{error}");
}

/// Each slice culls its own objects: what is hidden in one slice may be visible in the next.
#[test]
fn objects_are_culled_per_slice() {
    let stage = device();
    let quads = layers();
    let mut plain = renderer(&stage, &peeling_shaders(vec![whole_scene("peel", "64")]), &settings()).unwrap();
    let expected = draw(&stage, &mut plain, &quads).pixels;
    let sliced = Settings { slice: Some(5), ..settings() };
    let mut culled = renderer(&stage, &peeling_shaders(vec![visible_objects("peel")]), &sliced).unwrap();
    block_on(&stage.device, culled.set_objects(&boxes_around(&quads))).unwrap().unwrap();
    assert_eq!(draw(&stage, &mut culled, &quads).pixels, expected);
}
