//! The textures and images that closures of code expanded from [`fragment_buffer!`](crate::fragment_buffer) read, for programs that call
//! the closures.
//!
//! The methods return what shaders compute: filters are those of the generated code, not of a device.
//!
//! ```
//! use fragbuf_dsl::glam::{Vec4, vec2};
//! use fragbuf_dsl::{Image, Texture2d};
//!
//! fragbuf_dsl::fragment_buffer! {
//!     buffer Toned from kplus_array {
//!         texture { lut: 2d }
//!         uniform { scale: f32 }
//!         fn tone(x: f32, u: Uniforms) -> Vec4 { u.scale * u.lut.sample(vec2(x, 0.5)) }
//!         image near |fragments, u| tone(fragments[0].depth, u);
//!         resolve |fragments, u| u.near.at(1, 0) - u.near.at(-1, 0);
//!     }
//! }
//!
//! let texels = [Vec4::ZERO, Vec4::ONE];
//! let uniforms = toned::Uniforms { scale: 2.0, ..Default::default() };
//! let textures = toned::Textures { lut: Texture2d::new([2, 1], &texels), ..Default::default() };
//! let fragment = toned::Fragment { depth: 0.5, ..Default::default() };
//! // Half-way between the texels.
//! assert_eq!(toned::image_near(&[fragment], &uniforms, &textures), Vec4::ONE);
//!
//! let values = [Vec4::ZERO, Vec4::splat(0.25), Vec4::ONE];
//! let textures = toned::Textures { near: Image::new([3, 1], &values, [1, 0]), ..textures };
//! assert_eq!(toned::resolve(&[fragment], &uniforms, &textures), Vec4::ONE);
//! assert_eq!(textures.lut.sample(vec2(-1.0, 0.5)), Vec4::ZERO);
//! ```

use glam::{Vec2, Vec3, Vec4};

/// A two-dimensional texture: texels row after row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Texture2d<'a> {
    texels: Texels<'a>,
}

/// A three-dimensional texture: texels row after row, slice after slice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Texture3d<'a> {
    texels: Texels<'a>,
}

/// An image of the description, as the closure of one pixel sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Image<'a> {
    texels: Texels<'a>,
    pixel: [u32; 2],
}

impl<'a> Texture2d<'a> {
    /// Wraps texels. Those that are missing are 0.
    pub fn new(size: [u32; 2], texels: &'a [Vec4]) -> Self {
        Texture2d { texels: Texels { size: [size[0], size[1], 1], values: texels } }
    }

    /// Returns a texel; coordinates beyond the border are those of the nearest texel.
    pub fn load(self, x: i32, y: i32) -> Vec4 {
        self.texels.nearest([x, y, 0])
    }

    /// Returns the value at a place from 0 to 1, linear between texels.
    pub fn sample(self, at: Vec2) -> Vec4 {
        self.texels.linear(at.extend(0.5))
    }

    /// Returns the texel at a place from 0 to 1.
    pub fn sample_nearest(self, at: Vec2) -> Vec4 {
        self.texels.texel_at(at.extend(0.5))
    }

    /// Returns the number of columns.
    pub fn width(self) -> u32 {
        self.texels.size[0]
    }

    /// Returns the number of rows.
    pub fn height(self) -> u32 {
        self.texels.size[1]
    }
}

impl<'a> Texture3d<'a> {
    /// Wraps texels. Those that are missing are 0.
    pub fn new(size: [u32; 3], texels: &'a [Vec4]) -> Self {
        Texture3d { texels: Texels { size, values: texels } }
    }

    /// Returns a texel; coordinates beyond the border are those of the nearest texel.
    pub fn load(self, x: i32, y: i32, z: i32) -> Vec4 {
        self.texels.nearest([x, y, z])
    }

    /// Returns the value at a place from 0 to 1, linear between texels.
    pub fn sample(self, at: Vec3) -> Vec4 {
        self.texels.linear(at)
    }

    /// Returns the texel at a place from 0 to 1.
    pub fn sample_nearest(self, at: Vec3) -> Vec4 {
        self.texels.texel_at(at)
    }

    /// Returns the number of columns.
    pub fn width(self) -> u32 {
        self.texels.size[0]
    }

    /// Returns the number of rows.
    pub fn height(self) -> u32 {
        self.texels.size[1]
    }

    /// Returns the number of slices.
    pub fn depth(self) -> u32 {
        self.texels.size[2]
    }
}

impl<'a> Image<'a> {
    /// Wraps the values of all pixels, row after row, for the closure of `pixel`. Values that are missing are 0.
    pub fn new(size: [u32; 2], values: &'a [Vec4], pixel: [u32; 2]) -> Self {
        Image { texels: Texels { size: [size[0], size[1], 1], values }, pixel }
    }

    /// Returns the value of the pixel `dx` to the right and `dy` below; beyond the border, that of the nearest pixel.
    pub fn at(self, dx: i32, dy: i32) -> Vec4 {
        let [x, y] = self.pixel.map(|coordinate| i32::try_from(coordinate).unwrap_or(i32::MAX));
        self.texels.nearest([x.saturating_add(dx), y.saturating_add(dy), 0])
    }

    /// Returns the number of columns.
    pub fn width(self) -> u32 {
        self.texels.size[0]
    }

    /// Returns the number of rows.
    pub fn height(self) -> u32 {
        self.texels.size[1]
    }
}

/// Texels, columns fastest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Texels<'a> {
    size: [u32; 3],
    values: &'a [Vec4],
}

impl Texels<'_> {
    /// Returns the texel that is nearest to these coordinates.
    fn nearest(self, at: [i32; 3]) -> Vec4 {
        let clamped = |axis: usize| {
            let last = i64::from(self.size[axis]) - 1;
            usize::try_from(i64::from(at[axis]).min(last)).unwrap_or(0)
        };
        let (width, height) = (self.size[0] as usize, self.size[1] as usize);
        let row = clamped(2).saturating_mul(height).saturating_add(clamped(1));
        let index = row.saturating_mul(width).saturating_add(clamped(0));
        self.values.get(index).copied().unwrap_or(Vec4::ZERO)
    }

    fn texel_at(self, at: Vec3) -> Vec4 {
        let place = (at * self.extent()).floor();
        self.nearest(place.to_array().map(|coordinate| coordinate as i32))
    }

    fn linear(self, at: Vec3) -> Vec4 {
        let place = at.clamp(Vec3::ZERO, Vec3::ONE) * self.extent() - 0.5;
        let first = place.floor();
        let part = place - first;
        let [x, y, z] = first.to_array().map(|coordinate| coordinate as i32);
        let along_x = |y: i32, z: i32| self.nearest([x, y, z]).lerp(self.nearest([x + 1, y, z]), part.x);
        let along_y = |z: i32| along_x(y, z).lerp(along_x(y + 1, z), part.y);
        along_y(z).lerp(along_y(z + 1), part.z)
    }

    fn extent(self) -> Vec3 {
        Vec3::from_array(self.size.map(|length| length as f32))
    }
}
