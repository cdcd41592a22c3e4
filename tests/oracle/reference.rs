//! The reference that all pixel tests share, those of this crate and of `backends/run/runtime`. It shares no code with the templates.
#![allow(dead_code, reason = "each test binary uses a part of it")]

/// Returns the k best fragments of a pixel, best first: least key, then least words. `None` keeps all.
pub fn best<T: Clone>(fragments: &[T], words: impl Fn(&T) -> Vec<u32>, k: Option<u32>) -> Vec<T> {
    let mut best = fragments.to_vec();
    best.sort_by_key(words);
    best.truncate(k.map_or(usize::MAX, |k| k as usize));
    best
}

/// Composites straight colours, nearest first, with *over*. The result is premultiplied.
pub fn over(layers: impl IntoIterator<Item = [f64; 4]>) -> [f64; 4] {
    layers.into_iter().fold([0.0; 4], |front, [r, g, b, a]| {
        let left = 1.0 - front[3];
        let layer = [r * a, g * a, b * a, a];
        std::array::from_fn(|channel| front[channel] + left * layer[channel])
    })
}

/// Returns the key of a depth: its bits.
pub fn depth_key(depth: f32) -> u32 {
    if depth > 0.0 { depth.to_bits() } else { 0 }
}

/// Returns the key of a number: its rank in the total order of floats (IEEE 754 sec. 5.10).
pub fn ordered_key(value: f32) -> u32 {
    let bits = value.to_bits() as i32;
    let flipped = if bits < 0 { !bits } else { bits | i32::MIN };
    flipped as u32
}

/// Packs a straight colour to four 8-bit channels, rounded to nearest.
pub fn rgba8(color: [f32; 4]) -> u32 {
    let byte = |channel: f32| (channel.clamp(0.0, 1.0) * 255.0).round() as u32;
    color.iter().enumerate().map(|(index, channel)| byte(*channel) << (8 * index)).sum()
}
