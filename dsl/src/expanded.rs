//! What code expanded from [`fragment_buffer!`](crate::fragment_buffer) needs at run time: the list that a resolve closure
//! sees, and the bytes of uniforms.
//!
//! In: slices and values of Rust's and glam's types. Out: the same with the meaning that the language gives them.

use std::iter::Copied;
use std::ops::Index;
use std::slice::Iter;

use glam::{Vec2, Vec3, Vec4};

/// The kept fragments as a closure sees them: a list that is read as often as it takes and gives values, not references.
#[derive(Debug)]
pub struct Fragments<'a, F>(&'a [F]);

impl<'a, F: Copy> Fragments<'a, F> {
    /// These fragments, in this order.
    pub fn new(fragments: &'a [F]) -> Self {
        Fragments(fragments)
    }

    /// How many there are.
    pub fn len(self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(self) -> bool {
        self.0.is_empty()
    }

    /// One after the other.
    pub fn iter(self) -> Copied<Iter<'a, F>> {
        self.0.iter().copied()
    }
}

impl<F> Clone for Fragments<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Fragments<'_, F> {}

impl<'a, F: Copy> IntoIterator for Fragments<'a, F> {
    type Item = F;
    type IntoIter = Copied<Iter<'a, F>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<F> Index<usize> for Fragments<'_, F> {
    type Output = F;

    fn index(&self, index: usize) -> &F {
        &self.0[index]
    }
}

/// A value of a uniform block.
pub trait UniformValue {
    /// Writes the value as it lies in memory into its bytes, as many as its type has.
    fn write(self, bytes: &mut [u8]);
}

macro_rules! written {
    ($($kind:ty: |$value:ident| $components:expr;)*) => {
        $(impl UniformValue for $kind {
            fn write(self, bytes: &mut [u8]) {
                let $value = self;
                for (bytes, component) in bytes.chunks_exact_mut(4).zip($components) {
                    bytes.copy_from_slice(&component.to_ne_bytes());
                }
            }
        })*
    };
}

written! {
    f32: |value| [value];
    u32: |value| [value];
    i32: |value| [value];
    Vec2: |value| value.to_array();
    Vec3: |value| value.to_array();
    Vec4: |value| value.to_array();
}
