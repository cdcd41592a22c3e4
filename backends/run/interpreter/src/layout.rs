//! The layouts of values in words: dense in an invocation, with WGSL's padding in buffers.
//!
//! Types of other widths than 32 or 64 bits, and types without values, are errors.

use naga::{ArraySize, Handle, Module, Scalar, ScalarKind, Type, TypeInner, VectorSize};

/// The most words of a value in an invocation.
const MOST_WORDS: u32 = 1 << 20;

/// The layouts of the types of one module.
#[derive(Clone, Copy)]
pub(crate) struct Layouts<'m> {
    module: &'m Module,
}

/// The layout of the elements of a vector, matrix or array.
pub(crate) struct Elements {
    /// Their number; `None`: the length of the buffer determines it.
    pub(crate) count: Option<u32>,
    /// The distance between two elements.
    pub(crate) stride: Distance,
}

/// A distance in words, in each of the two layouts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Distance {
    pub(crate) dense: u32,
    pub(crate) buffer: u32,
}

impl<'m> Layouts<'m> {
    pub(crate) fn new(module: &'m Module) -> Self {
        Layouts { module }
    }

    pub(crate) fn inner(&self, kind: Handle<Type>) -> &'m TypeInner {
        &self.module.types[kind].inner
    }

    /// Returns the width of a scalar in words.
    pub(crate) fn scalar_words(scalar: Scalar) -> Result<u32, String> {
        match (scalar.kind, scalar.width) {
            (ScalarKind::Bool, _) | (ScalarKind::Sint | ScalarKind::Uint | ScalarKind::Float, 4) => Ok(1),
            (ScalarKind::Sint | ScalarKind::Uint, 8) => Ok(2),
            (kind, width) => Err(format!("a number of kind {kind:?} and {} bits", 8 * width)),
        }
    }

    /// Returns the size of a densely packed value in words.
    pub(crate) fn dense(&self, inner: &TypeInner) -> Result<u32, String> {
        let words = self.unlimited(inner)?;
        u32::try_from(words).ok().filter(|words| *words <= MOST_WORDS).ok_or(format!("a value of {words} words"))
    }

    fn unlimited(&self, inner: &TypeInner) -> Result<u64, String> {
        let count = |size: VectorSize| u64::from(count(size));
        let scalar_words = |scalar: Scalar| Self::scalar_words(scalar).map(u64::from);
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => scalar_words(*scalar),
            TypeInner::Vector { size, scalar } => Ok(count(*size) * scalar_words(*scalar)?),
            TypeInner::Matrix { columns, rows, scalar } => Ok(count(*columns) * count(*rows) * scalar_words(*scalar)?),
            TypeInner::Array { base, size: ArraySize::Constant(length), .. } => {
                Ok(u64::from(length.get()).saturating_mul(self.unlimited(self.inner(*base))?))
            }
            TypeInner::Struct { members, .. } => members.iter().try_fold(0u64, |sum, member| {
                Ok::<_, String>(sum.saturating_add(self.unlimited(self.inner(member.ty))?))
            }),
            other => Err(format!("a value of the type {}", type_name(other))),
        }
    }

    /// Returns the elements of a vector, matrix or array.
    pub(crate) fn elements(&self, inner: &TypeInner) -> Result<Elements, String> {
        match inner {
            TypeInner::Vector { size, scalar } => {
                let words = Self::scalar_words(*scalar)?;
                Ok(Elements { count: Some(count(*size)), stride: Distance { dense: words, buffer: words } })
            }
            TypeInner::Matrix { columns, rows, scalar } => {
                let stride =
                    Distance { dense: count(*rows) * Self::scalar_words(*scalar)?, buffer: column_stride(*rows) };
                Ok(Elements { count: Some(count(*columns)), stride })
            }
            TypeInner::Array { base, size, stride } => {
                let count = match size {
                    ArraySize::Constant(length) => Some(length.get()),
                    ArraySize::Dynamic => None,
                    ArraySize::Pending(_) => return Err("an array whose length is an override".to_owned()),
                };
                let dense = self.dense(self.inner(*base)).unwrap_or(0);
                Ok(Elements { count, stride: Distance { dense, buffer: stride / 4 } })
            }
            other => Err(format!("an index into {}", type_name(other))),
        }
    }

    /// Returns the offset of an element or a member.
    pub(crate) fn element_offset(&self, inner: &TypeInner, number: u32) -> Result<Distance, String> {
        if let TypeInner::Struct { members, .. } = inner {
            let before = members.iter().take(number as usize);
            let dense =
                before.clone().try_fold(0, |sum, member| Ok::<_, String>(sum + self.dense(self.inner(member.ty))?))?;
            let member = members.get(number as usize).ok_or("a member that does not exist")?;
            return Ok(Distance { dense, buffer: member.offset / 4 });
        }
        let stride = self.elements(inner)?.stride;
        Ok(Distance { dense: number * stride.dense, buffer: number * stride.buffer })
    }

    /// Returns the type of an element or a member.
    pub(crate) fn element_type(&self, inner: &TypeInner, number: u32) -> Result<TypeInner, String> {
        match inner {
            TypeInner::Vector { scalar, .. } => Ok(TypeInner::Scalar(*scalar)),
            TypeInner::Matrix { rows, scalar, .. } => Ok(TypeInner::Vector { size: *rows, scalar: *scalar }),
            TypeInner::Array { base, .. } => Ok(self.inner(*base).clone()),
            TypeInner::Struct { members, .. } => {
                let member = members.get(number as usize).ok_or("a member that does not exist")?;
                Ok(self.inner(member.ty).clone())
            }
            other => Err(format!("an element of {}", type_name(other))),
        }
    }

    /// Appends the scalars of a value in dense order: their offsets in a buffer and their widths.
    pub(crate) fn scalars(&self, inner: &TypeInner, offset: u32, out: &mut Vec<(u32, u32)>) -> Result<(), String> {
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => out.push((offset, Self::scalar_words(*scalar)?)),
            TypeInner::Struct { members, .. } => {
                for member in members {
                    self.scalars(self.inner(member.ty), offset + member.offset / 4, out)?;
                }
            }
            _ => {
                let parts = self.elements(inner)?;
                let length = parts.count.ok_or("a value with a runtime-sized array")?;
                let part = self.element_type(inner, 0)?;
                for number in 0..length {
                    self.scalars(&part, offset + number * parts.stride.buffer, out)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the type that a pointer points to.
    pub(crate) fn pointee(&self, pointer: &TypeInner) -> Result<TypeInner, String> {
        match pointer {
            TypeInner::Pointer { base, .. } => Ok(self.inner(*base).clone()),
            TypeInner::ValuePointer { size: Some(size), scalar, .. } => {
                Ok(TypeInner::Vector { size: *size, scalar: *scalar })
            }
            TypeInner::ValuePointer { size: None, scalar, .. } => Ok(TypeInner::Scalar(*scalar)),
            other => Err(format!("a pointer that is {}", type_name(other))),
        }
    }
}

/// Returns the number of components of a vector.
pub(crate) fn count(size: VectorSize) -> u32 {
    size as u32
}

/// Returns the distance between two columns of a matrix in a buffer.
fn column_stride(rows: VectorSize) -> u32 {
    if rows == VectorSize::Bi { 2 } else { 4 }
}

/// Returns the scalar type of a scalar, vector or matrix.
pub(crate) fn scalar_of(inner: &TypeInner) -> Option<Scalar> {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Some(*scalar),
        TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => Some(*scalar),
        _ => None,
    }
}

pub(crate) fn is_pointer(inner: &TypeInner) -> bool {
    matches!(inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
}

fn type_name(inner: &TypeInner) -> &'static str {
    match inner {
        TypeInner::Image { .. } => "texture",
        TypeInner::Sampler { .. } => "sampler",
        TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => "pointer",
        TypeInner::Array { .. } => "runtime-sized array",
        TypeInner::AccelerationStructure { .. } | TypeInner::RayQuery { .. } => "ray query",
        TypeInner::CooperativeMatrix { .. } => "cooperative matrix",
        TypeInner::BindingArray { .. } => "binding array",
        _ => "this kind",
    }
}
