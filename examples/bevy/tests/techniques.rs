//! Draws every technique by portable WGSL on the device of Bevy's render world, at odd sizes and in permuted drawing orders.

use std::sync::{Mutex, MutexGuard};

use fragbuf_bevy::headless::{app, gpu, ready, texels};
use fragbuf_bevy::{Error, Follower, Gpu, Output, Passes, Scene, Vertices};
use fragbuf_codegen::{Arrival, Form, Plan};
use fragbuf_model::Variant;
use fragbuf_templates::Registry;

use crate::cpu_image::is_exact;
use crate::numbers::Numbers;
use crate::scene::{Quad, first_difference, quads, vertices};
use crate::technique::{BACKGROUND, IDENTITY, is_parallel, k_of, objects, on_cpu, reference, variant};

/// Odd and even sizes, a single pixel, a single row and column.
const SIZES: [[u32; 2]; 5] = [[13, 7], [1, 1], [31, 1], [1, 9], [37, 23]];

/// A format that blends, with more precision than the tolerance of the comparison.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Techniques that portable WGSL does not have, with the reason that the manifest gives.
const UNSUPPORTED: [(&str, &str); 2] = [("f2b_3p", "early depth test"), ("kb_mdt64", "64-bit atomic operations")];

/// Returns the device of a Bevy app, and its name. Tests share the cores, so they use one device at a time.
fn device() -> (Gpu, String, MutexGuard<'static, ()>) {
    let guard = alone();
    let mut app = app();
    ready(&mut app).unwrap_or_else(|error| panic!("{error}"));
    let gpu = gpu(&app).unwrap_or_else(|error| panic!("{error}"));
    let name = gpu.device.adapter_info().name;
    (gpu, name, guard)
}

/// Waits until no other test uses a device.
pub fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Returns the texels of an external texture: a number per pixel.
fn external(name: &str, [width, height]: [u32; 2]) -> Vec<f32> {
    // Importance is stored in eight bits, so these numbers are exact.
    let texel = |pixel: u32| if name == "opaque" { pixel as f32 * 7.0 % 16.0 / 16.0 + 1.0 / 32.0 } else { 1.0 };
    (0..width * height).map(texel).collect()
}

fn set_external(gpu: &Gpu, follower: &mut Follower, size: [u32; 2]) {
    let names: Vec<String> = follower.external_textures().map(str::to_owned).collect();
    for name in names {
        let descriptor = follower.texture_descriptor(&name).unwrap();
        let texture = gpu.device.create_texture(&descriptor);
        let bytes: Vec<u8> = external(&name, size).into_iter().flat_map(f32::to_le_bytes).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * size[0]), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), &bytes, layout, descriptor.size);
        follower.set_texture(&name, &texture).unwrap();
    }
}

/// Draws quads over the background, one object each. Returns the pixels, and the sum of lost fragments.
fn draw(gpu: &Gpu, follower: &mut Follower, quads: &[Quad], size: [u32; 2]) -> Result<(Vec<[f32; 4]>, u64), Error> {
    // Pools that no step of the frame sizes have room for every fragment.
    follower.set_symbol("fragments", quads.len() as u64 * u64::from(size[0] * size[1]))?;
    let inputs = inputs(follower);
    let vertices = vertices(quads, size, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let objects = objects(quads);
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY };
    let geometry = Vertices::new(gpu, follower.plan(), &scene)?;
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let [r, g, b] = BACKGROUND;
    let mut submit = |commands| drop(gpu.queue.submit([commands]));
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let output = Output { view: &view, clear: Some(wgpu::Color { r, g, b, a: 1.0 }), submit: &mut submit };
    let commands = follower.draw(output, &geometry, &scene)?;
    gpu.queue.submit([commands]);
    let pixels = texels(gpu, &target)?.chunks_exact(8).map(pixel).collect();
    Ok((pixels, follower.counters()?.lost))
}

