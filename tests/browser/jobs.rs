//! The jobs of the scripts: plans with scenes, settings and the expected images.
//!
//! Scenes are quads, two triangles each, of constant depth; some have equal depths. The scripts get files, so that this module needs no
//! device.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use fragbuf::vocabulary::{
    Access, Blend, Capability, Element, KeepDefault, Objects, Pass, Resource, Row, Step, Technique, Template,
    TextureFormat,
};
use fragbuf::{
    Draft, Form, Generation, Plan, Registry, Request, SourceSpan, TextureDimension, Variant, generate, manifest, target,
};
use fragbuf_cpu::{Code, Device, Mesh, Settings};
use fragbuf_frame::{Decisions, PoolSize, Sizing, Value as Uniform};
use fragbuf_model::UniformType;
use serde_json::{Value, json};

use super::cpu_image::{is_exact, shown};
use super::lookups::lookups;
use super::numbers::Numbers;
use super::peeling_loop;
use super::scene::{Quad, image, over_background, quads};
use crate::cases::named;

/// The width and height of each frame.
const SIZE: [u32; 2] = [37, 23];

/// The quads of a scene: as many fragments per pixel as memory is reserved for.
const QUADS: u32 = 8;

/// The drawing orders of a job.
const ORDERS: usize = 3;

const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];

/// A plan with the scenes that a script draws.
pub struct Job {
    pub name: String,
    generation: Generation,
    /// The vertices of each scene, and the boxes of its quads.
    scenes: Vec<(Vec<u8>, Vec<Quad>)>,
    runs: Vec<Value>,
    uniforms: Value,
    /// External textures: name, format, and a number per pixel.
    textures: Vec<External>,
    /// Textures of the description: name, columns, rows and slices, texels.
    described: Vec<Described>,
    pub drops_objects: bool,
    /// What each run shows.
    pub expected: Vec<Expected>,
}

