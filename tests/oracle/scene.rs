//! Scenes of any size for pixel tests, and their images: quads of constant depth whose edges are edges of pixels, so that coverage is
//! known without a rasteriser.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use super::numbers::Numbers;
use super::reference;

/// A quad over the pixels `x[0] ≤ x < x[1]`, `y[0] ≤ y < y[1]`, y downwards.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    pub x: [u32; 2],
    pub y: [u32; 2],
    pub depth: f32,
    /// Straight red, green, blue and alpha.
    pub color: [u8; 4],
    pub id: u32,
}

impl Quad {
    pub fn covers(&self, x: u32, y: u32) -> bool {
        (self.x[0]..self.x[1]).contains(&x) && (self.y[0]..self.y[1]).contains(&y)
    }
}

/// Returns `count` quads in a frame of this size. Some depths are equal.
pub fn quads(count: u32, [width, height]: [u32; 2], numbers: &mut Numbers) -> Vec<Quad> {
    let range = |numbers: &mut Numbers, size: u32| {
        let first = numbers.below(size);
        [first, first + 1 + numbers.below(size - first)]
    };
    let quad = |id| Quad {
        x: range(numbers, width),
        y: range(numbers, height),
        depth: numbers.below(8) as f32 / 8.0,
        color: std::array::from_fn(|_| numbers.below(256) as u8),
        id,
    };
    (0..count).map(quad).collect()
}

/// Returns the vertices of two triangles per quad, for vertex inputs of these names.
pub fn vertices(quads: &[Quad], [width, height]: [u32; 2], inputs: &[&str]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for quad in quads {
        let [left, right] = quad.x.map(|x| 2.0 * x as f32 / width as f32 - 1.0);
        let [top, bottom] = quad.y.map(|y| 1.0 - 2.0 * y as f32 / height as f32);
        for [x, y] in [[left, top], [left, bottom], [right, bottom], [left, top], [right, bottom], [right, top]] {
            for input in inputs {
                let mut push = |values: &[f32]| bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
                match *input {
                    "position" => push(&[x, y, quad.depth]),
                    "color" => push(&quad.color.map(|channel| f32::from(channel) / 255.0)),
                    // Towards the camera.
                    "normal" => push(&[0.0, 0.0, 1.0]),
                    "id" => bytes.extend(quad.id.to_le_bytes()),
                    other => panic!("no value for the attribute `{other}`"),
                }
            }
        }
    }
    bytes
}

/// Returns the image of the k nearest fragments of each pixel, of all for `None`, over an opaque background. Of equal depths the lesser
/// colour word is nearer.
pub fn image(quads: &[Quad], size: [u32; 2], k: Option<u32>, background: [f64; 3]) -> Vec<[f64; 3]> {
    let words = |quad: &Quad| vec![reference::depth_key(quad.depth), u32::from_le_bytes(quad.color)];
    image_by(&words, quads, size, k, background)
}

/// As [`image`], but of equal depths the one that is drawn first is nearer.
pub fn image_in_order(quads: &[Quad], size: [u32; 2], k: Option<u32>, background: [f64; 3]) -> Vec<[f64; 3]> {
    let place = |quad: &Quad| quads.iter().position(|other| other.id == quad.id).unwrap() as u32;
    image_by(&|quad| vec![reference::depth_key(quad.depth), place(quad)], quads, size, k, background)
}

fn image_by(
    words: &dyn Fn(&Quad) -> Vec<u32>,
    quads: &[Quad],
    [width, height]: [u32; 2],
    k: Option<u32>,
    background: [f64; 3],
) -> Vec<[f64; 3]> {
    let pixel = |index: u32| {
        let covering: Vec<Quad> =
            quads.iter().filter(|quad| quad.covers(index % width, index / width)).copied().collect();
        let kept = reference::best(&covering, words, k);
        let front = reference::over(kept.iter().map(|quad| quad.color.map(|channel| f64::from(channel) / 255.0)));
        over_background(front, background)
    };
    (0..width * height).map(pixel).collect()
}

/// Composites a premultiplied colour over an opaque background.
pub fn over_background(front: [f64; 4], background: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|channel| front[channel] + (1.0 - front[3]) * background[channel])
}

/// Returns the first pixel that differs by more than 1/255, described for people.
pub fn first_difference(seen: &[[f32; 4]], expected: &[[f64; 3]]) -> Option<String> {
    assert_eq!(seen.len(), expected.len());
    let differs = |(seen, expected): (&[f32; 4], &[f64; 3])| {
        (0..3).any(|channel| (f64::from(seen[channel]) - expected[channel]).abs() > 1.0 / 255.0)
    };
    let pixel = seen.iter().zip(expected).position(differs)?;
    Some(format!("pixel {pixel} is {:?}, not {:?}", &seen[pixel][..3], expected[pixel]))
}
