//! Frames with more pixels than one workgroup, or one level of the prefix sums, covers; and frames in slices. The quads are those
//! of the other tests, on a grid of 16 × 16 cells of many pixels each.

use fragbuf_codegen::{Action, Command};
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{PassTime, Renderer, Settings};

use crate::capture::scattered;
use crate::oracle::{PLAIN, fragments, image};
use crate::quads::{Quad, SIZE};
use crate::stage::{
    BACKGROUND, FORMAT, device, draw_over, read_buffers, read_counters, renderer, settings, shaders, technique,
};

/// Frames of a few blocks of 1024 pixels, and of more than the 256 blocks that a workgroup sums at once.
const SIZES: [(u32, u32); 2] = [(80, 48), (640, 480)];

fn cell(size: (u32, u32), pixel: usize) -> (u32, u32) {
    let (x, y) = (pixel as u32 % size.0, pixel as u32 / size.0);
    (x / (size.0 / SIZE), y / (size.1 / SIZE))
}

#[test]
fn every_pixel_of_a_large_frame_is_right() {
    let stage = device();
    let quads = scattered(12, 77);
    for size in SIZES {
        for (key, k) in [("kplus_array", "4"), ("kb", "4"), ("ab_ll", "all"), ("ab_sb", "all")] {
            let settings = Settings { width: size.0, height: size.1, ..settings() };
            let mut renderer = renderer(&stage, &shaders(&technique(key, &[("k", k)]), "wgsl"), &settings).unwrap();
            let offscreen = Offscreen::new(&stage.device, FORMAT, size.0, size.1).unwrap();
            draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
            let expected = image(&PLAIN, &quads, renderer.k(), BACKGROUND);
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
fn regions_are_contiguous() {
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

/// Slices do not change a bit of the image. Memory is that of one slice; counters and times are sums over all. Sixteen rows make
/// three slices of five rows and one of one.
#[test]
fn slices_give_the_same_image() {
    let stage = device();
    let quads: Vec<Quad> = scattered(12, 79);
    for (key, k) in [("kplus_array", "4"), ("kb", "4"), ("ab_ll", "all"), ("ab_sb", "all")] {
        let shaders = shaders(&technique(key, &[("k", k), ("counters", "all")]), "wgsl");
        let render = |slice: Option<u32>| {
            let settings = Settings { slice, timestamps: true, ..settings() };
            let mut renderer = renderer(&stage, &shaders, &settings).unwrap();
            let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
            draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
            let colors = offscreen.colors(&stage.device, &stage.queue).unwrap();
            (colors, read_counters(&stage, &renderer), read_times(&stage, &renderer), renderer)
        };
        let (whole, counted, _, one) = render(None);
        let (sliced, counted_in_slices, times, four) = render(Some(5));
        assert_eq!((one.slices(), four.slices()), (1, 4), "{key}");
        assert!(whole == sliced, "{key}: the slices differ");
        assert_eq!(counted, counted_in_slices, "{key}");
        assert!(times.iter().all(|time| time.untimed == 0), "{key}: queries for one slice only: {times:?}");
        assert!(times.iter().any(|time| time.milliseconds > 0.0), "{key}: {times:?}");
        assert_eq!((one.symbol("pixels"), four.symbol("pixels")), (Some(16 * 16), Some(5 * 16)));
    }
}

/// A slice may end within a tile.
#[test]
fn slices_through_tiles_give_the_same_image() {
    let stage = device();
    let quads: Vec<Quad> = scattered(12, 80);
    for (key, k) in [("kplus_array", "4"), ("ab_ll", "all"), ("ab_sb", "all")] {
        let render = |addressing: &str, slice: Option<u32>| {
            let shaders = shaders(&technique(key, &[("k", k), ("addressing", addressing)]), "wgsl");
            let mut renderer = renderer(&stage, &shaders, &Settings { slice, ..settings() }).unwrap();
            let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
            draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
            (offscreen.colors(&stage.device, &stage.queue).unwrap(), renderer.symbol("pixels"))
        };
        let (whole, _) = render("linear", None);
        for (addressing, pixels) in [("tiled", 8 * 16), ("morton", 8 * 16)] {
            assert!(render(addressing, None) == (whole.clone(), Some(16 * 16)), "{key}, {addressing}");
            assert!(render(addressing, Some(5)) == (whole.clone(), Some(pixels)), "{key}, {addressing} in slices");
        }
    }
}

/// Slices that follow from limits consist of whole tiles.
#[test]
fn slices_that_follow_from_limits_end_with_a_tile() {
    let stage = device();
    let shaders = shaders(&technique("kplus_array", &[("k", "1024"), ("addressing", "tiled")]), "wgsl");
    let renderer = renderer(&stage, &shaders, &Settings { width: 1023, height: 3000, ..settings() }).unwrap();
    let rows = renderer.symbol("height").unwrap();
    assert!(renderer.slices() > 1 && rows.is_multiple_of(8), "{rows} rows");
    assert_eq!(renderer.symbol("pixels"), Some(1024 * rows));
}

#[test]
fn a_frame_beyond_the_buffer_limit_is_sliced_automatically() {
    let stage = device();
    let limit = stage.device.limits().max_storage_buffer_binding_size.min(stage.device.limits().max_buffer_size);
    // One row more than fits into a binding: 4 bytes per key, 1024 keys per pixel.
    let width = 1024;
    let rows = (limit / (4 * 1024 * u64::from(width))) as u32;
    let shaders = shaders(&technique("kplus_array", &[("k", "1024")]), "wgsl");
    let settings = Settings { width, height: rows + 1, ..settings() };
    let mut renderer = renderer(&stage, &shaders, &settings).unwrap();
    assert_eq!((renderer.slices(), renderer.symbol("height")), (2, Some(rows.into())));
    let offscreen = Offscreen::new(&stage.device, FORMAT, width, rows + 1).unwrap();
    draw_over(&stage, &mut renderer, &[Quad::whole(0.5, [10, 20, 30, 255])], &offscreen).unwrap();
    let colors = offscreen.colors(&stage.device, &stage.queue).unwrap();
    assert!(colors.iter().all(|color| *color == colors[0]), "both slices are drawn");
    assert!((255.0 * colors[0][1] - 20.0).abs() < 0.1, "{:?}", colors[0]);
}

/// WebGPU clears only to zero. Other words are copied, 64 KiB at a time.
#[test]
fn a_clear_step_sets_every_word_of_a_resource() {
    let stage = device();
    let mut shaders = shaders(&technique("kplus_array", &[("k", "2")]), "wgsl");
    let resource = shaders.plan.resource_id("locks").unwrap();
    let action = Action::Clear { resource, value: 0x0123_4567 };
    shaders.plan.frame.commands.push(Command { action, parities: Vec::new() });
    for (width, height) in [(1, 1), (128, 128), (150, 301)] {
        let mut renderer = renderer(&stage, &shaders, &Settings { width, height, ..settings() }).unwrap();
        let offscreen = Offscreen::new(&stage.device, FORMAT, width, height).unwrap();
        draw_over(&stage, &mut renderer, &[], &offscreen).unwrap();
        let words = &read_buffers(&stage, &renderer)["locks"];
        assert_eq!(words.len() as u32, width * height);
        assert!(words.iter().all(|word| *word == 0x0123_4567));
    }
}

fn read_times(stage: &Headless, renderer: &Renderer) -> Vec<PassTime> {
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let times = renderer.pass_times(&mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    times.wait(&stage.device).unwrap()
}
