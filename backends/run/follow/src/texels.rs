//! Textures of a description: of any size, with four floats per texel.
//!
//! Input: a plan, and what a caller gives for a texture. Output: the resource, or what is wrong.

use crate::Error;
use crate::manifest::{Plan, Resource, ViewDimension};

/// What a caller gives for a texture of a description.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'a> {
    /// Columns, rows and slices; 1 slice for a texture of two dimensions.
    pub size: [u32; 3],
    /// Row after row, slice after slice.
    pub values: &'a [[f32; 4]],
}

/// The most texels along a side.
pub const MOST_TEXELS: u32 = 16_384;

impl Texels<'_> {
    /// Returns the resource of the texture that the description calls `name`, and its dimension, if it can have these texels. `most`: what the
    /// device allows along a side, of textures of two and of three dimensions.
    pub fn resource<'p>(
        &self,
        plan: &'p Plan,
        name: &str,
        most: [u32; 2],
    ) -> Result<(&'p Resource, ViewDimension), Error> {
        let textures = || plan.resources.iter().filter_map(|resource| Some((resource, resource.described()?)));
        let Some((resource, (_, dimension))) = textures().find(|(_, (known, _))| *known == name) else {
            let known: Vec<String> = textures().map(|(_, (known, _))| format!("`{known}`")).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            return Err(Error(format!("no texture `{name}`: the description has {known}")));
        };
        let [width, height, slices] = self.size;
        let most = match dimension {
            ViewDimension::D2 => most[0],
            ViewDimension::D3 => most[1],
        };
        let most = most.min(MOST_TEXELS);
        if self.size.iter().any(|side| !(1..=most).contains(side)) {
            return Err(Error(format!(
                "the texture `{name}` has {width} x {height} x {slices} texels: from 1 to {most} along each side are possible"
            )));
        }
        if dimension == ViewDimension::D2 && slices != 1 {
            return Err(Error(format!("the texture `{name}` has two dimensions, not {slices} slices")));
        }
        let wanted = self.size.iter().map(|side| u64::from(*side)).product::<u64>();
        if self.values.len() as u64 != wanted {
            return Err(Error(format!("the texture `{name}` needs {wanted} texels, not {}", self.values.len())));
        }
        Ok((resource, dimension))
    }

    /// Returns the bytes of all texels.
    pub fn bytes(&self) -> Vec<u8> {
        self.values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect()
    }
}
