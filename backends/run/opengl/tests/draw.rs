//! Draws a variant by OpenGL or OpenGL ES, in program or module form, and compares the image with the expected one.

use fragbuf_codegen::{Arrival, Form, Plan};
use fragbuf_model::{MissingFeature, Variant};
use fragbuf_opengl_host::{Api, Context, Error, Host, Scene};
use fragbuf_targets::{Generation, Request, generate, manifest, target};
use fragbuf_templates::Registry;

use crate::hosts::numbers::Numbers;
use crate::hosts::scene::{Quad, first_difference, quads, vertices};
use crate::hosts::technique::{BACKGROUND, IDENTITY, is_parallel, objects, on_cpu, reference};
use crate::material::material;

/// The depth of the opaque surface of tests, which covers the frame. Fragments behind it are hidden.
const OPAQUE: f32 = 0.5;

/// Why a variant was not drawn.
pub enum NotDrawn {
    /// The target cannot express it.
    Unsupported(MissingFeature),
    /// The driver or the host lacks something.
    Failed(Error),
}

impl From<Error> for NotDrawn {
    fn from(error: Error) -> Self {
        NotDrawn::Failed(error)
    }
}

impl std::fmt::Display for NotDrawn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            NotDrawn::Unsupported(missing) => missing.fmt(f),
            NotDrawn::Failed(error) => error.fmt(f),
        }
    }
}

pub fn context(api: Api) -> Context {
    let context = Context::open(api);
    context.unwrap_or_else(|error| panic!("{error}; install Debian's packages libegl1 and libgl1-mesa-dri"))
}

/// Generates the passes of a variant for the target of an API.
pub fn generated(api: Api, form: Form, variant: &Variant, registry: &Registry) -> Result<Generation, NotDrawn> {
    let prefix = if form == Form::Module { "glass" } else { "" };
    let request = Request { targets: &[target(api.target()).unwrap()], form, prefix, group: 0 };
    let mut generation = generate(variant, &request, registry).map_err(|error| Error(error.to_string()))?;
    match generation.unsupported.pop() {
        Some((_, missing)) => Err(NotDrawn::Unsupported(missing)),
        None => Ok(generation),
    }
}

/// Opens a host for generated passes. A module gets a material with the attributes of the variant.
pub fn host<'c>(context: &'c Context, generation: &Generation, size: [u32; 2]) -> Result<Host<'c>, Error> {
    let manifest = manifest(generation, 0).to_string();
    let read = |path: &str| read(generation, path);
    match generation.form {
        Form::Program => Host::new(context, &manifest, &read, size),
        Form::Module => {
            let material = material(&generation.plans[0].plan.variant, &generation.prefix);
            Host::with_material(context, &manifest, &read, size, &material)
        }
    }
}

pub fn read(generation: &Generation, path: &str) -> Result<String, Error> {
    let file = generation.files.iter().find(|file| file.path == path).unwrap();
    Ok(String::from_utf8(file.bytes.clone()).unwrap())
}

pub fn inputs(host: &Host<'_>) -> Vec<String> {
    host.vertex_inputs().iter().map(|input| input.name.clone()).collect()
}

/// Draws quads. In module form the colours of vertices are those that the material turns into the colours of the quads.
pub fn render(host: &mut Host<'_>, form: Form, quads: &[Quad], size: [u32; 2]) -> Result<Vec<[f32; 4]>, Error> {
    // Pools that no step of the frame sizes have room for every fragment.
    host.set_symbol("fragments", quads.len() as u64 * u64::from(size[0] * size[1]))?;
    let names: Vec<String> = host.external_textures().map(str::to_owned).collect();
    for name in names {
        host.set_texture(&name, &external(&name, size))?;
    }
    let inputs = inputs(host);
    let mut quads = quads.to_vec();
    if form == Form::Module {
        quads.iter_mut().for_each(|quad| quad.color.swap(0, 2));
    }
    let vertices = vertices(&quads, size, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let objects = objects(&quads);
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    let [r, g, b] = BACKGROUND.map(|channel| channel as f32);
    Ok(host.render(&scene, [r, g, b, 1.0])?.pixels)
}

/// Returns the texels of an external texture. With the greatest importance every pixel keeps k fragments.
fn external(name: &str, size: [u32; 2]) -> Vec<f32> {
    let texel = if name == "opaque" { OPAQUE } else { 1.0 };
    vec![texel; (size[0] * size[1]) as usize]
}

/// Returns the expected image: that of the reference where it applies, or that of the CPU device.
pub fn expected(plan: &Plan, host: &Host<'_>, quads: &[Quad], k: Option<u32>, size: [u32; 2]) -> Vec<[f64; 3]> {
    let is_hidden = |quad: &Quad| host.external_textures().any(|name| name == "opaque") && quad.depth > OPAQUE;
    let quads: Vec<Quad> = quads.iter().filter(|quad| !is_hidden(quad)).copied().collect();
    let textures = || host.external_textures().map(|name| (name.to_owned(), external(name, size))).collect::<Vec<_>>();
    let drawn = || on_cpu(plan, &inputs(host), &textures(), (&quads, size));
    reference(plan, &quads, k, size).unwrap_or_else(drawn)
}

/// Compares a variant in frames of these sizes, in several drawing orders. Fails with what the target, the driver or the host lacks.
pub fn compare(
    context: &Context,
    form: Form,
    (what, variant, k): (&str, &Variant, Option<u32>),
    sizes: &[[u32; 2]],
) -> Result<(), NotDrawn> {
    let generation = generated(context.api, form, variant, &Registry::builtin())?;
    let plan = &generation.plans[0].plan;
    for &size in sizes {
        let mut host = host(context, &generation, size)?;
        if is_parallel(&context.name) && plan.arrival() == Arrival::Race {
            println!("{what}: not compared, because races change its image on {}", context.name);
            return Ok(());
        }
        let mut numbers = Numbers::seeded(u64::from(size[0]));
        let mut quads = quads(9, size, &mut numbers);
        for order in 0..4 {
            let seen = render(&mut host, form, &quads, size)?;
            let expected = expected(plan, &host, &quads, k, size);
            if let Some(difference) = first_difference(&seen, &expected) {
                let api = context.api;
                panic!("{what} on {api}, {form:?}, {size:?}, order {order}: {difference}: {quads:?}");
            }
            numbers.shuffle(&mut quads);
        }
    }
    Ok(())
}
