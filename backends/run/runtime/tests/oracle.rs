//! What a fragment buffer is, in plain Rust that shares no code with the templates: the fragments of each pixel, the k
//! best of them, and what is made of those.

use crate::quads::{Quad, SIZE};

/// A fragment as its words in memory, the key first.
pub type Words = Vec<u32>;

/// A description, as the oracle understands it.
#[derive(Clone, Copy)]
pub struct Rules {
    /// A fragment enters iff this is true.
    pub admits: fn(&Quad) -> bool,
    /// Its words in memory.
    pub words: fn(&Quad) -> Words,
    /// Nearest first.
    pub nearer: fn(&Quad) -> Words,
    /// Premultiplied colour and alpha of the kept fragments, nearest first.
    pub resolve: fn(&[Quad]) -> [f64; 4],
}

/// `color: rgba8, depth: f32`, the least depth kept, front-to-back *over*: what a technique does when nothing is said.
pub const PLAIN: Rules = Rules { admits: |_| true, words: plain_words, nearer: plain_words, resolve: over };

fn plain_words(quad: &Quad) -> Words {
    vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color)]
}

pub fn over(kept: &[Quad]) -> [f64; 4] {
    let mut color = [0.0; 4];
    for quad in kept {
        let [r, g, b, a] = quad.color.map(|channel| f64::from(channel) / 255.0);
        let left = 1.0 - color[3];
        for (sum, channel) in color.iter_mut().zip([r * a, g * a, b * a, a]) {
            *sum += left * channel;
        }
    }
    color
}

/// The fragments of one pixel, in the order of drawing.
pub fn fragments(quads: &[Quad], x: u32, y: u32) -> Vec<Quad> {
    quads.iter().filter(|quad| quad.covers(x, y)).copied().collect()
}

/// The `k` best of a pixel, as sorted words; all of them for `None`.
pub fn kept(rules: &Rules, quads: &[Quad], k: Option<u32>, x: u32, y: u32) -> Vec<Quad> {
    let mut kept: Vec<Quad> = fragments(quads, x, y).into_iter().filter(rules.admits).collect();
    kept.sort_by_key(rules.words);
    kept.truncate(k.map_or(usize::MAX, |k| k as usize));
    kept
}

/// The kept fragments of every pixel, each pixel's in ascending order of their words.
pub fn kept_words(rules: &Rules, quads: &[Quad], k: Option<u32>) -> Vec<Vec<Words>> {
    pixels().map(|(x, y)| kept(rules, quads, k, x, y).iter().map(rules.words).collect()).collect()
}

/// The picture over an opaque background.
pub fn picture(rules: &Rules, quads: &[Quad], k: Option<u32>, background: [f64; 3]) -> Vec<[f64; 3]> {
    let pixel = |(x, y)| {
        let mut kept = kept(rules, quads, k, x, y);
        kept.sort_by_key(rules.nearer);
        if kept.is_empty() {
            return background;
        }
        let color = (rules.resolve)(&kept);
        std::array::from_fn(|channel| color[channel] + (1.0 - color[3]) * background[channel])
    };
    pixels().map(pixel).collect()
}

/// Every pixel, row after row.
pub fn pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)))
}

/// How many fragments there are in the frame.
pub fn total(rules: &Rules, quads: &[Quad]) -> usize {
    pixels().map(|(x, y)| kept(rules, quads, None, x, y).len()).sum()
}