type External = (String, &'static str, Vec<f32>);

type Described = (String, TextureDimension, [u32; 3], Vec<[f32; 4]>);

/// What a run shows.
pub struct Expected {
    pub what: String,
    pub images: Vec<Vec<[f64; 3]>>,
    pub slices: u64,
    pub loses_nothing: bool,
    /// The passes that have times; empty where no times are requested.
    pub timed: BTreeSet<String>,
}

/// The runs of a job.
pub enum Runs {
    /// One frame.
    Whole,
    /// Every order as whole frames, and one in slices; without waiting for the device; with decisions that lag.
    All,
}

/// Where the expected images come from.
#[derive(Clone, Copy, PartialEq)]
enum Judge {
    /// The reference, unless the plan states that it loses fragments: then the CPU device.
    Reference,
    CpuDevice,
}

/// Returns every job.
pub fn all() -> Vec<Job> {
    let mut jobs = techniques(&Runs::All);
    for (name, description, set) in named() {
        let variant = crate::cases::checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let runs = runs_of(&variant);
        jobs.extend(job(&format!("case {name}"), &variant, (&Registry::builtin(), Judge::CpuDevice), &runs));
    }
    for key in ["k_peeling", "f2b", "dual_ll", "dual_2p"] {
        let variant = technique(key, &[("objects", "unpeeled")]);
        jobs.extend(job(
            &format!("{key}, unpeeled objects"),
            &variant,
            (&Registry::builtin(), Judge::CpuDevice),
            &Runs::All,
        ));
    }
    for (number, lookup) in lookups().into_iter().enumerate() {
        let name = format!("{} {number}", lookup.name);
        let runs = runs_of(&lookup.variant);
        jobs.extend(job(&name, &lookup.variant, (&Registry::builtin(), Judge::CpuDevice), &runs));
    }
    let registry = peeling_registry();
    let draft = Draft::from_technique("peeled", &SourceSpan::new("peeled", 1, 1));
    let variant = fragbuf::check(&draft, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    jobs.extend(job("a loop until no sample passes", &variant, (&registry, Judge::CpuDevice), &Runs::All));
    jobs
}

/// Returns the runs of a description. A frame with images has no slices.
fn runs_of(variant: &Variant) -> Runs {
    if variant.images.is_empty() { Runs::All } else { Runs::Whole }
}

/// Returns a job for every technique that portable WGSL can express.
pub fn techniques(runs: &Runs) -> Vec<Job> {
    let registry = Registry::builtin();
    let jobs = registry.techniques().iter().filter_map(|row| {
        let k = match row.keep {
            KeepDefault::All => None,
            KeepDefault::Best(most) => Some(most.min(4).to_string()),
        };
        let set: Vec<(&str, &str)> = k.iter().map(|k| ("k", k.as_str())).collect();
        job(&row.key, &technique(&row.key, &set), (&registry, Judge::Reference), runs)
    });
    jobs.collect()
}

fn technique(key: &str, set: &[(&str, &str)]) -> Variant {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    set.iter().for_each(|(name, value)| draft.set(name, value, &span).unwrap());
    fragbuf::check(&draft, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{key}: {diagnostics}"))
}

/// The skeleton of the pass that draws all layers over the target.
const COMPOSITE: &str = "
@fragment
fn composite_layers(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return peeled_layers_load(pixel_index(position.xy));
}
";

/// Returns rows whose loop ends when no sample passes: front-to-back peeling (Everitt 2001) with textures that are exchanged.
fn peeling_registry() -> Registry {
    let skeleton = |key: &str, source: &'static str| Row {
        template: Some(Template::new("test.wgsl", source)),
        calls: vec!["addressing"],
        ..Row::new("pass", key, "", "")
    };
    let layers = Resource::new("peeled_layers", Element::Texture(TextureFormat::Rgba16Float), "").by("pixel", "pixels");
    let composite = Pass::fullscreen("composite_layers", "composite_layers").uses("peeled_layers", Access::Sampled);
    let storage = Row {
        resources: [peeling_loop::peeling_resources(), vec![layers.cleared(0)]].concat(),
        steps: vec![
            Step::Repeat(peeling_loop::peeling_loop("peel", "64", Objects::All, None, "peeled_layers")),
            Step::Pass(composite.target("output", Blend::Over)),
        ],
        provides: vec![Capability::KeepsAll, Capability::KeepsBest, Capability::Sorted],
        ..Row::new("storage", "peeled", "", "")
    };
    Registry::builtin()
        .with(Row::new("sync", "unsynchronised", "", ""))
        .with(skeleton("peel", peeling_loop::PEEL))
        .with(skeleton("blend", peeling_loop::BLEND))
        .with(skeleton("composite_layers", COMPOSITE))
        .with(storage)
        .with_technique(Technique {
            key: "peeled".to_owned(),
            title: "",
            paper: "",
            summary: "",
            keep: KeepDefault::All,
            choices: vec![("storage", "peeled"), ("sync", "unsynchronised")],
        })
}

/// Returns the job of a variant; `None` if portable WGSL lacks a feature that it needs.
fn job(name: &str, variant: &Variant, (registry, judge): (&Registry, Judge), runs: &Runs) -> Option<Job> {
    let wgsl = target("wgsl").unwrap();
    let request = Request { targets: &[wgsl], form: Form::Program, prefix: "", group: 0 };
    let generation =
        generate(variant, &request, registry).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
    let plan = &generation.plans.first()?.plan;
    let inputs = manifest(&generation, 0)["vertex_inputs"].clone();
    let mut numbers = Numbers::seeded(7);
    let mut quads = quads(QUADS, SIZE, &mut numbers);
    let mut scenes = Vec::new();
    for _ in 0..ORDERS {
        scenes.push((vertices(&quads, &inputs), quads.clone()));
        numbers.shuffle(&mut quads);
    }
    let (textures, described) = (textures(plan), described(variant));
    let loses_nothing =
        judge == Judge::Reference && !plan.hazards.iter().any(|hazard| hazard.permits.shows()) && is_exact(plan);
    let run = |what: &str, scenes: &[(Vec<u8>, Vec<Quad>)], slice: Option<u32>, sizing: Sizing, options: Value| {
        let decisions = if options["readback"] == "lag" { Decisions::LAGGED } else { Decisions::Immediate };
        let settings = Settings { slice, sizing, decisions, ..Settings::new(SIZE[0], SIZE[1]) };
        let images = images((variant, registry), judge, plan, scenes, (&textures, &described), settings);
        let slices = slice.map_or(1, |rows| u64::from(SIZE[1].div_ceil(rows)));
        let numbers: Vec<usize> = (0..scenes.len()).collect();
        // Without readbacks, boxes of objects are not drawn.
        let has_boxes = options["readback"] != "none";
        let drawn = plan.passes.iter().filter(|pass| has_boxes || pass.objects != Objects::Boxes);
        let timed = drawn.filter(|_| options["times"] == true).map(|pass| pass.name.clone()).collect();
        let expected = Expected { what: what.to_owned(), images, slices, loses_nothing, timed };
        (json!({ "scenes": numbers, "options": options }), expected)
    };
    let mut all = Vec::new();
    match runs {
        Runs::Whole => all.push(run("whole", &scenes[..1], None, Sizing::Auto, json!({ "times": true }))),
        Runs::All => {
            all.push(run("whole", &scenes, None, Sizing::Auto, json!({})));
            all.push(run("slices", &scenes[..1], Some(5), Sizing::Auto, json!({ "rows": 5, "times": true })));
            let is_conditional = |until| until != fragbuf_codegen::LoopUntil::Times;
            // A loop of a thousand iterations takes its time on a processor.
            if !plan.frame.loops.iter().any(|looped| is_conditional(looped.until)) {
                let sizing = Sizing::Reserve(PoolSize::Fragments(QUADS * SIZE[0] * SIZE[1]));
                all.push(run("no readback", &scenes[..2], None, sizing, json!({ "readback": "none", "times": true })));
            }
            if plan.frame.decisions().any(|decision| decision.may_lag) {
                all.push(run("decisions that lag", &scenes, None, Sizing::Auto, json!({ "readback": "lag" })));
                let options = json!({ "readback": "lag", "rows": 5 });
                all.push(run("decisions that lag, in slices", &scenes, Some(5), Sizing::Auto, options));
            }
        }
    }
    let (runs, expected) = all.into_iter().unzip();
    let drops_objects = plan.passes.iter().any(|pass| pass.objects == Objects::Boxes);
    let uniforms =
        plan.variant.uniforms.iter().map(|uniform| (uniform.name.value.clone(), uniform_value(uniform.kind.value).1));
    let uniforms = uniforms.collect::<serde_json::Map<_, _>>().into();
    Some(Job {
        name: name.to_owned(),
        generation,
        scenes,
        runs,
        uniforms,
        textures,
        described,
        drops_objects,
        expected,
    })
}

/// Writes the files of jobs into a folder, and their list into `list`.
pub fn write(jobs: &[Job], folder: &Path, list: &str) {
    let put = |path: String, bytes: &[u8]| {
        let file = folder.join(&path);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, bytes).unwrap();
        path
    };
    let values = jobs.iter().enumerate().map(|(number, job)| {
        let path = |name: &str| format!("{number}/{name}");
        write_plan(&job.generation, &folder.join(number.to_string()));
        let scenes = job.scenes.iter().enumerate().map(|(scene, (bytes, quads))| {
            let vertices = put(path(&format!("{scene}.bin")), bytes);
            let objects = job.drops_objects.then(|| quads.iter().map(object).collect::<Vec<Value>>());
            json!({ "vertices": vertices, "count": 6 * quads.len(), "objects": objects })
        });
        let scenes: Vec<Value> = scenes.collect();
        let textures = job.textures.iter().map(|(name, format, texels)| {
            let bytes: Vec<u8> = texels.iter().flat_map(|texel| texel.to_le_bytes()).collect();
            json!({ "name": name, "format": format, "file": put(path(&format!("{name}.bin")), &bytes) })
        });
        let described = job.described.iter().map(|(name, dimension, size, texels)| {
            let bytes: Vec<u8> = texels.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
            let file = put(path(&format!("{name}.bin")), &bytes);
            json!({ "name": name, "dimension": dimension.keyword(), "size": size, "file": file })
        });
        let textures: Vec<Value> = textures.chain(described).collect();
        json!({
            "name": job.name, "folder": number.to_string(), "size": SIZE, "background": BACKGROUND, "symbols": {},
            "uniforms": job.uniforms, "textures": textures, "scenes": scenes, "runs": job.runs,
        })
    });
    let values: Vec<Value> = values.collect();
    std::fs::write(folder.join(list), Value::from(values).to_string()).unwrap();
}

/// Writes a manifest and its files, as `fragbuf generate` does.
pub fn write_plan(generation: &Generation, folder: &Path) {
    let put = |path: &str, bytes: &[u8]| {
        let file = folder.join(path);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, bytes).unwrap();
    };
    put("manifest.json", manifest(generation, 0).to_string().as_bytes());
    generation.files.iter().for_each(|file| put(&file.path, &file.bytes));
}