/// Converts a texel of four 16-bit floats.
pub fn pixel(bytes: &[u8]) -> [f32; 4] {
    std::array::from_fn(|channel| {
        let bits = u16::from_le_bytes([bytes[2 * channel], bytes[2 * channel + 1]]);
        let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023) / 1024.0);
        let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
        match exponent {
            0 => sign * mantissa * 2.0_f32.powi(-14),
            _ => sign * (1.0 + mantissa) * 2.0_f32.powi(exponent - 15),
        }
    })
}

fn inputs(follower: &Follower) -> Vec<String> {
    follower.plan().vertex_inputs.iter().map(|input| input.name.clone()).collect()
}

/// Returns the expected image: that of the reference where it applies, or that of the CPU device.
fn expected(plan: &Plan, follower: &Follower, quads: &[Quad], k: Option<u32>, size: [u32; 2]) -> Vec<[f64; 3]> {
    let textures: Vec<_> = follower.external_textures().map(|name| (name.to_owned(), external(name, size))).collect();
    let reference = if textures.is_empty() { reference(plan, quads, k, size) } else { None };
    reference.unwrap_or_else(|| on_cpu(plan, &inputs(follower), &textures, (quads, size)))
}

/// Compares a variant in frames of these sizes, in several drawing orders. Fails with what the target or the device lacks.
fn compare(
    (gpu, driver): (&Gpu, &str),
    (what, variant, k): (&str, &Variant, Option<u32>),
    sizes: &[[u32; 2]],
    orders: usize,
) -> Result<(), Error> {
    let passes = Passes::of(variant, Form::Program)?;
    for &size in sizes {
        let mut follower = Follower::new(gpu, &passes, size, FORMAT)?;
        let plan = &passes.plan().unwrap_or_else(|| panic!("{what} has a follower and no plan"));
        if is_parallel(driver) && plan.arrival() == Arrival::Race {
            println!("{what}: not compared, because races change its image on {driver}");
            return Ok(());
        }
        set_external(gpu, &mut follower, size);
        let mut numbers = Numbers::seeded(u64::from(size[0]));
        let mut quads = quads(9, size, &mut numbers);
        for order in 0..orders {
            let (seen, lost) = draw(gpu, &mut follower, &quads, size)?;
            let expected = expected(plan, &follower, &quads, k, size);
            if let Some(difference) = first_difference(&seen, &expected) {
                panic!("{what}, {size:?}, order {order}: {difference}: {quads:?}");
            }
            let may_lose = !is_exact(plan) || plan.hazards.iter().any(|hazard| hazard.permits.shows());
            assert!(may_lose || lost == 0, "{what}: {lost} fragments are lost");
            numbers.shuffle(&mut quads);
        }
    }
    Ok(())
}

/// Every technique in every frame. The manifest names the techniques that the target does not have, and why.
#[test]
fn every_technique() {
    let (gpu, driver, _guard) = device();
    println!("driver: {driver}");
    let (mut left_out, mut drawn) = (Vec::new(), 0);
    for technique in Registry::builtin().techniques() {
        let k = k_of(technique);
        let number = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> = number.iter().map(|k| ("k", k.as_str())).collect();
        let variant = variant(&technique.key, &set).unwrap();
        match compare((&gpu, &driver), (&technique.key, &variant, k), &SIZES, 3) {
            Ok(()) => drawn += 1,
            Err(error) => left_out.push((technique.key.clone(), error.to_string())),
        }
    }
    println!("{drawn} techniques drawn; left out: {left_out:#?}");
    left_out.sort();
    let keys: Vec<&str> = left_out.iter().map(|(key, _)| key.as_str()).collect();
    assert_eq!(keys, UNSUPPORTED.map(|(key, _)| key));
    for ((key, error), (_, reason)) in left_out.iter().zip(UNSUPPORTED) {
        assert!(error.contains("`wgsl`") && error.contains(reason), "{key}: {error}");
    }
}
