//! Textures as shaders read them: what an earlier pass has drawn, texel by texel and sample by sample.
//!
//! In: the words of a resource, its format, what the shader declares. Out: four numbers of a texel. Nothing is filtered, and
//! nothing is written.

use std::sync::atomic::AtomicU32;

use fragbuf_frame::{Error, unsupported};
use fragbuf_interpreter::Texture;
use fragbuf_templates::vocabulary::{Element, TextureFormat};
use naga::ScalarKind;

use crate::texel::Texel;

/// A texture, bound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampled<'a> {
    words: &'a [AtomicU32],
    format: TextureFormat,
    /// Whether whole numbers are read: of depth with stencil, the stencil.
    is_whole: bool,
    size: (u32, u32),
    samples: u32,
}

impl<'a> Sampled<'a> {
    /// What a shader calls `texture`. `Err`: the resource is no such texture.
    pub(crate) fn of(
        texture: &Texture,
        words: &'a [AtomicU32],
        element: Element,
        size: (u32, u32),
    ) -> Result<Self, Error> {
        let refuse = |what: &str| Err(unsupported(format!("the texture `{}`: {what}", texture.name)));
        let Element::Texture(format) = element else { return refuse("the plan has a buffer there") };
        let pixels = size.0 as usize * size.1 as usize;
        let samples = (words.len() / (pixels * format.words() as usize).max(1)) as u32;
        if samples == 0 || (samples > 1) != texture.is_multisampled {
            return refuse(&format!("it is declared with another number of samples than the plan's {samples}"));
        }
        let is_whole = texture.kind != ScalarKind::Float;
        let fits = match format {
            TextureFormat::R32Uint | TextureFormat::Rg16Uint => texture.kind == ScalarKind::Uint && !texture.is_depth,
            TextureFormat::Depth24PlusStencil8 => texture.kind != ScalarKind::Sint,
            TextureFormat::Depth32Float => !is_whole,
            _ => !is_whole && !texture.is_depth,
        };
        if !fits {
            return refuse(&format!("it is declared otherwise than {format:?}"));
        }
        Ok(Sampled { words, format, is_whole, size, samples })
    }

    /// The texel at a column and a row; the sample, or the level, of which there is one. `None`: there is no such texel.
    pub(crate) fn texel(&self, [x, y, sample]: [u32; 3]) -> Option<[u32; 4]> {
        let (width, height) = self.size;
        if x >= width || y >= height || sample >= self.samples {
            return None;
        }
        let pixels = width as usize * height as usize;
        let index = sample as usize * pixels + y as usize * width as usize + x as usize;
        let texel = Texel::Format(self.format);
        let words = texel.load(self.words, index);
        Some(if self.is_whole { texel.decode_whole(words) } else { texel.decode(words).map(f32::to_bits) })
    }

    /// Columns, rows, samples.
    pub(crate) fn extent(&self) -> [u32; 3] {
        [self.size.0, self.size.1, self.samples]
    }
}
