//! Renders by OpenGL and compares.

use std::sync::Arc;

use fragbuf_codegen::Form;
use fragbuf_cpu::{Code, Device, Mesh, Settings};
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_opengl_host::{Context, Error, Host, Object, Scene};
use fragbuf_targets::{Request, generate, manifest, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Init, KeepDefault, Technique};

use crate::scene::{Numbers, Quad, first_difference, image, over_background, quads, vertices};

/// Odd and even sizes, a single pixel, and a single row and column.
const SIZES: [[u32; 2]; 6] = [[13, 7], [16, 16], [1, 1], [31, 1], [1, 9], [37, 23]];

const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];

const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

fn context() -> Context {
    let context = Context::surfaceless();
    context.unwrap_or_else(|error| panic!("{error}; install Debian's packages libegl1 and libgl1-mesa-dri"))
}

/// Returns a technique with these settings, if they are legal.
fn variant(key: &str, set: &[(&str, &str)]) -> Option<Variant> {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    for (name, value) in set {
        draft.set(name, value, &span).ok()?;
    }
    check(&draft, &Registry::builtin()).ok()
}

/// Returns the k that tests use for a technique, and its setting.
fn k_of(technique: &Technique) -> Option<u32> {
    match technique.keep {
        KeepDefault::All => None,
        KeepDefault::Best(most) => Some(most.min(4)),
    }
}

