//! Frames of more pixels than one workgroup, or one round of the prefix sums, goes over; and frames in slices. The quads
//! are the same as everywhere, on a grid of 16 × 16 cells of many pixels each.

use fragbuf_runtime::headless::Offscreen;
use fragbuf_runtime::{Output, Renderer, Settings};

use crate::capture::scattered;
use crate::oracle::{PLAIN, fragments, picture};
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{BACKGROUND, FORMAT, device, draw_over, read_buffers, renderer, settings, shaders, technique};

/// Blocks of 1024 pixels: some more than one, and more than the 256 that a workgroup sums up at once.
const SIZES: [(u32, u32); 2] = [(80, 48), (640, 480)];

fn cell(size: (u32, u32), pixel: usize) -> (u32, u32) {
    let (x, y) = (pixel as u32 % size.0, pixel as u32 / size.0);
    (x / (size.0 / SIZE), y / (size.1 / SIZE))
}

#[test]
fn pictures_of_many_pixels_are_right_in_each() {
    let stage = device();
    let quads = scattered(12, 77);
    for size in SIZES {
        for (key, k) in [("kplus_array", "4"), ("kb", "4"), ("ab_ll", "all"), ("ab_sb", "all")] {
            let settings = Settings { width: size.0, height: size.1, ..settings() };
            let mut renderer = renderer(&stage, &shaders(&technique(key, &[("k", k)]), "wgsl"), &settings).unwrap();
            let offscreen = Offscreen::new(&stage.device, FORMAT, size.0, size.1).unwrap();
            draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
            let expected = picture(&PLAIN, &quads, renderer.k(), BACKGROUND);
            for (pixel, seen) in offscreen.colors(&stage.device, &stage.queue).unwrap().into_iter().enumerate() {
                let (x, y) = cell(size, pixel);
                for (seen, expected) in seen.iter().zip(expected[(y * SIZE + x) as usize]) {
                    let off = 255.0 * (f64::from(*seen) - expected).abs();
                    assert!(off <= 1.0, "{key}: pixel {pixel} of {size:?} is off by {off}/255");
                }
            }
        }
    }
}

#[test]
fn regions_follow_each_other_without_a_gap() {
    let stage = device();
    let quads = scattered(12, 78);
    for size in SIZES {
        let settings = Settings { width: size.0, height: size.1, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&technique("ab_sb", &[]), "wgsl"), &settings).unwrap();
        let offscreen = Offscreen::new(&stage.device, FORMAT, size.0, size.1).unwrap();
        draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
        let offsets = &read_buffers(&stage, &renderer)["offsets"];
        let mut expected = 0;
        for (pixel, offset) in offsets.iter().enumerate() {
            assert_eq!(*offset, expected, "before pixel {pixel} of {size:?}");
            let (x, y) = cell(size, pixel);
            expected += fragments(&quads, x, y).len() as u32;
        }
        assert_eq!(renderer.symbol("fragments"), Some(u64::from(offsets[offsets.len() - 1])));
    }
}

/// A frame whose buffers are beyond a limit can be made in slices: a renderer of a slice's size, and a viewport in the
/// draw function that moves the slice to the top. Rasterisation is the same, to the bit.
#[test]
fn slices_make_the_same_picture() {
    let stage = device();
    let quads: Vec<Quad> = scattered(8, 79);
    let shaders = shaders(&technique("kplus_array", &[("k", "4")]), "wgsl");
    let mut whole = renderer(&stage, &shaders, &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    draw_over(&stage, &mut whole, &quads, &offscreen).unwrap();
    let expected = offscreen.colors(&stage.device, &stage.queue).unwrap();

    let rows = 4;
    let mut slice: Renderer = renderer(&stage, &shaders, &Settings { height: rows, ..settings() }).unwrap();
    assert_eq!(slice.allocated_bytes() - 24, (whole.allocated_bytes() - 24) / 4);
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, rows).unwrap();
    let bytes = vertices(&quads, slice.vertex_inputs());
    let buffer = stage.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("quads"),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    stage.queue.write_buffer(&buffer, 0, &bytes);
    let [r, g, b] = BACKGROUND;
    let mut seen = Vec::new();
    for first in (0..SIZE).step_by(rows as usize) {
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
        let draw = &mut |pass: &mut wgpu::RenderPass<'_>, _: &_| {
            pass.set_viewport(0.0, -(first as f32), SIZE as f32, SIZE as f32, 0.0, 1.0);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..6 * quads.len() as u32, 0..1);
        };
        slice.render(&output, draw).unwrap();
        seen.extend(offscreen.colors(&stage.device, &stage.queue).unwrap());
    }
    assert_eq!(seen, expected);
}
