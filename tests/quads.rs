//! Scenes whose images can be computed without a rasteriser: quads in clip space that cover whole pixels, all of different depths.

use std::path::{Path, PathBuf};

pub const SIZE: usize = 32;

/// A quad over the pixels `x0 ≤ x < x1`, `y0 ≤ y < y1`, `y` downwards, with linear colour and straight alpha.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    pub x0: usize,
    pub y0: usize,
    pub x1: usize,
    pub y1: usize,
    pub depth: f64,
    pub color: [f64; 4],
}

/// A seeded random number generator (xorshift64*).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % end
    }
}

/// The channel values of a scene.
#[derive(Clone, Copy, Debug)]
pub enum Colors {
    /// Multiples of 1/255, which the papers' payload stores exactly.
    Bytes,
    /// Arbitrary values with low alpha, where every layer would round in the same direction.
    Thin,
}

impl Colors {
    fn channel(self, numbers: &mut Numbers) -> f64 {
        match self {
            Colors::Bytes => numbers.below(256) as f64 / 255.0,
            Colors::Thin => (2.0 + numbers.below(20) as f64 + 0.49) / 255.0,
        }
    }
}

/// Returns `count` quads of different depths.
pub fn quads(count: usize, seed: u64, colors: Colors) -> Vec<Quad> {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9) | 1);
    let mut depths: Vec<usize> = (1..=count).collect();
    for index in (1..count).rev() {
        depths.swap(index, numbers.below(index + 1));
    }
    let quad = |depth: usize| {
        let (x0, y0) = (numbers.below(SIZE), numbers.below(SIZE));
        let (x1, y1) = (x0 + 1 + numbers.below(SIZE - x0), y0 + 1 + numbers.below(SIZE - y0));
        let color = std::array::from_fn(|_| colors.channel(&mut numbers));
        Quad { x0, y0, x1, y1, depth: depth as f64 / (count + 1) as f64, color }
    };
    depths.into_iter().map(quad).collect()
}

/// Writes the quads to a model with one material each.
pub fn write(folder: &Path, quads: &[Quad]) -> PathBuf {
    let (mut model, mut library) = ("mtllib T.mtl\n".to_owned(), String::new());
    for (index, quad) in quads.iter().enumerate() {
        let [r, g, b, a] = quad.color;
        library.push_str(&format!("newmtl m{index}\nKd {r} {g} {b}\nd {a}\n"));
        let clip = |x: usize, y: usize| {
            let half = SIZE as f64 / 2.0;
            format!("v {} {} {}\n", x as f64 / half - 1.0, 1.0 - y as f64 / half, quad.depth)
        };
        for (x, y) in [(quad.x0, quad.y0), (quad.x0, quad.y1), (quad.x1, quad.y1), (quad.x1, quad.y0)] {
            model.push_str(&clip(x, y));
        }
        // One polygon, or two triangles with relative indices.
        let first = 4 * index + 1;
        let faces = if index % 2 == 0 {
            format!("f {first} {} {} {}\n", first + 1, first + 2, first + 3)
        } else {
            "f -4 -3 -2\nf -4 -2 -1\n".to_owned()
        };
        model.push_str(&format!("o q{index}\nusemtl m{index}\n{faces}"));
    }
    std::fs::write(folder.join("T.mtl"), library).unwrap();
    let path = folder.join("T.obj");
    std::fs::write(&path, model).unwrap();
    path
}
