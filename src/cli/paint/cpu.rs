//! The frame on the CPU device, which needs no driver.
//!
//! In: a task and the order of fragments. Out: what was painted, drawn again with more room until nothing is lost for want of it.

use std::sync::Arc;

use fragbuf::Registry;
use fragbuf_cpu::{Code, Device, Error, Mesh, Order, Settings};
use fragbuf_frame::{POOL_EXHAUSTED, Room, Sizing};

use super::opaque::{Opaque, brought, depths};
use super::{Figures, Painted, Task};
use crate::cli::attributes::geometry;
use crate::cli::device::CPU;
use crate::cli::input::Input;
use crate::cli::output::{Failure, warn};
use crate::cli::uniforms;

pub(super) fn paint(
    task: &Task<'_>,
    order: Order,
    (input, registry): (&Input, &Registry),
    (frames, room): (&mut u32, &mut Option<u32>),
) -> Result<Painted, Failure> {
    let Task { wish, view, stage, progress, variant, opaque } = task;
    progress.stage(format!("{}: compiling", wish.description));
    let code = Code::of(variant, registry).map_err(|error| match error {
        Error::Diagnostics(faults) => input.failure(faults),
        other => other.into(),
    })?;
    let code = Arc::new(code);
    let brought = brought(&code.plan, *opaque)?;
    let backdrop = opaque.map(|opaque| backdrop(task, opaque, order, registry)).transpose()?;
    let geometry = geometry(&stage.scene, &code.plan)?;
    let mesh = Mesh { vertices: &geometry.vertices, indices: &geometry.indices };
    let uniforms = uniforms::values(wish.uniforms, variant)?;
    let (width, height) = view.size;
    loop {
        let sizing = room.map_or(Sizing::Auto, |fragments| Sizing::Reserve(Room::Fragments(fragments)));
        let settings = Settings { width, height, sizing, order };
        let mut device = Device::new(code.clone(), settings)?;
        for (name, value) in &uniforms {
            device.set_uniform(name, *value)?;
        }
        for (name, backdrop) in brought.iter().zip(backdrop.iter().cycle()) {
            device.set_texture(name, &backdrop.depths)?;
        }
        device.set_objects(&geometry.objects);
        device.set_camera(&stage.camera.view_projection);
        *frames += 1;
        let frame = *frames;
        let picture = device.render(&mesh, &|now| {
            progress.share(|| format!("{}: frame {frame}, pass {}", wish.description, now.pass), now.share);
        })?;
        let short = picture.counters.as_ref().map_or(0, |counters| counters.get(POOL_EXHAUSTED));
        if short > 0 {
            // Every fragment that found no room was counted.
            let needed = device.room_after(short);
            let fragments = u32::try_from(needed);
            *room = Some(fragments.map_err(|_| Failure::Device(format!("{needed} fragments are too many")))?);
            continue;
        }
        for pass in &picture.out_of_bounds {
            warn(&format!("{}: pass `{pass}` goes out of the bounds of a buffer or an array", wish.description));
        }
        let drawn = Figures {
            pixels: picture.pixels,
            counters: picture.counters,
            times: view.json.then_some(picture.times),
            bytes: device.allocated_bytes(),
            slices: 1,
            loops: picture.loops,
        };
        let backend = "interpreter".to_owned();
        let (plan, behind) = (code.plan.clone(), backdrop.map(|backdrop| backdrop.pixels));
        let (device, target) = (CPU.to_owned(), "wgsl-native");
        return Ok(Painted { drawn, behind, device, backend, target, plan, frames: *frames });
    }
}

/// What is opaque, drawn.
struct Backdrop {
    pixels: Vec<[f32; 4]>,
    /// Row after row.
    depths: Vec<f32>,
}

fn backdrop(task: &Task<'_>, opaque: &Opaque<'_>, order: Order, registry: &Registry) -> Result<Backdrop, Failure> {
    task.progress.stage("drawing what is opaque".to_owned());
    let code = Code::of(&opaque.variant, registry).map_err(|error| match error {
        Error::Diagnostics(faults) => opaque.input.failure(faults),
        other => other.into(),
    })?;
    let code = Arc::new(code);
    let geometry = geometry(&opaque.stage.scene, &code.plan)?;
    let (width, height) = task.view.size;
    let mut device = Device::new(code.clone(), Settings { width, height, sizing: Sizing::Auto, order })?;
    device.set_camera(&opaque.stage.camera.view_projection);
    let mesh = Mesh { vertices: &geometry.vertices, indices: &geometry.indices };
    let pixels = device.render(&mesh, &|_| {})?.pixels;
    let words = device.words(&depths(&code.plan)?).unwrap_or_default();
    Ok(Backdrop { pixels, depths: words.into_iter().map(f32::from_bits).collect() })
}
