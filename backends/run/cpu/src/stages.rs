//! The fragment stage of a draw: one fragment, from its inputs to its outputs.
//!
//! In: a triangle, the weights at a sample. Out: how the shader ended, and its results. A stage belongs to one thread and is
//! used for one fragment after the other.

use fragbuf_interpreter::{Machine, Program};

use crate::interface::{Feed, Source};
use crate::triangle::{Triangle, Weights};

/// What all fragments of a draw share.
#[derive(Clone, Copy)]
pub(crate) struct FragmentStage<'a> {
    pub(crate) program: &'a Program,
    pub(crate) feeds: &'a [Feed],
    /// Words of all vertices.
    pub(crate) vertices: &'a [u32],
}

/// Where a fragment is and what it is of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// The pixel.
    pub(crate) x: u32,
    pub(crate) y: u32,
    pub(crate) weights: Weights,
    /// Covered samples.
    pub(crate) mask: u32,
    /// The sample that it runs for; 0 where it runs for all.
    pub(crate) sample: u32,
}

impl<'a> FragmentStage<'a> {
    /// A machine for the stage's fragments.
    pub(crate) fn machine(&self) -> Machine<'a> {
        Machine::new(self.program)
    }

    /// Brings a machine to the beginning of a fragment.
    #[inline]
    pub(crate) fn begin(&self, machine: &mut Machine<'_>, triangle: &Triangle, place: &Place) {
        machine.restart();
        for feed in self.feeds {
            let to = machine.words_mut(feed.to.clone());
            match feed.from {
                Source::Position => {
                    let (x, y) = (place.x as f32 + 0.5, place.y as f32 + 0.5);
                    let position = [x, y, place.weights.depth, place.weights.inverse_w];
                    to.iter_mut().zip(position).for_each(|(word, value)| *word = value.to_bits());
                }
                Source::FrontFacing => to[0] = triangle.is_front.into(),
                Source::PrimitiveIndex => to[0] = triangle.primitive,
                Source::SampleIndex => to[0] = place.sample,
                Source::SampleMask => to[0] = place.mask,
                Source::Flat(first) => {
                    let from = triangle.provoking as usize + first;
                    to.copy_from_slice(&self.vertices[from..from + to.len()]);
                }
                Source::Perspective(first) => self.mix(to, triangle, first, place.weights.perspective),
                Source::Linear(first) => {
                    self.mix(to, triangle, first, place.weights.linear.map(|weight| weight as f32));
                }
            }
        }
    }

    /// Exact where the corners are equal.
    fn mix(&self, to: &mut [u32], triangle: &Triangle, first: usize, weights: [f32; 2]) {
        let [a, b, c] = triangle.vertices.map(|vertex| &self.vertices[vertex as usize + first..][..to.len()]);
        for (word, ((a, b), c)) in to.iter_mut().zip(a.iter().zip(b).zip(c)) {
            let [a, b, c] = [a, b, c].map(|word| f32::from_bits(*word));
            *word = (a + weights[0] * (b - a) + weights[1] * (c - a)).to_bits();
        }
    }
}
