//! Draws every technique and every row, and compares each pixel.

use fragbuf_codegen::{Arrival, Plan, SymbolId};
use fragbuf_model::Variant;
use fragbuf_templates::Registry;
use fragbuf_vulkan_host::{Context, Error, Host, Validation};

use crate::hosts::cpu_image::is_exact;
use crate::hosts::numbers::Numbers;
use crate::hosts::rows::{NO_TECHNIQUE, draw_rows};
use crate::hosts::scene::{Quad, first_difference, quads};
use crate::hosts::technique::{is_parallel, k_of, on_cpu, reference, variant};
use crate::stage::{Generated, context, draw, inputs, technique};

/// The width and height of each frame, and the rows of its slices: odd and even sizes, a single pixel, a single row
/// and column.
const FRAMES: [([u32; 2], Option<u32>); 6] =
    [([13, 7], None), ([13, 7], Some(3)), ([1, 1], None), ([31, 1], None), ([1, 9], Some(2)), ([37, 23], None)];

/// Returns a number per pixel for each texture that the engine supplies.
fn external(plan: &Plan, [width, height]: [u32; 2]) -> Vec<(String, Vec<f32>)> {
    let external = plan.resources.iter().filter(|planned| planned.is_external());
    let texels = || (0..width * height).map(|pixel| (pixel * 7 % 16) as f32 / 16.0 + 1.0 / 32.0).collect();
    external.map(|planned| (planned.resource.name.clone(), texels())).collect()
}

/// Returns the expected image: that of the reference where it applies, or that of the CPU device.
fn expected(plan: &Plan, host: &Host<'_>, quads: &[Quad], k: Option<u32>, size: [u32; 2]) -> Vec<[f64; 3]> {
    let textures = external(plan, size);
    let reference = if textures.is_empty() { reference(plan, quads, k, size) } else { None };
    reference.unwrap_or_else(|| on_cpu(plan, &inputs(host), &textures, (quads, size)))
}

/// Draws a variant in frames, each in several drawing orders, and compares. Fails with what the device lacks.
pub fn compare(
    context: &Context,
    what: &str,
    (variant, k): (&Variant, Option<u32>),
    frames: &[([u32; 2], Option<u32>)],
    orders: usize,
) -> Result<(), Error> {
    let generated = Generated::of(variant, &Registry::builtin());
    let plan = &generated.plan;
    let mut host = match generated.host(context, frames[0].0) {
        Err(error) if error.to_string().contains(" lacks ") => return Err(error),
        host => host.unwrap_or_else(|error| panic!("{what}: {error}")),
    };
    if is_parallel(&context.name) && plan.arrival() == Arrival::Race {
        println!("{what}: not compared, because races change its image on {}", context.name);
        return Ok(());
    }
    for (size, rows) in frames {
        host.resize(*size).unwrap();
        host.set_rows(*rows).unwrap();
        for (name, texels) in external(plan, *size) {
            let bytes: Vec<u8> = texels.iter().flat_map(|texel| texel.to_le_bytes()).collect();
            host.set_texture(&name, &bytes).unwrap_or_else(|error| panic!("{what}: {error}"));
        }
        let mut numbers = Numbers::seeded(u64::from(size[0]));
        let mut quads = quads(9, *size, &mut numbers);
        for order in 0..orders {
            let seen = draw(&mut host, &quads, *size).unwrap_or_else(|error| panic!("{what}, {size:?}: {error}"));
            let expected = expected(plan, &host, &quads, k, *size);
            if let Some(difference) = first_difference(&seen.pixels, &expected) {
                panic!("{what}, {size:?}, slices of {rows:?} rows, order {order}: {difference}: {quads:?}");
            }
            let may_lose = !is_exact(plan) || plan.hazards.iter().any(|hazard| hazard.permits.shows());
            assert!(may_lose || seen.lost == 0, "{what}: {:?}", seen.counters);
            numbers.shuffle(&mut quads);
        }
    }
    drop(host);
    context.check().unwrap_or_else(|error| panic!("{what}: {error}"));
    Ok(())
}

/// Extensions that no software driver has, and the techniques that need them.
const EXTENSIONS: [(&str, &[&str]); 1] =
    [("`VK_EXT_fragment_shader_interlock`", &["kb_ps", "depth_partition", "kb_stream"])];

/// Features that some software drivers lack, and the techniques that need them.
const FEATURES: [(&str, &[&str]); 1] = [("`shaderBufferInt64Atomics`", &["kb_mdt64"])];

