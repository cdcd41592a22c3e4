//! The fixed function around a shader: stencil test, depth test and blending, sample by sample.
//!
//! The stencil test precedes the depth test, as in the graphics APIs. A fragment that fails only the depth test leaves the
//! stencil unchanged: the vocabulary has no operation for that case.

#[cfg(test)]
mod tests;

use std::sync::atomic::Ordering;

use fragbuf_templates::vocabulary::{Blend, Compare, StencilOperation, TextureFormat};

use crate::attachment::{Attachments, DepthAttachment, StencilAttachment};
use crate::texel::DEPTH_24;

impl Attachments<'_> {
    /// Tests a sample and updates depth and stencil; returns whether it passes.
    pub(crate) fn test(&self, index: usize, depth: f32) -> bool {
        if let Some(stencil) = &self.stencil
            && !stencil.passes(index)
        {
            stencil.apply(stencil.fail, index);
            return false;
        }
        if let Some(tested) = &self.depth {
            if !tested.passes(index, depth) {
                return false;
            }
            if tested.writes {
                tested.write(index, depth);
            }
        }
        if let Some(stencil) = &self.stencil {
            stencil.apply(stencil.pass, index);
        }
        true
    }

    /// Blends a colour, the words of a fragment output, into a sample of a colour attachment.
    pub(crate) fn blend(&self, target: usize, index: usize, color: [u32; 4]) {
        let Some(target) = self.targets.get(target) else { return };
        if target.texel.is_integer() {
            return target.store(index, target.texel.encode_integer(color));
        }
        let new = color.map(f32::from_bits);
        let old = if target.blend == Blend::Replace { [0.0; 4] } else { target.texel.decode(target.load(index)) };
        target.store(index, target.texel.encode(blended(target.blend, new, old)));
    }
}

fn blended(blend: Blend, new: [f32; 4], old: [f32; 4]) -> [f32; 4] {
    let each = |mix: &dyn Fn(f32, f32) -> f32| std::array::from_fn(|channel| mix(new[channel], old[channel]));
    match blend {
        Blend::Replace => new,
        Blend::Over => each(&|new_channel, old_channel| new_channel + (1.0 - new[3]) * old_channel),
        Blend::Under => each(&|new_channel, old_channel| old_channel + (1.0 - old[3]) * new_channel),
        Blend::Max => each(&f32::max),
        Blend::Min => each(&f32::min),
        Blend::Add => each(&|new_channel, old_channel| new_channel + old_channel),
    }
}

impl DepthAttachment<'_> {
    fn passes(&self, index: usize, depth: f32) -> bool {
        let word = self.words[index].load(Ordering::Relaxed);
        match self.format {
            TextureFormat::Depth24PlusStencil8 => compared(self.compare, depth_24(depth), word >> 8),
            _ => compared(self.compare, depth, f32::from_bits(word)),
        }
    }

    fn write(&self, index: usize, depth: f32) {
        let word = match self.format {
            TextureFormat::Depth24PlusStencil8 => {
                depth_24(depth) << 8 | (self.words[index].load(Ordering::Relaxed) & 0xff)
            }
            _ => depth.to_bits(),
        };
        self.words[index].store(word, Ordering::Relaxed);
    }
}

fn depth_24(depth: f32) -> u32 {
    (f64::from(depth.clamp(0.0, 1.0)) * DEPTH_24).round_ties_even() as u32
}

impl StencilAttachment<'_> {
    fn passes(&self, index: usize) -> bool {
        compared(self.compare, self.reference, self.words[index].load(Ordering::Relaxed) & 0xff)
    }

    fn apply(&self, operation: StencilOperation, index: usize) {
        let word = self.words[index].load(Ordering::Relaxed);
        let value = match operation {
            StencilOperation::Keep => return,
            StencilOperation::Replace => self.reference,
            StencilOperation::DecrementClamp => (word & 0xff).saturating_sub(1),
        };
        self.words[index].store((word & !0xff) | value, Ordering::Relaxed);
    }
}

/// Compares the new value with the stored one.
fn compared<T: PartialOrd>(compare: Compare, new: T, stored: T) -> bool {
    match compare {
        Compare::Always => true,
        Compare::Less => new < stored,
        Compare::LessEqual => new <= stored,
        Compare::Equal => new == stored,
        Compare::Greater => new > stored,
        Compare::GreaterEqual => new >= stored,
    }
}
