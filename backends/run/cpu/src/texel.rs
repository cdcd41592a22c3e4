//! Texels: the encoding of channels in words, per texture format.
//!
//! Values are clamped and rounded to nearest, as the graphics APIs require.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_interpreter::{from_half, to_half};
use fragbuf_templates::vocabulary::TextureFormat;

/// The greatest 24-bit depth.
pub(crate) const DEPTH_24: f64 = 16_777_215.0;

/// The texel format of an attachment or a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Texel {
    /// The format of a texture of the plan.
    Format(TextureFormat),
    /// Four floats: the output of the caller, and textures of a description.
    Output,
}

impl Texel {
    /// Returns the words of a texel.
    pub(crate) fn words(self) -> usize {
        match self {
            Texel::Format(format) => format.words() as usize,
            Texel::Output => 4,
        }
    }

    /// Returns whether the channels are integers, which cannot be blended.
    pub(crate) fn is_integer(self) -> bool {
        matches!(self, Texel::Format(TextureFormat::R32Uint | TextureFormat::Rg16Uint))
    }

    /// Returns the words of the texel `index`; those beyond its size are 0.
    pub(crate) fn load(self, stored: &[AtomicU32], index: usize) -> [u32; 4] {
        let words = self.words();
        std::array::from_fn(|word| match stored.get(index * words + word) {
            Some(stored) if word < words => stored.load(Ordering::Relaxed),
            _ => 0,
        })
    }

    /// Encodes the channels of an integer texel.
    pub(crate) fn encode_integer(self, channels: [u32; 4]) -> [u32; 4] {
        let [low, high, ..] = channels;
        match self {
            Texel::Format(TextureFormat::Rg16Uint) => [low & 0xffff | high << 16, 0, 0, 0],
            _ => channels,
        }
    }

    /// Decodes the channels of an integer texel: a colour or a stencil.
    pub(crate) fn decode_integer(self, words: [u32; 4]) -> [u32; 4] {
        match self {
            Texel::Format(TextureFormat::Rg16Uint) => [words[0] & 0xffff, words[0] >> 16, 0, 1],
            Texel::Format(TextureFormat::Depth24PlusStencil8) => [words[0] & 0xff, 0, 0, 1],
            _ => [words[0], 0, 0, 1],
        }
    }

    /// Decodes the channels of a texel.
    pub(crate) fn decode(self, words: [u32; 4]) -> [f32; 4] {
        let [a, b, _, _] = words;
        match self {
            Texel::Output => words.map(f32::from_bits),
            Texel::Format(TextureFormat::Rg32Float) => [f32::from_bits(a), f32::from_bits(b), 0.0, 1.0],
            Texel::Format(TextureFormat::Rgba8Unorm) => a.to_le_bytes().map(|byte| f32::from(byte) / 255.0),
            Texel::Format(TextureFormat::Rgba16Float) => [a, a >> 16, b, b >> 16].map(|half| from_half(half as u16)),
            Texel::Format(TextureFormat::Depth24PlusStencil8) => [(f64::from(a >> 8) / DEPTH_24) as f32, 0.0, 0.0, 1.0],
            Texel::Format(_) => [f32::from_bits(a), 0.0, 0.0, 1.0],
        }
    }

    /// Encodes the channels of a texel; words beyond its size are 0.
    pub(crate) fn encode(self, channels: [f32; 4]) -> [u32; 4] {
        let [r, g, b, a] = channels;
        match self {
            Texel::Output => channels.map(f32::to_bits),
            Texel::Format(TextureFormat::Rg32Float) => [r.to_bits(), g.to_bits(), 0, 0],
            Texel::Format(TextureFormat::Rgba8Unorm) => {
                let bytes = channels.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round_ties_even() as u8);
                [u32::from_le_bytes(bytes), 0, 0, 0]
            }
            Texel::Format(TextureFormat::Rgba16Float) => [pair(r, g), pair(b, a), 0, 0],
            Texel::Format(_) => [r.to_bits(), 0, 0, 0],
        }
    }
}

fn pair(low: f32, high: f32) -> u32 {
    u32::from(to_half(low)) | u32::from(to_half(high)) << 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoded_texels_decode_to_the_same_channels() {
        let color = [0.0, 1.0, 0.2, 0.6];
        for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba16Float] {
            let texel = Texel::Format(format);
            let once = texel.decode(texel.encode(color));
            assert_eq!(texel.decode(texel.encode(once)), once);
            assert!(once.iter().zip(color).all(|(seen, exact)| (seen - exact).abs() < 1.0 / 500.0), "{once:?}");
        }
        assert_eq!(
            Texel::Format(TextureFormat::Rg32Float).decode([1.5f32.to_bits(), 2.5f32.to_bits(), 9, 9])[..2],
            [1.5, 2.5]
        );
        assert_eq!(Texel::Format(TextureFormat::Rgba8Unorm).encode([2.0, -1.0, 0.5, 1.0])[0], 0xff80_00ff);
        assert_eq!(Texel::Output.decode(Texel::Output.encode(color)), color);
    }
}
