//! Textures as shaders read them, texel by texel and sample by sample.
//!
//! Texels are not filtered, and shaders do not write them.

use std::sync::atomic::AtomicU32;

use fragbuf_frame::{Error, unsupported};
use fragbuf_interpreter::Texture;
use fragbuf_templates::vocabulary::{Element, TextureFormat};
use naga::ScalarKind;

use crate::memory::Words;
use crate::texel::Texel;

/// A resource bound to a texture of a program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundTexture<'a> {
    words: &'a [AtomicU32],
    texel: Texel,
    /// Whether the shader reads integers; of depth with stencil, the stencil.
    is_integer: bool,
    size: (u32, u32),
    /// The samples of a texel, or the slices of a texture with three dimensions.
    samples: u32,
}

/// A texture of the description: four floats per texel, rows after one another, and slices.
#[derive(Debug, Default)]
pub(crate) struct DescribedTexture {
    pub(crate) size: [u32; 3],
    pub(crate) words: Words,
}

impl<'a> BoundTexture<'a> {
    /// Binds a resource to `texture`. `Err`: the declaration does not match the resource.
    pub(crate) fn of(
        texture: &Texture,
        words: &'a [AtomicU32],
        element: Element,
        size: (u32, u32),
    ) -> Result<Self, Error> {
        let mismatch = |what: &str| Err(unsupported(format!("the texture `{}`: {what}", texture.name)));
        let Element::Texture(format) = element else { return mismatch("the plan has a buffer at this binding") };
        let pixels = size.0 as usize * size.1 as usize;
        let samples = (words.len() / (pixels * format.words() as usize).max(1)) as u32;
        if samples == 0 || (samples > 1) != texture.is_multisampled {
            return mismatch(&format!("the plan has {samples} samples, and the declaration does not match"));
        }
        let is_integer = texture.kind != ScalarKind::Float;
        let fits = match format {
            TextureFormat::R32Uint | TextureFormat::Rg16Uint => texture.kind == ScalarKind::Uint && !texture.is_depth,
            TextureFormat::Depth24PlusStencil8 => texture.kind != ScalarKind::Sint,
            TextureFormat::Depth32Float => !is_integer,
            _ => !is_integer && !texture.is_depth,
        };
        if !fits {
            return mismatch(&format!("its declaration does not match the format {format:?}"));
        }
        Ok(BoundTexture { words, texel: Texel::Format(format), is_integer, size, samples })
    }

    /// Binds a texture of the description.
    pub(crate) fn described(texture: &'a DescribedTexture) -> Self {
        let [width, height, slices] = texture.size;
        BoundTexture {
            words: &texture.words,
            texel: Texel::Output,
            is_integer: false,
            size: (width, height),
            samples: slices,
        }
    }

    /// Returns the texel at a column, a row, and a sample, a slice or the only level. `None`: out of bounds.
    pub(crate) fn texel(&self, [x, y, sample]: [u32; 3]) -> Option<[u32; 4]> {
        let (width, height) = self.size;
        if x >= width || y >= height || sample >= self.samples {
            return None;
        }
        let pixels = width as usize * height as usize;
        let index = sample as usize * pixels + y as usize * width as usize + x as usize;
        let words = self.texel.load(self.words, index);
        let floats = || self.texel.decode(words).map(f32::to_bits);
        Some(if self.is_integer { self.texel.decode_integer(words) } else { floats() })
    }

    /// Returns the columns, rows, and samples or slices.
    pub(crate) fn extent(&self) -> [u32; 3] {
        [self.size.0, self.size.1, self.samples]
    }
}
