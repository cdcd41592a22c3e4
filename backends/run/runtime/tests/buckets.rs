//! Lists per depth bucket: a fragment is in the right fifth of its pixel's depth range. Neither kept sets nor images test that.

use crate::capture::scattered;
use crate::oracle::{PLAIN, fragments, pixels};
use crate::order::orders;
use crate::quads::{Quad, SIZE};
use crate::stage::{device, draw_over, read_buffers, renderer, settings, shaders, technique};
use fragbuf_runtime::headless::Offscreen;

const BUCKETS: usize = 5;

/// Returns the keys in each bucket of a pixel, in ascending order. Depths are exact multiples of 2^-24.
fn expected(fragments: &[Quad]) -> [Vec<u32>; BUCKETS] {
    let fixed = |quad: &Quad| (f64::from(quad.depth) * f64::from(1 << 24)) as u64;
    let mut buckets: [Vec<u32>; BUCKETS] = Default::default();
    let (Some(near), Some(far)) = (fragments.iter().map(fixed).min(), fragments.iter().map(fixed).max()) else {
        return buckets;
    };
    for quad in fragments {
        let bucket = (fixed(quad) - near) * BUCKETS as u64 / (far - near + 1);
        buckets[bucket as usize].push((PLAIN.words)(quad)[0]);
    }
    buckets.iter_mut().for_each(|bucket| bucket.sort());
    buckets
}

#[test]
fn every_fragment_is_in_its_fifth_of_the_pixels_depth_range() {
    let stage = device();
    let mut renderer = renderer(&stage, &shaders(&technique("ab_ll_bun", &[]), "wgsl"), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, crate::stage::FORMAT, SIZE, SIZE).unwrap();
    let flat = |depths: &[f32]| depths.iter().map(|depth| Quad::whole(*depth, [9; 4])).collect::<Vec<Quad>>();
    let scenes = [
        flat(&[0.25]),
        flat(&[0.5, 0.5]),
        flat(&[0.1, 0.2, 0.3, 0.4]),
        flat(&[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        flat(&[0.0, 1.0, 0.599_999_9, 0.600_000_1]),
        scattered(8, 11),
    ];
    let mut filled = [0; BUCKETS];
    for scene in scenes {
        for quads in orders(&scene) {
            draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
            let buffers = read_buffers(&stage, &renderer);
            for (pixel, (x, y)) in pixels().enumerate() {
                for (number, expected) in expected(&fragments(&quads, x, y)).iter().enumerate() {
                    let link = |word: u32| word.checked_sub(1);
                    let head = link(buffers["heads"][number * (SIZE * SIZE) as usize + pixel]);
                    let nodes = std::iter::successors(head, |node| link(buffers["links"][*node as usize]));
                    let mut keys: Vec<u32> = nodes.map(|node| buffers["nodes"][2 * node as usize]).collect();
                    keys.sort();
                    assert_eq!(keys, *expected, "bucket {number} of pixel {x}, {y} of {quads:?}");
                    filled[number] += keys.len();
                }
            }
        }
    }
    assert!(filled.iter().all(|count| *count > 0), "{filled:?}");
}