/// Returns the box of a quad in clip space.
fn object(quad: &Quad) -> Value {
    let x = quad.x.map(|x| 2.0 * x as f32 / SIZE[0] as f32 - 1.0);
    let y = quad.y.map(|y| 1.0 - 2.0 * y as f32 / SIZE[1] as f32);
    json!({ "least": [x[0], y[1], quad.depth], "greatest": [x[1], y[0], quad.depth] })
}

/// Returns the vertices of two triangles per quad. Attributes are constant in each.
fn vertices(quads: &[Quad], inputs: &Value) -> Vec<u8> {
    let mut bytes = Vec::new();
    for quad in quads {
        let [left, right] = quad.x.map(|x| 2.0 * x as f32 / SIZE[0] as f32 - 1.0);
        let [top, bottom] = quad.y.map(|y| 1.0 - 2.0 * y as f32 / SIZE[1] as f32);
        for [x, y] in [[left, top], [left, bottom], [right, bottom], [left, top], [right, bottom], [right, top]] {
            for input in inputs.as_array().unwrap() {
                let numbers = match (input["location"].as_u64().unwrap(), input["name"].as_str().unwrap()) {
                    (0, _) => vec![x, y, quad.depth],
                    (_, "color") => quad.color.map(|channel| f32::from(channel) / 255.0).to_vec(),
                    (_, "normal") => vec![0.0, 0.0, 1.0],
                    (_, name) => attribute(name, input["type"].as_str().unwrap(), quad.id),
                };
                bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            }
        }
    }
    bytes
}

