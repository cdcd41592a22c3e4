//! A k of its own for each pixel: the image, the memory and the k of the frame are those that follow from the importance and the budget, on the
//! driver and on the CPU device.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::headless::Headless;
use fragbuf_runtime::{Renderer, Settings, block_on};
use fragbuf_templates::Registry;

use crate::allocation::{BUDGET, constant};
use crate::drivers::draw;
use crate::drivers::scene::{Quad, first_difference, image, vertices};
use crate::order::Numbers;
use crate::stage::{BACKGROUND, FORMAT, device, renderer, shaders, technique};

/// A frame, its slices, and the levels of importance of its pixels.
struct Scene {
    size: [u32; 2],
    rows: Option<u32>,
    levels: Vec<u32>,
    quads: Vec<Quad>,
}

impl Scene {
    fn new(size: [u32; 2], rows: Option<u32>, layers: u32, seed: u64) -> Self {
        let mut numbers = Numbers::seeded(seed);
        let [width, height] = size;
        let levels = (0..width * height).map(|_| [0, 255, 85, 1, numbers.below(256)][numbers.below(5) as usize]);
        let levels = levels.collect();
        let quad = |id: u32| Quad {
            // Most cover all pixels but the first row.
            x: [0, width - id % 5],
            y: [1, height - id % 3],
            depth: (1 + id * 7 % layers) as f32 / 64.0,
            color: std::array::from_fn(|_| numbers.below(256) as u8),
            id,
        };
        let quads = (0..layers).map(quad).collect();
        Scene { size, rows, levels, quads }
    }

    /// Returns the importance of every pixel. That of the greatest and the least may lie beyond 0 and 1.
    fn importance(&self) -> Vec<f32> {
        let value = |level: &u32| match level {
            0 => -0.5,
            255 => 1.5,
            level => *level as f32 / 255.0,
        };
        self.levels.iter().map(value).collect()
    }

    fn fragments(&self) -> Vec<u32> {
        let [width, height] = self.size;
        let covers =
            |quad: &Quad, x: u32, y: u32| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
        let count =
            |pixel: u32| self.quads.iter().filter(|quad| covers(quad, pixel % width, pixel / width)).count() as u32;
        (0..width * height).map(count).collect()
    }

    /// Returns, for each slice, its k, the fragments that it keeps, and the k of its pixels. `bytes` is over the pixels of a slice and the kept
    /// fragments.
    fn expected(&self, keep: u32, bytes: impl Fn(u64, u64) -> u64) -> Vec<(u32, u64, Vec<u32>)> {
        let [width, height] = self.size;
        let pixels = (width * self.rows.unwrap_or(height)) as usize;
        let (counts, levels) = (self.fragments(), &self.levels);
        let slices = counts.chunks(pixels).zip(levels.chunks(pixels)).map(|(counts, levels)| {
            let slots = |k: u32| levels.iter().map(|level| (level * k).div_ceil(255).max(1)).collect::<Vec<u32>>();
            let kept =
                |k: u32| counts.iter().zip(slots(k)).map(|(count, slots)| u64::from(slots.min(*count))).sum::<u64>();
            let fits = |k: &u32| bytes(pixels as u64, kept(*k)) <= BUDGET;
            let greatest = (1..=keep).take_while(fits).last().unwrap();
            let k = (1..=greatest).find(|k| kept(*k) == kept(greatest)).unwrap();
            (k, kept(k), slots(k))
        });
        slices.collect()
    }

    /// Returns the image if every pixel keeps so many of its fragments.
    fn image(&self, slots: &[u32]) -> Vec<[f64; 3]> {
        let most = slots.iter().copied().max().unwrap();
        let images: Vec<_> = (1..=most).map(|k| image(&self.quads, self.size, Some(k), BACKGROUND)).collect();
        slots.iter().enumerate().map(|(pixel, k)| images[*k as usize - 1][pixel]).collect()
    }
}

