//! The runtime types of code expanded from [`fragment_buffer!`](crate::fragment_buffer): the list that a resolve closure
//! reads, and the bytes of uniforms.

use std::iter::Copied;
use std::ops::Index;
use std::slice::Iter;

use glam::{Vec2, Vec3, Vec4};

/// The list of kept fragments that a resolve closure reads. Iteration gives values, not references, and can be repeated.
#[derive(Debug)]
pub struct Fragments<'a, F>(&'a [F]);

impl<'a, F: Copy> Fragments<'a, F> {
    /// Wraps fragments; their order stays.
    pub fn new(fragments: &'a [F]) -> Self {
        Fragments(fragments)
    }

    /// Returns the number of fragments.
    pub fn len(self) -> usize {
        self.0.len()
    }

    /// Whether the list is empty.
    pub fn is_empty(self) -> bool {
        self.0.is_empty()
    }

    /// Iterates over the fragments.
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
    /// Writes the bytes of the value; `bytes` has the size of the type.
    fn write(self, bytes: &mut [u8]);
}

macro_rules! uniform_values {
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

uniform_values! {
    f32: |value| [value];
    u32: |value| [value];
    i32: |value| [value];
    Vec2: |value| value.to_array();
    Vec3: |value| value.to_array();
    Vec4: |value| value.to_array();
}
