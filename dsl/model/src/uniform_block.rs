//! The layout of a uniform block: WGSL's layout of a uniform struct (WGSL §14.4.1), for the six types of uniforms. std140
//! gives the same offsets.
//!
//! Input: the types in the order of the block. Output: offsets and size.

use crate::{Uniform, UniformType};

/// Offsets and size of a block of uniforms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UniformBlock {
    /// The byte offset of each uniform, in the order of the block.
    pub offsets: Vec<u32>,
    /// The size in bytes, a multiple of 16; 0 if there are no uniforms.
    pub size: u32,
}

impl UniformBlock {
    /// Lays out the uniforms of a description.
    pub fn of(uniforms: &[Uniform]) -> Self {
        Self::of_types(uniforms.iter().map(|uniform| uniform.kind.value))
    }

    /// Lays out uniforms of these types.
    pub fn of_types(types: impl IntoIterator<Item = UniformType>) -> Self {
        let (mut end, mut offsets) = (0, Vec::new());
        for kind in types {
            let offset = u32::next_multiple_of(end, kind.alignment());
            offsets.push(offset);
            end = offset + kind.size();
        }
        UniformBlock { offsets, size: end.next_multiple_of(16) }
    }
}

impl UniformType {
    /// Returns the size in bytes.
    pub fn size(self) -> u32 {
        match self {
            UniformType::F32 | UniformType::U32 | UniformType::I32 => 4,
            UniformType::Vec2 => 8,
            UniformType::Vec3 => 12,
            UniformType::Vec4 => 16,
        }
    }

    /// Returns the alignment in bytes.
    pub fn alignment(self) -> u32 {
        match self {
            UniformType::F32 | UniformType::U32 | UniformType::I32 => 4,
            UniformType::Vec2 => 8,
            UniformType::Vec3 | UniformType::Vec4 => 16,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::UniformBlock;
    use crate::UniformType;

    fn block(kinds: &[UniformType]) -> UniformBlock {
        UniformBlock::of_types(kinds.iter().copied())
    }

    /// The offsets of WGSL's example of a struct (§14.4.1), without the types that a uniform cannot have, and blocks with a
    /// `vec3`.
    #[test]
    fn offsets_follow_wgsl() {
        use UniformType::{F32, U32, Vec2, Vec3, Vec4};
        assert_eq!(block(&[F32, F32, Vec2, Vec3, F32]), UniformBlock { offsets: vec![0, 4, 8, 16, 28], size: 32 });
        assert_eq!(block(&[U32, Vec3, Vec4, F32]), UniformBlock { offsets: vec![0, 16, 32, 48], size: 64 });
        assert_eq!(block(&[F32, Vec2]), UniformBlock { offsets: vec![0, 8], size: 16 });
        assert_eq!(block(&[]), UniformBlock { offsets: vec![], size: 0 });
    }
}
