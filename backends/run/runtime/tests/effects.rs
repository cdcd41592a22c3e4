//! The effects of `examples/effects` on the driver and on the CPU device, over several storages: the image is that of the reference.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Settings, Value, VertexInputs, block_on};
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::TextureDimension;

use crate::drivers::on_swiftshader;
use crate::lookups::texture;
use crate::stage::{FORMAT, device, draw_bytes, renderer, shaders};
use oracle::{BACKGROUND, EFFECTS, Effect, Number, SIZE, Solids, Texels, difference};

#[path = "../../../../tests/oracle/effects/mod.rs"]
mod oracle;

fn value(number: Number) -> Value {
    match number {
        Number::F32(value) => Value::F32(value),
        Number::U32(value) => Value::U32(value),
        Number::Vec3(values) => Value::Vec3(values),
        Number::Vec4(values) => Value::Vec4(values),
    }
}

/// Draws an effect with the driver.
fn drawn(stage: &Headless, effect: &Effect, variant: &Variant, solids: &Solids) -> Vec<[f32; 4]> {
    let is_portable = variant.select(target("wgsl").unwrap().provides).is_ok();
    let shaders = shaders(variant, if is_portable { "wgsl" } else { "wgsl-native" });
    let mut renderer = renderer(stage, &shaders, &Settings::new(FORMAT, SIZE[0], SIZE[1])).unwrap();
    effect.uniforms.iter().for_each(|(name, number)| renderer.set_uniform(name, value(*number)).unwrap());
    for (name, Texels { size, values }) in &effect.textures(solids) {
        let dimension = if size[2] > 1 { TextureDimension::D3 } else { TextureDimension::D2 };
        let texture = texture(stage, dimension, *size, values);
        block_on(&stage.device, renderer.set_texture(name, &texture)).unwrap().unwrap();
    }
    let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
    let bytes = solids.vertices(&inputs);
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE[0], SIZE[1]).unwrap();
    draw_bytes(stage, &mut renderer, (&bytes, solids.count()), &offscreen).unwrap();
    offscreen.colors(&stage.device, &stage.queue).unwrap()
}

#[test]
fn every_effect_on_the_driver() {
    let stage = device();
    println!("driver: {}", stage.info.name);
    for effect in EFFECTS {
        let solids = effect.solids();
        let expected = effect.expected(&solids);
        for (what, variant) in effect.variants() {
            effect.assert_image(&what, &drawn(&stage, effect, &variant, &solids), &expected);
        }
    }
}

#[test]
fn every_effect_on_swiftshader() {
    let printed = on_swiftshader("effects::every_effect_on_the_driver");
    assert!(printed.contains("driver: SwiftShader") && printed.contains("1 passed"), "{printed}");
}

/// Draws an effect with the CPU device.
fn drawn_on_cpu(effect: &Effect, variant: &Variant, solids: &Solids) -> Vec<[f32; 4]> {
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{}: {error}", effect.name));
    let mut device = Device::new(Arc::new(code), fragbuf_cpu::Settings::new(SIZE[0], SIZE[1])).unwrap();
    effect.uniforms.iter().for_each(|(name, number)| device.set_uniform(name, value(*number)).unwrap());
    for (name, Texels { size, values }) in &effect.textures(solids) {
        device.set_description_texture(name, *size, values).unwrap();
    }
    let inputs = VertexInputs::of(device.plan());
    let inputs: Vec<&str> = inputs.inputs.iter().map(|input| input.name.as_str()).collect();
    let bytes = solids.vertices(&inputs);
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..solids.count()).collect();
    let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    let over = |[r, g, b, a]: [f32; 4]| {
        let channel = |front: f32, behind: f64| front + (1.0 - a) * behind as f32;
        [channel(r, BACKGROUND[0]), channel(g, BACKGROUND[1]), channel(b, BACKGROUND[2]), 1.0]
    };
    picture.pixels.iter().copied().map(over).collect()
}

#[test]
fn every_effect_on_the_cpu_device() {
    for effect in EFFECTS {
        let solids = effect.solids();
        let expected = effect.expected(&solids);
        for (what, variant) in effect.variants() {
            effect.assert_image(&what, &drawn_on_cpu(effect, &variant, &solids), &expected);
        }
    }
}

/// The scene shows what the references test: a small change of each description changes the image.
#[test]
fn every_reference_notices_a_change() {
    let is_noticed = |effect: &&Effect| {
        let solids = effect.solids();
        let drawn = drawn_on_cpu(effect, &effect.mutant(), &solids);
        difference(&drawn, &effect.expected(&solids)).is_some()
    };
    let unnoticed: Vec<&str> = EFFECTS.iter().filter(|effect| !is_noticed(effect)).map(|effect| effect.name).collect();
    assert!(unnoticed.is_empty(), "{unnoticed:?}");
}