/// Generates the GLSL passes of a variant and opens a host for them.
fn host<'c>(context: &'c Context, variant: &Variant, size: [u32; 2]) -> Result<Host<'c>, Error> {
    let request = Request { targets: &[target("glsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(variant, &request, &Registry::builtin()).map_err(|error| Error(error.to_string()))?;
    let manifest = manifest(&generation, 0).to_string();
    let read = |path: &str| {
        let file = generation.files.iter().find(|file| file.path == path).unwrap();
        Ok(String::from_utf8(file.bytes.clone()).unwrap())
    };
    Host::new(context, &manifest, &read, size)
}

fn inputs(host: &Host<'_>) -> Vec<String> {
    host.vertex_inputs().iter().map(|input| input.name.clone()).collect()
}

fn render(host: &mut Host<'_>, quads: &[Quad], size: [u32; 2]) -> Result<Vec<[f32; 4]>, Error> {
    // Pools that no step of the frame sizes have room for every fragment.
    host.set_symbol("fragments", quads.len() as u64 * u64::from(size[0] * size[1]));
    let inputs = inputs(host);
    let vertices = vertices(quads, size, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let object = |index: u32| Object { first: 6 * index, count: 6, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] };
    let objects: Vec<Object> = (0..quads.len() as u32).map(object).collect();
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    let [r, g, b] = BACKGROUND.map(|channel| channel as f32);
    Ok(host.render(&scene, [r, g, b, 1.0])?.pixels)
}

fn cpu_device(variant: &Variant, [width, height]: [u32; 2]) -> Device {
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let settings = Settings::new(width, height);
    Device::new(Arc::new(code), settings).unwrap()
}

/// Returns the image of the CPU device.
fn on_cpu(device: &mut Device, quads: &[Quad], size: [u32; 2], inputs: &[String]) -> Vec<[f64; 3]> {
    let bytes = vertices(quads, size, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    picture.pixels.iter().map(|pixel| over_background(pixel.map(f64::from), BACKGROUND)).collect()
}

/// Tests whether the image of a variant is that of the k nearest fragments, or of all.
fn is_exact(device: &Device) -> bool {
    let storage = &device.plan().selection.row("storage").unwrap().row;
    let keeps_best = [Capability::KeepsAll, Capability::KeepsBest].iter().any(|kept| storage.may_provide(*kept));
    keeps_best && device.plan().hazards.is_empty()
}

/// Compares a variant in frames of this size, in several drawing orders. Fails with what the driver lacks.
fn compare(context: &Context, what: &str, variant: &Variant, k: Option<u32>, size: [u32; 2]) -> Result<(), Error> {
    let mut host = host(context, variant, size)?;
    let mut cpu = cpu_device(variant, size);
    if cpu.plan().resources.iter().any(|planned| planned.resource.init == Init::External) {
        return Err(Error("another pass of the caller supplies a texture".to_owned()));
    }
    let mut numbers = Numbers::seeded(u64::from(size[0]));
    let mut quads = quads(9, size, &mut numbers);
    for order in 0..4 {
        let seen = render(&mut host, &quads, size)?;
        let expected = match is_exact(&cpu) {
            true => image(&quads, size, k, BACKGROUND),
            false => on_cpu(&mut cpu, &quads, size, &inputs(&host)),
        };
        if let Some(difference) = first_difference(&seen, &expected) {
            panic!("{what}, {size:?}, order {order}: {difference}: {quads:?}");
        }
        numbers.shuffle(&mut quads);
    }
    Ok(())
}

#[test]
fn every_technique() {
    let context = context();
    println!("{}", context.name);
    let mut lacking = Vec::new();
    for technique in Registry::builtin().techniques() {
        let k = k_of(technique);
        let set = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> = set.iter().map(|k| ("k", k.as_str())).collect();
        let variant = variant(&technique.key, &set).unwrap();
        for size in SIZES {
            if let Err(error) = compare(&context, &technique.key, &variant, k, size) {
                lacking.push((technique.key.clone(), error.to_string()));
                break;
            }
        }
    }
    // No software driver of OpenGL has interlock or 64-bit atomics.
    for (key, error) in &lacking {
        println!("{key}: {error}");
        let extensions = ["GL_ARB_fragment_shader_interlock", "GL_NV_shader_atomic_int64"];
        assert!(extensions.iter().any(|extension| error.contains(extension)), "{key}: {error}");
        assert!(!extensions.iter().all(|extension| context.has(extension)), "{key}: {error}");
    }
    assert!(lacking.len() <= 4, "{lacking:?}");
}

/// One technique per row: the first that takes the row as its only change.
#[test]
fn every_row_of_every_axis() {
    let (context, registry) = (context(), Registry::builtin());
    let (mut right, mut left_out) = (0, Vec::new());
    for axis in registry.axes().iter().filter(|axis| axis.chosen) {
        for row in registry.rows_of(axis.key) {
            let taken = registry.techniques().iter().find_map(|technique| {
                let k = k_of(technique);
                let number = k.map(|k| k.to_string());
                let mut set = vec![(axis.key, row.key.as_str())];
                set.extend(number.iter().map(|k| ("k", k.as_str())));
                let variant = variant(&technique.key, &set)?;
                let what = format!("{} with {}: {}", technique.key, axis.key, row.key);
                compare(&context, &what, &variant, k, [13, 7]).is_ok().then_some(what)
            });
            match taken {
                Some(what) => {
                    println!("right: {what}");
                    right += 1;
                }
                None => left_out.push(format!("{}: {}", axis.key, row.key)),
            }
        }
    }
    println!("left out: {left_out:#?}");
    assert!(right > 40, "{right} rows");
}

/// Memory is that of the capacity; k is a symbol of the frame.
#[test]
fn every_k_below_the_capacity() {
    let (context, size) = (context(), [13, 7]);
    for technique in Registry::builtin().techniques() {
        let KeepDefault::Best(most) = technique.keep else { continue };
        let with_k = |k: u32| variant(&technique.key, &[("k", &k.to_string())]);
        let capacity = most.min(8);
        let Some(Ok(mut host)) = with_k(capacity).map(|variant| host(&context, &variant, size)) else { continue };
        for k in 1..=capacity {
            // Some storages take only some k: sample counts are powers of two.
            let Some(variant) = with_k(k) else { continue };
            let mut cpu = cpu_device(&variant, size);
            host.set_symbol("k", k.into());
            let quads = quads(9, size, &mut Numbers::seeded(k.into()));
            let seen = render(&mut host, &quads, size).unwrap_or_else(|error| panic!("{}: {error}", technique.key));
            let expected = match is_exact(&cpu) {
                true => image(&quads, size, Some(k), BACKGROUND),
                false => on_cpu(&mut cpu, &quads, size, &inputs(&host)),
            };
            let difference = first_difference(&seen, &expected);
            assert!(difference.is_none(), "{}, k = {k} of {capacity}: {}", technique.key, difference.unwrap());
        }
    }
}
