//! The attachments of a pass: colour, depth and stencil, each a list of words by sample and pixel.
//!
//! The constructor checks the sizes and formats of the resources.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_frame::{Error, unsupported};
use fragbuf_templates::vocabulary::{Blend, Compare, DepthState, Element, Pass, StencilOperation, TextureFormat};

use crate::memory::Slice;
use crate::texel::Texel;

/// The attachments of a pass.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attachments<'a> {
    pub(crate) targets: Vec<ColorAttachment<'a>>,
    pub(crate) depth: Option<DepthAttachment<'a>>,
    pub(crate) stencil: Option<StencilAttachment<'a>>,
    /// The number of pixels of the frame.
    pub(crate) pixels: usize,
    /// The samples per pixel.
    pub(crate) samples: u32,
    /// The mask of samples that are written.
    pub(crate) mask: u32,
    /// Whether depth and stencil are tested before the shader (forced early tests).
    pub(crate) is_early: bool,
}

/// A colour attachment and its blending.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColorAttachment<'a> {
    pub(crate) words: &'a [AtomicU32],
    pub(crate) texel: Texel,
    pub(crate) blend: Blend,
    /// The pixel of the first texel: the output has the rows of a slice, a texture those of the frame.
    pub(crate) first: usize,
}

/// A depth attachment and its test.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthAttachment<'a> {
    pub(crate) words: &'a [AtomicU32],
    pub(crate) format: TextureFormat,
    pub(crate) compare: Compare,
    pub(crate) writes: bool,
}

/// A stencil attachment and its test.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StencilAttachment<'a> {
    pub(crate) words: &'a [AtomicU32],
    pub(crate) compare: Compare,
    pub(crate) fail: StencilOperation,
    pub(crate) pass: StencilOperation,
    pub(crate) reference: u32,
}

/// A function from the name of a texture to its words and format.
pub(crate) type Textures<'f, 'a> = &'f dyn Fn(&str) -> Option<(&'a [AtomicU32], Element)>;

/// The name of the caller's output in the vocabulary.
pub(crate) const OUTPUT: &str = "output";

impl<'a> Attachments<'a> {
    /// Returns the attachments of `pass`, given the sample count, the sample mask and the stencil reference.
    pub(crate) fn of(
        pass: &Pass,
        [samples, mask, reference]: [u32; 3],
        textures: Textures<'_, 'a>,
        (output, slice): (&'a [AtomicU32], &Slice),
    ) -> Result<Self, Error> {
        let pixels = slice.size.0 as usize * slice.size.1 as usize;
        if ![1, 2, 4, 8].contains(&samples) {
            return Err(unsupported(format!("{samples} samples per pixel")));
        }
        let texture = |name: &str| {
            let (words, element) = textures(name).ok_or_else(|| unsupported(format!("the attachment `{name}`")))?;
            let Element::Texture(format) = element else {
                return Err(unsupported(format!("`{name}`, which is not a texture, as an attachment")));
            };
            if words.len() < pixels * samples as usize * format.words() as usize {
                return Err(unsupported(format!("`{name}` with {samples} samples, which has fewer")));
            }
            Ok((words, format))
        };
        let target = |target: &fragbuf_templates::vocabulary::ColorTarget| {
            let (words, texel, first) = match target.resource.as_str() {
                OUTPUT if samples > 1 => return Err(unsupported("a multisampled output".to_owned())),
                OUTPUT => (output, Texel::Output, slice.first_pixel()),
                name => {
                    let (words, format) = texture(name)?;
                    (words, Texel::Format(format), 0)
                }
            };
            if texel.is_integer() && target.blend != Blend::Replace {
                return Err(unsupported(format!("blending of integers in `{}`", target.resource)));
            }
            Ok(ColorAttachment { words, texel, blend: target.blend, first })
        };
        let depth = |state: &DepthState| {
            let (words, format) = texture(&state.resource)?;
            Ok(DepthAttachment { words, format, compare: state.compare, writes: state.write })
        };
        let stencil = |state: &fragbuf_templates::vocabulary::StencilState| match texture(&state.resource)? {
            (words, TextureFormat::Depth24PlusStencil8) => {
                let reference = reference & 0xff;
                Ok(StencilAttachment { words, compare: state.compare, fail: state.fail, pass: state.pass, reference })
            }
            _ => Err(unsupported(format!("`{}` as a stencil attachment, which has no stencil", state.resource))),
        };
        Ok(Attachments {
            targets: pass.state.targets.iter().map(target).collect::<Result<_, _>>()?,
            depth: pass.state.depth.as_ref().map(depth).transpose()?,
            stencil: pass.state.stencil.as_ref().map(stencil).transpose()?,
            pixels,
            samples,
            mask,
            is_early: pass.state.depth.as_ref().is_some_and(|depth| depth.early),
        })
    }
}

impl ColorAttachment<'_> {
    /// Returns the words of the texel `index`.
    pub(crate) fn load(&self, index: usize) -> [u32; 4] {
        self.texel.load(self.words, index.saturating_sub(self.first))
    }

    pub(crate) fn store(&self, index: usize, texel: [u32; 4]) {
        let (words, index) = (self.texel.words(), index.saturating_sub(self.first));
        let Some(stored) = index.checked_mul(words).and_then(|at| self.words.get(at..)) else { return };
        for (stored, word) in stored.iter().zip(texel).take(words) {
            stored.store(word, Ordering::Relaxed);
        }
    }
}
