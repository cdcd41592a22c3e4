//! How values lie: densely in an invocation's words, and with WGSL's padding in buffers.
//!
//! In: naga's types. Out: sizes and offsets in words. A type of another width than 32 or 64 bits, or one that is no value,
//! is an error in words.

use naga::{ArraySize, Handle, Module, Scalar, ScalarKind, Type, TypeInner, VectorSize};

/// Sizes of types of one module.
#[derive(Clone, Copy)]
pub(crate) struct Shapes<'m> {
    module: &'m Module,
}

/// The parts of a value that an index chooses among.
pub(crate) struct Parts {
    /// How many; `None`: as many as the buffer holds.
    pub(crate) count: Option<u32>,
    /// Words from one to the next, densely and in a buffer.
    pub(crate) stride: Stride,
}

/// A distance in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stride {
    pub(crate) dense: u32,
    pub(crate) buffer: u32,
}

impl<'m> Shapes<'m> {
    pub(crate) fn new(module: &'m Module) -> Self {
        Shapes { module }
    }

    pub(crate) fn inner(&self, kind: Handle<Type>) -> &'m TypeInner {
        &self.module.types[kind].inner
    }

    /// Words of a number.
    pub(crate) fn scalar(scalar: Scalar) -> Result<u32, String> {
        match (scalar.kind, scalar.width) {
            (ScalarKind::Bool, _) | (ScalarKind::Sint | ScalarKind::Uint | ScalarKind::Float, 4) => Ok(1),
            (ScalarKind::Sint | ScalarKind::Uint, 8) => Ok(2),
            (kind, width) => Err(format!("a number of kind {kind:?} and {} bits", 8 * width)),
        }
    }

    /// Words of a value, packed densely.
    pub(crate) fn dense(&self, inner: &TypeInner) -> Result<u32, String> {
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Self::scalar(*scalar),
            TypeInner::Vector { size, scalar } => Ok(count(*size) * Self::scalar(*scalar)?),
            TypeInner::Matrix { columns, rows, scalar } => Ok(count(*columns) * count(*rows) * Self::scalar(*scalar)?),
            TypeInner::Array { base, size: ArraySize::Constant(length), .. } => {
                Ok(length.get() * self.dense(self.inner(*base))?)
            }
            TypeInner::Struct { members, .. } => {
                members.iter().try_fold(0, |sum, member| Ok(sum + self.dense(self.inner(member.ty))?))
            }
            other => Err(format!("a value of the type {}", name(other))),
        }
    }

    /// The parts of a vector, matrix or array.
    pub(crate) fn parts(&self, inner: &TypeInner) -> Result<Parts, String> {
        match inner {
            TypeInner::Vector { size, scalar } => {
                let words = Self::scalar(*scalar)?;
                Ok(Parts { count: Some(count(*size)), stride: Stride { dense: words, buffer: words } })
            }
            TypeInner::Matrix { columns, rows, scalar } => {
                let stride = Stride { dense: count(*rows) * Self::scalar(*scalar)?, buffer: column_stride(*rows) };
                Ok(Parts { count: Some(count(*columns)), stride })
            }
            TypeInner::Array { base, size, stride } => {
                let count = match size {
                    ArraySize::Constant(length) => Some(length.get()),
                    ArraySize::Dynamic => None,
                    ArraySize::Pending(_) => return Err("an array whose length is an override".to_owned()),
                };
                let dense = self.dense(self.inner(*base)).unwrap_or(0);
                Ok(Parts { count, stride: Stride { dense, buffer: stride / 4 } })
            }
            other => Err(format!("an index into {}", name(other))),
        }
    }

    /// Where the part of this number begins.
    pub(crate) fn part(&self, inner: &TypeInner, number: u32) -> Result<Stride, String> {
        if let TypeInner::Struct { members, .. } = inner {
            let before = members.iter().take(number as usize);
            let dense =
                before.clone().try_fold(0, |sum, member| Ok::<_, String>(sum + self.dense(self.inner(member.ty))?))?;
            let member = members.get(number as usize).ok_or("a member that is not there")?;
            return Ok(Stride { dense, buffer: member.offset / 4 });
        }
        let stride = self.parts(inner)?.stride;
        Ok(Stride { dense: number * stride.dense, buffer: number * stride.buffer })
    }

    /// The type of a part.
    pub(crate) fn part_type(&self, inner: &TypeInner, number: u32) -> Result<TypeInner, String> {
        match inner {
            TypeInner::Vector { scalar, .. } => Ok(TypeInner::Scalar(*scalar)),
            TypeInner::Matrix { rows, scalar, .. } => Ok(TypeInner::Vector { size: *rows, scalar: *scalar }),
            TypeInner::Array { base, .. } => Ok(self.inner(*base).clone()),
            TypeInner::Struct { members, .. } => {
                let member = members.get(number as usize).ok_or("a member that is not there")?;
                Ok(self.inner(member.ty).clone())
            }
            other => Err(format!("a part of {}", name(other))),
        }
    }

    /// The single numbers of a value: where each lies in a buffer and its words, in dense order.
    pub(crate) fn numbers(&self, inner: &TypeInner, offset: u32, out: &mut Vec<(u32, u32)>) -> Result<(), String> {
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => out.push((offset, Self::scalar(*scalar)?)),
            TypeInner::Struct { members, .. } => {
                for member in members {
                    self.numbers(self.inner(member.ty), offset + member.offset / 4, out)?;
                }
            }
            _ => {
                let parts = self.parts(inner)?;
                let length = parts.count.ok_or("a value of a length that only the buffer knows")?;
                let part = self.part_type(inner, 0)?;
                for number in 0..length {
                    self.numbers(&part, offset + number * parts.stride.buffer, out)?;
                }
            }
        }
        Ok(())
    }

    /// What a pointer points to.
    pub(crate) fn pointee(&self, pointer: &TypeInner) -> Result<TypeInner, String> {
        match pointer {
            TypeInner::Pointer { base, .. } => Ok(self.inner(*base).clone()),
            TypeInner::ValuePointer { size: Some(size), scalar, .. } => {
                Ok(TypeInner::Vector { size: *size, scalar: *scalar })
            }
            TypeInner::ValuePointer { size: None, scalar, .. } => Ok(TypeInner::Scalar(*scalar)),
            other => Err(format!("a pointer that is {}", name(other))),
        }
    }
}

/// Components of a vector.
pub(crate) fn count(size: VectorSize) -> u32 {
    size as u32
}

/// Words from one column of a matrix to the next in a buffer.
fn column_stride(rows: VectorSize) -> u32 {
    if rows == VectorSize::Bi { 2 } else { 4 }
}

/// The number's kind and width of a number, vector or matrix.
pub(crate) fn number(inner: &TypeInner) -> Option<Scalar> {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Some(*scalar),
        TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => Some(*scalar),
        _ => None,
    }
}

pub(crate) fn is_pointer(inner: &TypeInner) -> bool {
    matches!(inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
}

fn name(inner: &TypeInner) -> &'static str {
    match inner {
        TypeInner::Image { .. } => "texture",
        TypeInner::Sampler { .. } => "sampler",
        TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => "pointer",
        TypeInner::Array { .. } => "array of unknown length",
        TypeInner::AccelerationStructure { .. } | TypeInner::RayQuery { .. } => "ray query",
        TypeInner::CooperativeMatrix { .. } => "cooperative matrix",
        TypeInner::BindingArray { .. } => "binding array",
        _ => "this kind",
    }
}
