//! The oracle: a fragment buffer in plain Rust that shares no code with the templates. It computes the fragments of each pixel, the k
//! best of them, and their colour.

#[path = "../../../../tests/oracle/reference.rs"]
pub mod reference;

pub use reference::ordered_key;

use crate::quads::{Quad, SIZE};

/// A fragment as its words in memory, the key first.
pub type Words = Vec<u32>;

/// A description, as the oracle evaluates it.
#[derive(Clone, Copy)]
pub struct Rules {
    /// Whether a fragment meets the constraints.
    pub admits: fn(&Quad) -> bool,
    /// The words of a fragment in memory.
    pub words: fn(&Quad) -> Words,
    /// The sort key of a fragment: the nearest has the least.
    pub nearer: fn(&Quad) -> Words,
    /// Premultiplied colour and alpha of the kept fragments, nearest first.
    pub resolve: fn(&[Quad]) -> [f64; 4],
}

/// `color: rgba8, depth: f32`, the least depth kept, front-to-back *over*: the defaults of a technique.
pub const PLAIN: Rules = Rules { admits: |_| true, words: plain_words, nearer: plain_words, resolve: over };

fn plain_words(quad: &Quad) -> Words {
    vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color)]
}

/// Composites the kept fragments, nearest first, with *over*. The result is premultiplied.
pub fn over(kept: &[Quad]) -> [f64; 4] {
    reference::over(kept.iter().map(|quad| quad.color.map(|channel| f64::from(channel) / 255.0)))
}

/// Returns the fragments of one pixel, in drawing order.
pub fn fragments(quads: &[Quad], x: u32, y: u32) -> Vec<Quad> {
    quads.iter().filter(|quad| quad.covers(x, y)).copied().collect()
}

/// Returns the `k` best fragments of a pixel, sorted by their words; all of them for `None`.
pub fn kept(rules: &Rules, quads: &[Quad], k: Option<u32>, x: u32, y: u32) -> Vec<Quad> {
    let admitted: Vec<Quad> = fragments(quads, x, y).into_iter().filter(rules.admits).collect();
    reference::best(&admitted, rules.words, k)
}

/// Returns the kept fragments of every pixel, each pixel's in ascending order of their words.
pub fn kept_words(rules: &Rules, quads: &[Quad], k: Option<u32>) -> Vec<Vec<Words>> {
    pixels().map(|(x, y)| kept(rules, quads, k, x, y).iter().map(rules.words).collect()).collect()
}

/// Returns the image over an opaque background.
pub fn image(rules: &Rules, quads: &[Quad], k: Option<u32>, background: [f64; 3]) -> Vec<[f64; 3]> {
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

/// Returns every pixel, row by row.
pub fn pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)))
}

/// Returns the number of fragments in the frame.
pub fn total(rules: &Rules, quads: &[Quad]) -> usize {
    pixels().map(|(x, y)| kept(rules, quads, None, x, y).len()).sum()
}