/// Creates a texture with a number per pixel.
fn texture(stage: &Headless, [width, height]: [u32; 2], values: &[f32]) -> wgpu::Texture {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = stage.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("importance"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    stage.queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    texture
}

/// Draws a scene on both devices. Returns the k of the last slice.
fn check(stage: &Headless, variant: &Variant, scene: &Scene, keep: u32) -> u32 {
    let [width, height] = scene.size;
    let beside = constant(variant);
    // Counts, locks, offsets with one more, and a sum per block of 1024 pixels.
    let bytes = |pixels: u64, kept: u64| 8 * kept + 4 * (3 * pixels + 1 + pixels.div_ceil(1024)) + beside;
    let expected = scene.expected(keep, bytes);
    let (k, kept, _) = expected.last().unwrap().clone();
    let slots: Vec<u32> = expected.iter().flat_map(|(_, _, slots)| slots.clone()).collect();
    let expected = scene.image(&slots);

    let settings = Settings { slice: scene.rows, ..Settings::new(FORMAT, width, height) };
    let mut renderer: Renderer = renderer(stage, &shaders(variant, "wgsl"), &settings).unwrap();
    let importance = texture(stage, scene.size, &scene.importance());
    block_on(&stage.device, renderer.set_texture("importance", &importance)).unwrap().unwrap();
    let seen = draw(stage, &mut renderer, &scene.quads, scene.size).unwrap();
    assert_eq!(renderer.k(), Some(k));
    // The last slice may use what a former one has allocated.
    assert!(scene.rows.is_some() || renderer.symbol("kept") == Some(kept), "{:?}", renderer.symbol("kept"));
    assert!(renderer.allocated_bytes() <= BUDGET, "{} bytes", renderer.allocated_bytes());
    assert_eq!(first_difference(&seen, &expected), None, "k = {k}");

    let code = Arc::new(Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")));
    let settings = fragbuf_cpu::Settings { slice: scene.rows, ..fragbuf_cpu::Settings::new(width, height) };
    let mut cpu = Device::new(code, settings).unwrap();
    cpu.set_texture("importance", &scene.importance()).unwrap();
    let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
    let bytes = vertices(&scene.quads, scene.size, &inputs);
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * scene.quads.len() as u32).collect();
    let picture = cpu.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    assert!(picture.out_of_bounds.is_empty(), "{:?}", picture.out_of_bounds);
    assert_eq!((cpu.symbol("k"), cpu.symbol("kept")), (Some(k.into()), Some(kept)));
    let mut over = picture.pixels;
    for [r, g, b, a] in &mut over {
        let behind = BACKGROUND.map(|channel| (1.0 - *a) * channel as f32);
        (*r, *g, *b, *a) = (*r + behind[0], *g + behind[1], *b + behind[2], 1.0);
    }
    assert_eq!(first_difference(&over, &expected), None, "on the CPU device, k = {k}");
    k
}

#[test]
fn the_budget_is_shared_by_importance() {
    let stage = device();
    let set = [("k", "32"), ("allocation", "by_importance"), ("allocation.budget", "1")];
    let variant = technique("kplus_ab_sb", &set);
    let whole = check(&stage, &variant, &Scene::new([128, 128], None, 24, 1), 32);
    assert!((2..24).contains(&whole), "the budget limits k: {whole}");
    let sliced = check(&stage, &variant, &Scene::new([128, 128], Some(48), 24, 2), 32);
    assert!(sliced > whole, "a slice has the whole budget: {sliced}");
}

/// Small k, heaps and arrays, odd sizes, and the padding of tiles.
#[test]
fn every_pixel_keeps_its_share() {
    let stage = device();
    for (keep, array) in [(1, "16"), (3, "16"), (9, "4"), (9, "0")] {
        for addressing in ["linear", "tiled", "morton"] {
            let text = keep.to_string();
            let set = [
                ("k", text.as_str()),
                ("allocation", "by_importance"),
                ("storage.array", array),
                ("addressing", addressing),
            ];
            let variant = technique("kplus_ab_sb", &set);
            let scene = Scene::new([37, 23], None, 12, u64::from(keep));
            // The padding of tiles only adds bytes to a budget that is far away.
            let k = check(&stage, &variant, &scene, keep);
            assert_eq!(k, keep, "{addressing}");
        }
    }
}