/// Returns the components of another attribute, different for each quad.
fn attribute(name: &str, kind: &str, id: u32) -> Vec<f32> {
    if kind.contains("32>") || kind == "f32" {
        let components = kind.strip_prefix("vec").map_or(1, |rest| rest[..1].parse().unwrap());
        let number = |component: u32| ((5 * id + name.len() as u32 + 3 * component) % 11) as f32 / 11.0;
        return (0..components).map(number).collect();
    }
    vec![f32::from_bits(id)]
}

/// Returns a value for a uniform, for the CPU device and for the script.
fn uniform_value(kind: UniformType) -> (Uniform, Value) {
    let numbers = [0.25_f32, 0.5, 0.75, 1.0];
    let [x, y, z, w] = numbers;
    match kind {
        UniformType::F32 => (Uniform::F32(x), json!(x)),
        UniformType::U32 => (Uniform::U32(3), json!(3)),
        UniformType::I32 => (Uniform::I32(-2), json!(-2)),
        UniformType::Vec2 => (Uniform::Vec2([x, y]), json!([x, y])),
        UniformType::Vec3 => (Uniform::Vec3([x, y, z]), json!([x, y, z])),
        UniformType::Vec4 => (Uniform::Vec4(numbers), json!([x, y, z, w])),
    }
}

/// Returns a number per pixel for each external texture of a plan.
fn textures(plan: &Plan) -> Vec<External> {
    let is_of_plan =
        |planned: &&fragbuf_codegen::PlannedResource| planned.is_external() && !planned.is_of_description();
    let external = plan.resources.iter().filter(is_of_plan);
    let texture = external.map(|planned| {
        let name = planned.resource.name.clone();
        let format = if name == "opaque" { "depth32float" } else { "r32float" };
        let texels = (0..SIZE[0] * SIZE[1]).map(|pixel| (pixel * 7 % 16) as f32 / 16.0 + 1.0 / 32.0);
        (name, format, texels.collect())
    });
    texture.collect()
}

/// Returns texels for each texture of a description.
fn described(variant: &Variant) -> Vec<Described> {
    let mut numbers = Numbers::seeded(11);
    let texture = |texture: &fragbuf::Texture| {
        let size = if texture.dimension.value == TextureDimension::D2 { [3, 2, 1] } else { [3, 2, 4] };
        let count = size.iter().product::<u32>();
        let texels = (0..count).map(|_| std::array::from_fn(|_| numbers.below(1000) as f32 / 1000.0)).collect();
        (texture.name.value.clone(), texture.dimension.value, size, texels)
    };
    variant.textures.iter().map(texture).collect()
}

/// Returns the image of each scene.
fn images(
    (variant, registry): (&Variant, &Registry),
    judge: Judge,
    plan: &Plan,
    scenes: &[(Vec<u8>, Vec<Quad>)],
    (textures, described): (&[External], &[Described]),
    settings: Settings,
) -> Vec<Vec<[f64; 3]>> {
    if judge == Judge::Reference && is_exact(plan) {
        let expected = |(_, quads): &(Vec<u8>, Vec<Quad>)| image(quads, SIZE, shown(plan, variant.keep), BACKGROUND);
        return scenes.iter().map(expected).collect();
    }
    let code = Code::of(variant, registry).unwrap_or_else(|error| panic!("{error}"));
    let mut device = Device::new(Arc::new(code), settings).unwrap();
    for uniform in &variant.uniforms {
        device.set_uniform(&uniform.name.value, uniform_value(uniform.kind.value).0).unwrap();
    }
    textures.iter().for_each(|(name, _, texels)| device.set_texture(name, texels).unwrap());
    for (name, _, size, texels) in described {
        device.set_description_texture(name, *size, texels).unwrap();
    }
    let image = |(bytes, quads): &(Vec<u8>, Vec<Quad>)| {
        let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
        let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
        picture.pixels.iter().map(|pixel| over_background(pixel.map(f64::from), BACKGROUND)).collect()
    };
    scenes.iter().map(image).collect()
}
