//! Loops that end on the device, and objects that the device drops: no frame is suspended, and image, counters and reports are those of a
//! frame whose host decides. Every technique whose loop ends on a condition, whole and in slices, on the driver and on the CPU device.

use std::ops::Range;
use std::sync::{Arc, MutexGuard};

use fragbuf_codegen::LoopUntil;
use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::wgpu::util::{DrawIndexedIndirectArgs, DrawIndirectArgs};
use fragbuf_runtime::{
    Conditions, Counters, DrawArguments, Error, LoopEnd, LoopReport, ObjectBox, Output, Recorded, Renderer, SceneDraw,
    Settings, block_on,
};
use fragbuf_templates::Registry;

use crate::culled_objects::{boxes_around, scene};
use crate::drivers::scene::{Quad, vertices};
use crate::peeling::{SIZE, SLICES, shaders_of, sizing};
use crate::stage::{BACKGROUND, FORMAT, device, read_counters, renderer, technique, vertex_buffer};

/// More iterations than any technique needs for the scene.
const ENOUGH: (&str, &str) = ("peeling.iterations", "24");

type Drawn = (Vec<[f32; 4]>, Counters, Vec<LoopReport>);

/// Returns the techniques whose loops end on a condition, with every choice of `objects` that peeling has.
fn looped() -> Vec<(String, Variant)> {
    let keys = Registry::builtin().techniques().iter().map(|technique| technique.key.clone()).collect::<Vec<_>>();
    let mut all = Vec::new();
    for key in keys {
        let plan = Code::of(&technique(&key, &[]), &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")).plan;
        let is_peeled =
            plan.selection.rows.iter().any(|row| row.row.axis == "peeling" && !row.row.resources.is_empty());
        if plan.frame.loops.iter().any(|looped| looped.until != LoopUntil::Times) {
            if !is_peeled {
                all.push((key.clone(), technique(&key, &[("counters", "all")])));
                continue;
            }
            for objects in ["all", "unpeeled"] {
                let set = [ENOUGH, ("objects", objects), ("counters", "all")];
                all.push((format!("{key}, objects: {objects}"), technique(&key, &set)));
            }
        }
    }
    let peeled = all.iter().filter(|(what, _)| what.contains("objects: ")).count();
    assert!(peeled > 0 && peeled < all.len(), "{:?}", all.iter().map(|(what, _)| what).collect::<Vec<_>>());
    all
}

/// Returns a draw for each quad; every other one has indices.
fn draws(quads: &[Quad]) -> Vec<SceneDraw> {
    let draw = |number: u32| {
        let (first, count) = (6 * number, 6);
        let indexed = DrawIndexedIndirectArgs {
            index_count: count,
            instance_count: 1,
            first_index: 0,
            base_vertex: first.cast_signed(),
            first_instance: 0,
        };
        let plain = DrawIndirectArgs { vertex_count: count, instance_count: 1, first_vertex: first, first_instance: 0 };
        let arguments =
            if number.is_multiple_of(2) { DrawArguments::Indexed(indexed) } else { DrawArguments::Vertices(plain) };
        SceneDraw { object: number, arguments }
    };
    (0..quads.len() as u32).map(draw).collect()
}

/// A renderer of a variant with the scene's objects.
struct Stage {
    headless: MutexGuard<'static, Headless>,
    quads: Vec<Quad>,
    boxes: Vec<ObjectBox>,
}

impl Stage {
    fn new() -> Self {
        let quads = scene();
        Stage { headless: device(), boxes: boxes_around(&quads), quads }
    }

    fn renderer(&self, variant: &Variant, conditions: Conditions, slice: Option<u32>) -> Renderer {
        let settings =
            Settings { slice, conditions, sizing: sizing(variant), ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
        let mut renderer = renderer(&self.headless, &shaders_of(variant), &settings).unwrap();
        let device = &self.headless.device;
        block_on(device, renderer.set_objects(&self.boxes)).unwrap().unwrap();
        block_on(device, renderer.set_draws(&draws(&self.quads))).unwrap().unwrap();
        renderer
    }

    /// Draws a frame; fails if it is suspended although the device decides.
    fn draw(&self, renderer: &mut Renderer, conditions: Conditions) -> Drawn {
        let Headless { device, queue, .. } = &*self.headless;
        let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
        let vertices = vertex_buffer(&self.headless, &vertices(&self.quads, SIZE, &inputs));
        let indices: Vec<u8> = (0..6u32).flat_map(u32::to_le_bytes).collect();
        let indices = wgpu::util::DeviceExt::create_buffer_init(
            device,
            &wgpu::util::BufferInitDescriptor { label: None, contents: &indices, usage: wgpu::BufferUsages::INDEX },
        );
        let offscreen = Offscreen::new(device, FORMAT, SIZE[0], SIZE[1]).unwrap();
        let [r, g, b] = BACKGROUND;
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
        let count = self.quads.len();
        let mut frame = renderer.begin().unwrap();
        let loops = loop {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let recorded = frame.record(renderer, &mut encoder, &output, &mut |pass, call| {
                pass.set_vertex_buffer(0, vertices.slice(..));
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                (0..count).for_each(|number| call.draw(pass, number).unwrap());
            });
            let recorded = recorded.unwrap();
            let reports = renderer.loop_reports(&mut encoder);
            queue.submit([encoder.finish()]);
            match recorded {
                Recorded::Finished(loops) => break reports.map_or(loops, |pending| pending.wait(device).unwrap()),
                Recorded::Suspended(suspended) => {
                    assert_eq!(conditions, Conditions::OnHost, "the frame waits");
                    frame = block_on(device, suspended.resume(renderer)).unwrap().unwrap();
                }
            }
        };
        let counters = read_counters(&self.headless, renderer);
        (offscreen.colors(device, queue).unwrap(), counters, loops)
    }
}

fn drawn_on_cpu(variant: &Variant, quads: &[Quad], conditions: Conditions, slice: Option<u32>) -> Drawn {
    let code = Arc::new(Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")));
    let settings = fragbuf_cpu::Settings {
        conditions,
        slice,
        sizing: sizing(variant),
        ..fragbuf_cpu::Settings::new(SIZE[0], SIZE[1])
    };
    let inputs: Vec<String> =
        fragbuf_runtime::VertexInputs::of(&code.plan).inputs.into_iter().map(|one| one.name).collect();
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    let mut cpu = Device::new(code, settings).unwrap();
    let bytes = vertices(quads, SIZE, &inputs);
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let objects: Vec<Range<u32>> = (0..quads.len() as u32).map(|number| 6 * number..6 * number + 6).collect();
    cpu.set_objects(&objects);
    let picture = cpu.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    (picture.pixels, picture.counters.unwrap(), picture.loops)
}

#[test]
fn the_device_ends_loops_as_the_host_does() {
    let stage = Stage::new();
    for (what, variant) in looped() {
        for slice in SLICES {
            let what = format!("{what}, slices of {slice:?} rows");
            let expected = stage.draw(&mut stage.renderer(&variant, Conditions::OnHost, slice), Conditions::OnHost);
            assert!(!expected.2.is_empty(), "{what}: no loop ends on a condition");
            let mut renderer = stage.renderer(&variant, Conditions::OnDevice, slice);
            // The second frame begins with the words that the first one left.
            for frame in ["the first", "the second"] {
                assert_same(
                    &format!("{what}, {frame} frame"),
                    &stage.draw(&mut renderer, Conditions::OnDevice),
                    &expected,
                );
            }
        }
    }
}

#[test]
fn the_cpu_device_ends_loops_as_a_gpu_would() {
    let quads = scene();
    for (what, variant) in looped() {
        for slice in SLICES {
            let expected = drawn_on_cpu(&variant, &quads, Conditions::OnHost, slice);
            assert!(!expected.2.is_empty(), "{what}: no loop ends on a condition");
            let seen = drawn_on_cpu(&variant, &quads, Conditions::OnDevice, slice);
            assert_same(&format!("{what}, slices of {slice:?} rows"), &seen, &expected);
        }
    }
}

/// Compares the pixels, the counters and the reports. Equal numbers of generated fragments prove that no further iteration draws.
fn assert_same(what: &str, (pixels, counters, loops): &Drawn, (expected, all, reports): &Drawn) {
    assert!(pixels == expected, "{what}");
    assert_eq!(loops, reports, "{what}");
    assert_eq!(counters, all, "{what}");
}

#[test]
fn a_loop_that_is_cut_says_so_and_counts_what_is_left() {
    let stage = Stage::new();
    let cut = Conditions::OnDevice;
    let variant = technique("f2b_ll", &[("counters", "all"), ("peeling.iterations", "2")]);
    let (_, counters, loops) = stage.draw(&mut stage.renderer(&variant, cut, None), cut);
    let on_cpu = drawn_on_cpu(&variant, &stage.quads, cut, None);
    for (counters, loops) in [(&counters, &loops), (&on_cpu.1, &on_cpu.2)] {
        assert!(counters.get("not_converged") > 0, "{counters:?}");
        assert_eq!((loops[0].iterations, loops[0].end), (2, LoopEnd::LimitReached));
    }
}

#[test]
fn a_frame_needs_the_draws_of_its_scene() {
    let stage = Stage::new();
    let variant = technique("f2b", &[]);
    let settings = Settings { conditions: Conditions::OnDevice, ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
    let mut renderer = renderer(&stage.headless, &shaders_of(&variant), &settings).unwrap();
    let error = renderer.begin().unwrap_err();
    assert!(error.to_string().contains("`Renderer::set_draws`"), "{error}");
    let device = &stage.headless.device;
    block_on(device, renderer.set_draws(&draws(&stage.quads[..2]))).unwrap().unwrap();
    let mut errors: Vec<Error> = Vec::new();
    let offscreen = Offscreen::new(device, FORMAT, SIZE[0], SIZE[1]).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
    renderer.render(&output, &mut |pass, call| errors.extend(call.draw(pass, 2).err())).unwrap();
    assert!(errors[0].to_string().contains("less than 2"), "{errors:?}");
}
