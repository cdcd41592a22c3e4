//! Objects that peeling has stored completely are not drawn again (D13 §3.3): the image and the counters do not change, and every kind of
//! peeling draws fewer objects. On the driver, whole and in slices.

use fragbuf_model::Variant;
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Counters, ObjectBox, Output, Settings, block_on};

use crate::drivers::scene::{Quad, vertices};
use crate::order::Numbers;
use crate::peeling::{SIZE, SLICES, shaders_of, sizing};
use crate::stage::{BACKGROUND, FORMAT, device, read_counters, renderer, technique, vertex_buffer};

/// A technique for every kind of peeling.
const PEELED: [&str; 9] = ["k_peeling", "f2b", "f2b_ll", "f2b_1p", "f2b_2p", "f2b_3p", "dual", "dual_2p", "bun"];

/// Returns quads whose depths are in the order of no axis. Three have the depth of another.
pub(crate) fn scene() -> Vec<Quad> {
    let mut numbers = Numbers::seeded(11);
    let quad = |id: u32| Quad {
        x: [numbers.below(4), 5 + numbers.below(SIZE[0] - 4)],
        y: [numbers.below(3), 4 + numbers.below(SIZE[1] - 3)],
        depth: 0.02 + 0.9 * ((id * 7 % 15).min(12) as f32 / 15.0),
        color: std::array::from_fn(|_| numbers.below(256) as u8),
        id,
    };
    (0..15).map(quad).collect()
}

pub(crate) fn boxes_around(quads: &[Quad]) -> Vec<ObjectBox> {
    let clip = |pixel: u32, axis: usize| 2.0 * pixel as f32 / SIZE[axis] as f32 - 1.0;
    let around = |quad: &Quad| ObjectBox {
        least: [clip(quad.x[0], 0), -clip(quad.y[1], 1), quad.depth],
        greatest: [clip(quad.x[1], 0), -clip(quad.y[0], 1), quad.depth],
    };
    quads.iter().map(around).collect()
}

/// Draws each quad as an object; returns the pixels, the counters, and the number of objects that all draws together had.
fn drawn(stage: &Headless, variant: &Variant, quads: &[Quad], slice: Option<u32>) -> (Vec<[f32; 4]>, Counters, usize) {
    let settings = Settings { slice, sizing: sizing(variant), ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
    let mut renderer = renderer(stage, &shaders_of(variant), &settings).unwrap();
    let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
    let buffer = vertex_buffer(stage, &vertices(quads, SIZE, &inputs));
    block_on(&stage.device, renderer.set_objects(&boxes_around(quads))).unwrap().unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE[0], SIZE[1]).unwrap();
    let [r, g, b] = BACKGROUND;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
    let all: Vec<u32> = (0..quads.len() as u32).collect();
    let mut requested = 0;
    let loops = renderer.render(&output, &mut |pass, call| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        let objects = call.objects.unwrap_or(&all);
        requested += objects.len();
        objects.iter().for_each(|object| pass.draw(6 * object..6 * object + 6, 0..1));
    });
    loops.unwrap();
    let counters = read_counters(stage, &renderer);
    (offscreen.colors(&stage.device, &stage.queue).unwrap(), counters, requested)
}

#[test]
fn culling_objects_changes_neither_image_nor_counters() {
    let stage = device();
    let quads = scene();
    for key in PEELED {
        for slice in SLICES {
            let what = format!("{key}, slices of {slice:?} rows");
            let with = |objects| technique(key, &[("objects", objects), ("counters", "all")]);
            let (expected, all, every) = drawn(&stage, &with("all"), &quads, slice);
            let (seen, counters, requested) = drawn(&stage, &with("unpeeled"), &quads, slice);
            assert!(seen == expected, "{what}");
            for name in ["generated", "equal_keys", "not_converged", "pool_exhausted"] {
                assert_eq!(counters.get(name), all.get(name), "{what}: {name}");
            }
            // The first iteration of buckets stores nothing, and a bucket of the back ends late.
            assert!(requested < every || key == "bun" && requested == every, "{what}: {requested} of {every} objects");
        }
    }
}
