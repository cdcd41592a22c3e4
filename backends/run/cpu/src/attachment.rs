//! What a pass is attached to: colour targets, depth and stencil, each a list of words by sample and pixel.
//!
//! In: the state of a pass and the plan's resources. Out: references to words, checked for size. Nothing is drawn here.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_frame::{Error, unsupported};
use fragbuf_templates::vocabulary::{Blend, Compare, DepthState, Element, Pass, StencilOperation, TextureFormat};

use crate::texel::Texel;

/// Everything that a pass is attached to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attachments<'a> {
    pub(crate) targets: Vec<Target<'a>>,
    pub(crate) depth: Option<Depth<'a>>,
    pub(crate) stencil: Option<Stencil<'a>>,
    /// Pixels of the frame.
    pub(crate) pixels: usize,
    /// Samples of a pixel.
    pub(crate) samples: u32,
    /// Samples that may be written.
    pub(crate) mask: u32,
    /// Whether depth and stencil are tested before the shader, whatever it does.
    pub(crate) is_early: bool,
}

/// A colour target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<'a> {
    pub(crate) words: &'a [AtomicU32],
    pub(crate) texel: Texel,
    pub(crate) blend: Blend,
}

/// A depth attachment and its test.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depth<'a> {
    pub(crate) words: &'a [AtomicU32],
    pub(crate) format: TextureFormat,
    pub(crate) compare: Compare,
    pub(crate) writes: bool,
}

/// A stencil attachment and its test.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stencil<'a> {
    pub(crate) words: &'a [AtomicU32],
    pub(crate) compare: Compare,
    pub(crate) fail: StencilOperation,
    pub(crate) pass: StencilOperation,
    pub(crate) reference: u32,
}

/// The words and format of a texture by name.
pub(crate) type Textures<'f, 'a> = &'f dyn Fn(&str) -> Option<(&'a [AtomicU32], Element)>;

/// The vocabulary's name for the caller's own target.
pub(crate) const OUTPUT: &str = "output";

impl<'a> Attachments<'a> {
    /// Those of `pass`. `numbers`: samples, their mask, the stencil's reference.
    pub(crate) fn of(
        pass: &Pass,
        [samples, mask, reference]: [u32; 3],
        textures: Textures<'_, 'a>,
        (output, pixels): (&'a [AtomicU32], usize),
    ) -> Result<Self, Error> {
        if ![1, 2, 4, 8].contains(&samples) {
            return Err(unsupported(format!("{samples} samples per pixel")));
        }
        let found = |name: &str| {
            let (words, element) = textures(name).ok_or_else(|| unsupported(format!("the attachment `{name}`")))?;
            let Element::Texture(format) = element else {
                return Err(unsupported(format!("`{name}`, which is no texture, as an attachment")));
            };
            if words.len() < pixels * samples as usize * format.words() as usize {
                return Err(unsupported(format!("`{name}` with {samples} samples: it has fewer")));
            }
            Ok((words, format))
        };
        let target = |target: &fragbuf_templates::vocabulary::Target| {
            let (words, texel) = match target.resource.as_str() {
                OUTPUT if samples > 1 => return Err(unsupported("several samples of the output".to_owned())),
                OUTPUT => (output, Texel::Output),
                name => {
                    let (words, format) = found(name)?;
                    (words, Texel::Format(format))
                }
            };
            if texel.is_raw() && target.blend != Blend::Replace {
                return Err(unsupported(format!("blending of whole numbers in `{}`", target.resource)));
            }
            Ok(Target { words, texel, blend: target.blend })
        };
        let depth = |state: &DepthState| {
            let (words, format) = found(&state.resource)?;
            Ok(Depth { words, format, compare: state.compare, writes: state.write })
        };
        let stencil = |state: &fragbuf_templates::vocabulary::StencilState| match found(&state.resource)? {
            (words, TextureFormat::Depth24PlusStencil8) => {
                let reference = reference & 0xff;
                Ok(Stencil { words, compare: state.compare, fail: state.fail, pass: state.pass, reference })
            }
            _ => Err(unsupported(format!("`{}` as a stencil: it has none", state.resource))),
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

impl Target<'_> {
    /// The words of the texel `index`.
    pub(crate) fn load(&self, index: usize) -> [u32; 4] {
        self.texel.load(self.words, index)
    }

    pub(crate) fn store(&self, index: usize, texel: [u32; 4]) {
        let words = self.texel.words();
        for (held, word) in self.words.iter().skip(index * words).zip(texel).take(words) {
            held.store(word, Ordering::Relaxed);
        }
    }
}
