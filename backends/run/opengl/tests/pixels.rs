//! Renders by OpenGL and compares.

use std::sync::Arc;

use fragbuf_codegen::{Arrival, Form, Plan, SymbolId};
use fragbuf_cpu::{Code, Device, Settings};
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_opengl_host::{Context, Error, Host, Object, Scene};
use fragbuf_targets::{Request, generate, manifest, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{KeepDefault, Technique, TieBreak};

use crate::cpu_image::{cpu_image, is_exact, shown};
use crate::numbers::Numbers;
use crate::scene::{Quad, first_difference, image, image_in_order, quads, vertices};

/// Odd and even sizes, a single pixel, and a single row and column.
const SIZES: [[u32; 2]; 6] = [[13, 7], [16, 16], [1, 1], [31, 1], [1, 9], [37, 23]];

pub const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];

pub const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

pub fn context() -> Context {
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
    host_with(context, variant, &Registry::builtin(), size)
}

/// As [`host`], with the registry of a test.
pub fn host_with<'c>(
    context: &'c Context,
    variant: &Variant,
    registry: &Registry,
    size: [u32; 2],
) -> Result<Host<'c>, Error> {
    let request = Request { targets: &[target("glsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(variant, &request, registry).map_err(|error| Error(error.to_string()))?;
    let manifest = manifest(&generation, 0).to_string();
    let read = |path: &str| {
        let file = generation.files.iter().find(|file| file.path == path).unwrap();
        Ok(String::from_utf8(file.bytes.clone()).unwrap())
    };
    Host::new(context, &manifest, &read, size)
}

pub fn inputs(host: &Host<'_>) -> Vec<String> {
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

/// Returns the plan of the target.
fn plan(variant: &Variant) -> Plan {
    let request = Request { targets: &[target("glsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    generate(variant, &request, &Registry::builtin()).unwrap().plans.remove(0).plan
}

/// Returns the expected image: that of the reference where it applies, or that of the CPU device.
fn expected(
    (variant, plan): (&Variant, &Plan),
    host: &Host<'_>,
    quads: &[Quad],
    k: Option<u32>,
    size: [u32; 2],
) -> Vec<[f64; 3]> {
    if is_exact(plan) {
        return image(quads, size, shown(plan, k), BACKGROUND);
    }
    if plan.arrival() == Arrival::Submission && plan.hazards.is_empty() && is_by_order(plan) {
        return image_in_order(quads, size, k, BACKGROUND);
    }
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let mut cpu = Device::new(Arc::new(code), Settings::new(size[0], size[1])).unwrap();
    let inputs = inputs(host);
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    cpu_image(&mut cpu, quads, size, &inputs, BACKGROUND)
}

/// Whether the order of submission decides ties.
fn is_by_order(plan: &Plan) -> bool {
    plan.selection.row("ties").and_then(|ties| ties.row.order) == Some(TieBreak::Submission)
}

/// Whether a driver may run several fragments of a pixel at once. Software drivers run one after the other.
fn is_parallel(context: &Context) -> bool {
    ["llvmpipe", "softpipe", "SwiftShader"].iter().all(|name| !context.name.contains(name))
}

/// Compares a variant in frames of this size, in several drawing orders. Fails with what the driver or the host lacks.
fn compare(context: &Context, what: &str, variant: &Variant, k: Option<u32>, size: [u32; 2]) -> Result<(), Error> {
    let mut host = host(context, variant, size)?;
    let plan = plan(variant);
    if is_parallel(context) && plan.arrival() == Arrival::Race {
        println!("{what}: not compared, because races change its image on {}", context.name);
        return Ok(());
    }
    let mut numbers = Numbers::seeded(u64::from(size[0]));
    let mut quads = quads(9, size, &mut numbers);
    for order in 0..4 {
        let seen = render(&mut host, &quads, size)?;
        let expected = expected((variant, &plan), &host, &quads, k, size);
        if let Some(difference) = first_difference(&seen, &expected) {
            panic!("{what}, {size:?}, order {order}: {difference}: {quads:?}");
        }
        numbers.shuffle(&mut quads);
    }
    Ok(())
}

/// Extensions that no software driver of OpenGL has, and the techniques that need them.
const EXTENSIONS: [(&str, &[&str]); 2] = [
    ("GL_ARB_fragment_shader_interlock", &["kb_ps", "depth_partition", "kb_stream"]),
    ("GL_NV_shader_atomic_int64", &["kb_mdt64"]),
];

/// Checks that a technique was left out because of an extension that the driver lacks.
fn assert_lacking(context: &Context, technique: &str, error: &Error) {
    let extension = EXTENSIONS.iter().find(|(_, techniques)| techniques.contains(&technique)).map(|(name, _)| *name);
    let is_explained = extension.is_some_and(|name| error.to_string().contains(name) && !context.has(name));
    assert!(is_explained, "{technique}: {error}");
}

#[test]
fn every_technique() {
    let context = context();
    println!("{}", context.name);
    for technique in Registry::builtin().techniques() {
        let k = k_of(technique);
        let set = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> = set.iter().map(|k| ("k", k.as_str())).collect();
        let variant = variant(&technique.key, &set).unwrap();
        for size in SIZES {
            if let Err(error) = compare(&context, &technique.key, &variant, k, size) {
                assert_lacking(&context, &technique.key, &error);
            }
        }
    }
}

/// Rows that do not run as the only change of a technique, each with the reason: an extension, which a driver may have, or what this host
/// cannot give.
const ROWS_LEFT_OUT: [(&str, &str, &str); 8] = [
    ("storage", "wide_cascade", "GL_NV_shader_atomic_int64"),
    ("sync", "interlock", "GL_ARB_fragment_shader_interlock"),
    ("sync", "interlock_ordered", "GL_ARB_fragment_shader_interlock"),
    ("ties", "submission", "GL_ARB_fragment_shader_interlock"),
    ("opaque", "in_shader", "a texture of the engine"),
    ("opaque", "early_depth", "a texture of the engine"),
    ("allocation", "by_importance", "a texture of the engine"),
    ("resolve", "closure", "a closure of a description"),
];

/// Returns the first technique that takes a row and another setting, and runs.
fn taking_row(context: &Context, row: (&str, &str), others: &[Option<(&str, &str)>]) -> Option<String> {
    let registry = Registry::builtin();
    let pairs = registry.techniques().iter().flat_map(|technique| others.iter().map(move |other| (technique, other)));
    pairs.into_iter().find_map(|(technique, other)| {
        let k = if *other == Some(("k", "1")) { Some(1) } else { k_of(technique) };
        let number = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> =
            std::iter::once(row).chain(*other).chain(number.iter().map(|k| ("k", k.as_str()))).collect();
        let variant = variant(&technique.key, &set)?;
        let what = format!("{} with {set:?}", technique.key);
        compare(context, &what, &variant, k, [13, 7]).is_ok().then_some(what)
    })
}

/// One technique per row: the first that takes the row as its only change, or as one of two.
#[test]
fn every_row_of_every_axis() {
    let (context, registry) = (context(), Registry::builtin());
    let axes = || registry.axes().iter().filter(|axis| axis.chosen);
    let rows = || axes().flat_map(|axis| registry.rows_of(axis.key).map(|row| (axis.key, row.key.as_str())));
    let others: Vec<Option<(&str, &str)>> = rows().chain([("k", "1")]).map(Some).collect();
    for row in rows() {
        let alone = taking_row(&context, row, &[None]);
        let left_out = ROWS_LEFT_OUT.iter().find(|(axis, key, _)| (*axis, *key) == row);
        if let Some((_, _, reason)) = left_out.filter(|(_, _, reason)| !context.has(reason)) {
            assert!(alone.is_none(), "{row:?} runs without {reason}");
            continue;
        }
        let taken = alone.or_else(|| {
            let others: Vec<_> =
                others.iter().copied().filter(|other| other.is_none_or(|(axis, _)| axis != row.0)).collect();
            taking_row(&context, row, &others)
        });
        println!("{}", taken.unwrap_or_else(|| panic!("nothing runs {row:?}")));
    }
}

/// Memory is that of the capacity; k is a symbol of the frame.
#[test]
fn every_k_below_the_capacity() {
    let (context, size) = (context(), [13, 7]);
    for technique in Registry::builtin().techniques() {
        let KeepDefault::Best(most) = technique.keep else { continue };
        let with_k = |k: u32| variant(&technique.key, &[("k", &k.to_string())]);
        let capacity = most.min(8);
        let mut host = match host(&context, &with_k(capacity).unwrap(), size) {
            Ok(host) => host,
            Err(error) => {
                assert_lacking(&context, &technique.key, &error);
                continue;
            }
        };
        for k in 1..=capacity {
            // Some storages take only some k: sample counts are powers of two.
            let Some(variant) = with_k(k) else { continue };
            let plan = plan(&variant);
            if is_parallel(&context) && plan.arrival() == Arrival::Race {
                println!("{}: not compared, because races change its image", technique.key);
                continue;
            }
            // A host step of the frame decides k.
            if plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K)) {
                continue;
            }
            host.set_symbol("k", k.into());
            let quads = quads(9, size, &mut Numbers::seeded(k.into()));
            let seen = render(&mut host, &quads, size).unwrap_or_else(|error| panic!("{}: {error}", technique.key));
            let difference = first_difference(&seen, &expected((&variant, &plan), &host, &quads, Some(k), size));
            assert!(difference.is_none(), "{}, k = {k} of {capacity}: {}", technique.key, difference.unwrap());
        }
    }
}