/// Tests whether a technique may be left out because of what the device lacks.
fn is_explained(technique: &str, error: &Error) -> bool {
    let mut lacking = EXTENSIONS.iter().chain(&FEATURES);
    lacking.any(|(name, techniques)| techniques.contains(&technique) && error.to_string().contains(name))
}

/// Draws every technique in these frames. Those that need what the device lacks say so, and no others are left out.
fn draw_all(context: &Context, frames: &[([u32; 2], Option<u32>)], orders: usize) {
    println!("driver: {}", context.name);
    let (mut left_out, mut wrong) = (Vec::new(), Vec::new());
    for row in Registry::builtin().techniques() {
        let drawn = compare(context, &row.key, (&technique(row), k_of(row)), frames, orders);
        let needs_extension = EXTENSIONS.iter().any(|(_, techniques)| techniques.contains(&&*row.key));
        match drawn {
            Ok(()) if needs_extension && !is_parallel(&context.name) => {
                wrong.push(format!("{} is drawn on a driver without its extension", row.key));
            }
            Ok(()) => {}
            Err(error) if is_explained(&row.key, &error) => left_out.push(format!("{}: {error}", row.key)),
            Err(error) => wrong.push(format!("{}: {error}", row.key)),
        }
    }
    println!("left out: {left_out:#?}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_technique() {
    draw_all(&context(Validation::On), &FRAMES, 3);
}

/// The synchronisation checks of the layer report nothing: every technique, one frame each. They do not see every conflict.
#[test]
fn every_technique_with_synchronization_validation() {
    draw_all(&context(Validation::Synchronization), &[([13, 7], None)], 1);
}

/// Rows that are not drawn, with the reason. Devices that are not software may have the extension.
const ROWS_LEFT_OUT: [(&str, &str, &str); 6] = [
    ("sync", "interlock", "`VK_EXT_fragment_shader_interlock`"),
    ("sync", "interlock_ordered", "`VK_EXT_fragment_shader_interlock`"),
    ("ties", "submission", "`VK_EXT_fragment_shader_interlock`"),
    ("resolve", "closure", NO_TECHNIQUE),
    ("resolve", "pairs", NO_TECHNIQUE),
    ("resolve", "after_images", NO_TECHNIQUE),
];

#[test]
fn every_row_of_every_axis() {
    let context = context(Validation::On);
    let draw = |what: &str, variant: &Variant, k| {
        compare(&context, what, (variant, k), &[([13, 7], None)], 2).map_err(|error| error.to_string())
    };
    let left_out = |axis: &str, key: &str| {
        let is_listed = |(of, row, reason): &&(&str, &str, &'static str)| {
            (*of, *row) == (axis, key) && (*reason == NO_TECHNIQUE || !is_parallel(&context.name))
        };
        ROWS_LEFT_OUT.iter().find(is_listed).map(|(.., reason)| (*reason).to_owned())
    };
    let wrong = draw_rows(&draw, &left_out);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Memory is that of the capacity; k is a symbol of the frame. The least k and one between stand for all of them.
#[test]
fn k_below_the_capacity() {
    let (context, size) = (context(Validation::On), [13, 7]);
    let mut compared = 0;
    for row in Registry::builtin().techniques() {
        let Some(capacity) = k_of(row) else { continue };
        let generated = Generated::of(&technique(row), &Registry::builtin());
        // A host step of the frame decides k.
        if generated.plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K)) {
            continue;
        }
        let mut host = match generated.host(&context, size) {
            Err(error) if is_explained(&row.key, &error) => continue,
            host => host.unwrap_or_else(|error| panic!("{}: {error}", row.key)),
        };
        for k in [1, 3] {
            // Some storages take only some k: sample counts are powers of two.
            let Some(variant) = variant(&row.key, &[("k", &k.to_string())]).filter(|_| k <= capacity) else { continue };
            let plan = Generated::of(&variant, &Registry::builtin()).plan;
            if is_parallel(&context.name) && plan.arrival() == Arrival::Race {
                continue;
            }
            host.set_symbol("k", k.into()).unwrap_or_else(|error| panic!("{}: {error}", row.key));
            compared += 1;
            let quads = quads(9, size, &mut Numbers::seeded(k.into()));
            let seen = draw(&mut host, &quads, size).unwrap_or_else(|error| panic!("{}: {error}", row.key));
            let difference = first_difference(&seen.pixels, &expected(&plan, &host, &quads, Some(k), size));
            assert!(difference.is_none(), "{}, k = {k} of {capacity}: {}", row.key, difference.unwrap());
        }
    }
    assert!(compared >= 20, "{compared}");
}
