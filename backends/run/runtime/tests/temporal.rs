//! `cull: temporal`: the image is that of the k nearest in every frame, whatever the last frame was, and a frame like the last one inserts fewer
//! fragments.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_runtime::Settings;
use fragbuf_templates::Registry;

use crate::drivers::draw;
use crate::drivers::scene::{Quad, first_difference, image, vertices};
use crate::order::Numbers;
use crate::stage::{BACKGROUND, FORMAT, device, read_counters, renderer, shaders, technique};

const SIZE: [u32; 2] = [24, 16];
const K: u32 = 3;

/// Returns quads from far to near, so that no early cull rejects any.
fn scene(seed: u64, shift: u32) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let quad = |id: u32| Quad {
        x: [(id % 4) * 2 + shift % 5, SIZE[0] - (id % 3)],
        y: [id % 5, SIZE[1] - (shift + id) % 6],
        depth: (15 - id) as f32 / 16.0,
        color: std::array::from_fn(|_| numbers.below(256) as u8),
        id,
    };
    (0..12).map(quad).collect()
}

#[test]
fn the_last_frame_culls_and_is_never_wrong() {
    let stage = device();
    for key in ["kplus_array", "kplus_heap", "kplus_array_revised", "kb_ps", "mdt32_coplanar"] {
        let k = K.to_string();
        let set = [("k", k.as_str()), ("cull", "temporal"), ("counters", "all")];
        let variant = technique(key, &set);
        let settings = Settings::new(FORMAT, SIZE[0], SIZE[1]);
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
        let code = Code::of(&variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{key}: {error}"));
        let mut cpu = Device::new(Arc::new(code), fragbuf_cpu::Settings::new(SIZE[0], SIZE[1])).unwrap();
        let inputs: Vec<String> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.clone()).collect();
        let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
        let mut frame = |quads: &[Quad]| {
            let seen = draw(&stage, &mut renderer, quads, SIZE).unwrap();
            let expected = image(quads, SIZE, Some(K), BACKGROUND);
            assert_eq!(first_difference(&seen, &expected), None, "{key}: {quads:?}");
            let bytes = vertices(quads, SIZE, &inputs);
            let words: Vec<u32> =
                bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
            let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
            let counters =
                cpu.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap().counters.unwrap();
            let on_driver = read_counters(&stage, &renderer);
            assert_eq!(on_driver.get("culled"), counters.get("culled"), "{key}: {quads:?}");
            (counters.get("generated"), counters.get("culled"))
        };
        let first = scene(1, 0);
        // Before the first frame there is no bound, and from far to near no fragment is culled early.
        let (generated, culled) = frame(&first);
        assert_eq!(culled, 0, "{key}");
        // The same frame: exactly the k nearest of each pixel are inserted.
        let covers = |quad: &Quad, x, y| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
        let pixels = (0..SIZE[0] * SIZE[1]).map(|pixel| (pixel % SIZE[0], pixel / SIZE[0]));
        let kept: u32 =
            pixels.map(|(x, y)| (first.iter().filter(|quad| covers(quad, x, y)).count() as u32).min(K)).sum();
        assert_eq!(frame(&first), (generated, generated - kept), "{key}");
        // Objects move, appear and disappear, and come nearer or go away.
        for (seed, shift, depth) in [(2, 1, 0.0), (3, 4, 0.03), (4, 2, -0.02), (5, 0, 0.0)] {
            let mut moved = scene(seed, shift);
            moved.iter_mut().for_each(|quad| quad.depth += depth);
            frame(&moved);
            frame(&moved[..4]);
            moved.reverse();
            frame(&moved);
        }
    }
}
