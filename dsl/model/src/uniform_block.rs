//! Where the description's own uniforms lie in their block: WGSL's layout of a uniform struct (WGSL §14.4.1), over the
//! six types that a uniform may have. std140 gives the same offsets.
//!
//! In: the uniforms in the user's order. Out: offsets and size. Nothing here holds values.

use crate::{Uniform, UniformType};

/// Offsets and size of a block of uniforms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UniformBlock {
    /// Of each uniform, in bytes, in the user's order.
    pub offsets: Vec<u32>,
    /// Of the whole block, in bytes: a multiple of 16; 0 where there are no uniforms.
    pub size: u32,
}

impl UniformBlock {
    /// The block of these uniforms.
    pub fn of(uniforms: &[Uniform]) -> Self {
        let mut end = 0;
        let mut offsets = Vec::with_capacity(uniforms.len());
        for uniform in uniforms {
            let offset = u32::next_multiple_of(end, uniform.kind.value.alignment());
            offsets.push(offset);
            end = offset + uniform.kind.value.size();
        }
        UniformBlock { offsets, size: end.next_multiple_of(16) }
    }
}

impl UniformType {
    /// Bytes in a block.
    pub fn size(self) -> u32 {
        match self {
            UniformType::F32 | UniformType::U32 | UniformType::I32 => 4,
            UniformType::Vec2 => 8,
            UniformType::Vec3 => 12,
            UniformType::Vec4 => 16,
        }
    }

    /// Its offset is a multiple of this.
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
    use crate::{Origin, Spanned, Uniform, UniformType};

    fn block(kinds: &[UniformType]) -> UniformBlock {
        let origin = Origin::new("test", 1, 1);
        let uniform = |kind: &UniformType| Uniform {
            name: Spanned::new("any".to_owned(), origin.clone()),
            kind: Spanned::new(*kind, origin.clone()),
        };
        UniformBlock::of(&kinds.iter().map(uniform).collect::<Vec<_>>())
    }

    /// The offsets of WGSL's own example of a struct (§14.4.1), as far as our types go, and blocks around a `vec3`.
    #[test]
    fn offsets_are_wgsls() {
        use UniformType::{F32, U32, Vec2, Vec3, Vec4};
        assert_eq!(block(&[F32, F32, Vec2, Vec3, F32]), UniformBlock { offsets: vec![0, 4, 8, 16, 28], size: 32 });
        assert_eq!(block(&[U32, Vec3, Vec4, F32]), UniformBlock { offsets: vec![0, 16, 32, 48], size: 64 });
        assert_eq!(block(&[F32, Vec2]), UniformBlock { offsets: vec![0, 8], size: 16 });
        assert_eq!(block(&[]), UniformBlock { offsets: vec![], size: 0 });
    }
}
