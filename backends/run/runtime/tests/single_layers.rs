//! `resolve: layer` shows what an iteration of peeling stores in a slot, or one fragment of an A-buffer: against the quads of each pixel, sorted
//! by depth. On the driver, whole and in slices, and on the CPU device.

use crate::drivers::scene::Quad;
use crate::order::Numbers;
use crate::peeling::{SIZE, SLICES, counted, drawn_on_cpu};
use crate::stage::{BACKGROUND, device, technique};

/// Returns the place of the fragment that a layer shows, from the front, among the fragments of a pixel.
type Place = fn(layer: usize, fragments: usize) -> Option<usize>;

/// A technique, and what its layers show.
const LAYERS: [(&str, Place); 8] = [
    ("ab_sb", in_order),
    ("ab_ll", in_order),
    ("f2b", in_order),
    ("f2b2", in_order),
    ("f2b_ll", in_order),
    ("f2b_kb", in_order),
    ("dual", from_both_sides),
    ("dual_ll", from_both_sides),
];

fn in_order(layer: usize, _: usize) -> Option<usize> {
    Some(layer)
}

/// An even layer is of the front, an odd one of the back. The one in the middle is of the front.
fn from_both_sides(layer: usize, fragments: usize) -> Option<usize> {
    let iteration = layer / 2;
    match layer % 2 {
        0 => Some(iteration).filter(|front| *front < fragments.div_ceil(2)),
        _ => Some(iteration).filter(|back| *back < fragments / 2).map(|back| fragments - 1 - back),
    }
}

/// Returns quads of different depths, in the order of no axis.
fn scene() -> Vec<Quad> {
    let mut numbers = Numbers::seeded(4);
    let quad = |id: u32| Quad {
        x: [numbers.below(6), 7 + numbers.below(SIZE[0] - 6)],
        y: [numbers.below(3), 4 + numbers.below(SIZE[1] - 3)],
        depth: 0.05 + 0.9 * ((id * 4 % 7) as f32 / 7.0),
        color: std::array::from_fn(|_| numbers.below(256) as u8),
        id,
    };
    (0..7).map(quad).collect()
}

/// Returns the colour of a layer over the background.
fn expected(quads: &[Quad], place: Place, layer: usize, x: u32, y: u32) -> [f32; 3] {
    let covers = |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
    let mut covering: Vec<&Quad> = quads.iter().filter(covers).collect();
    covering.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let background = BACKGROUND.map(|channel| channel as f32);
    let Some(quad) = place(layer, covering.len()).and_then(|place| covering.get(place)) else { return background };
    let [r, g, b, a] = quad.color.map(|channel| f32::from(channel) / 255.0);
    let mut over = [r, g, b].into_iter().zip(background).map(|(front, behind)| front * a + behind * (1.0 - a));
    std::array::from_fn(|_| over.next().unwrap_or_default())
}

#[test]
fn a_layer_is_what_an_iteration_stores() {
    let stage = device();
    let quads = scene();
    for (key, place) in LAYERS {
        let mut shown = 0;
        for layer in 0..5 {
            let number = layer.to_string();
            let set = [("resolve", "layer"), ("resolve.number", number.as_str()), ("counters", "all")];
            let variant = technique(key, &set);
            let on_cpu: Vec<[f32; 4]> =
                drawn_on_cpu(&variant, &quads).into_iter().map(|bits| bits.map(f32::from_bits)).collect();
            for slice in SLICES {
                let (pixels, ..) = counted(&stage, &variant, &quads, slice);
                for (number, pixel) in (0..).zip(&pixels) {
                    let (x, y) = (number % SIZE[0], number / SIZE[0]);
                    let wanted = expected(&quads, place, layer, x, y);
                    let what = format!("{key}, layer {layer}, slices of {slice:?} rows, pixel {x}, {y}");
                    assert!(is_near(&pixel[..3], &wanted), "{what}: {pixel:?} instead of {wanted:?}");
                    // The CPU device returns the colour without the background, premultiplied.
                    let [r, g, b, a] = on_cpu[number as usize];
                    let background = BACKGROUND.map(|channel| channel as f32 * (1.0 - a));
                    let over = [r + background[0], g + background[1], b + background[2]];
                    assert!(is_near(&over, &wanted), "{what}, CPU device: {over:?} instead of {wanted:?}");
                    shown += u32::from(a > 0.0);
                }
            }
        }
        assert!(shown > 100, "{key}: {shown} pixels have a layer");
    }
}

fn is_near(seen: &[f32], wanted: &[f32; 3]) -> bool {
    seen.iter().zip(wanted).all(|(seen, wanted)| (seen - wanted).abs() <= 1.0 / 255.0)
}
