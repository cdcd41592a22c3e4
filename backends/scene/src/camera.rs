//! Cameras: one that frames any scene, and one that takes vertices as they stand.

use glam::camera::rh::{proj::directx, view};
use glam::{Mat4, Vec3};

use crate::Scene;

/// From positions to clip space, and where the light of a headlight comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Column by column; y up, z from 0 to 1.
    pub view_projection: [f32; 16],
    /// Where it looks from.
    pub eye: Eye,
}

/// Where a camera looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// A point.
    At([f32; 3]),
    /// So far away that all rays go along this unit vector, from the eye into the scene.
    Along([f32; 3]),
}

/// Half the vertical angle of view.
const HALF_ANGLE: f32 = 20.0 * std::f32::consts::PI / 180.0;

/// From the scene's middle to the eye of [`Camera::framing`]: from the right, above and in front.
const THREE_QUARTER: Vec3 = Vec3::new(0.55, 0.45, 1.0);

impl Camera {
    /// Positions are clip-space positions.
    pub fn clip() -> Self {
        Camera { view_projection: Mat4::IDENTITY.to_cols_array(), eye: Eye::Along([0.0, 0.0, 1.0]) }
    }

    /// Three-quarter view in perspective; the scene's bounding sphere fills the smaller side of a frame with this aspect,
    /// width over height.
    pub fn framing(scene: &Scene, aspect: f32) -> Self {
        let (least, greatest) = scene.bounds().unwrap_or(([-1.0; 3], [1.0; 3]));
        let (least, greatest) = (Vec3::from_array(least), Vec3::from_array(greatest));
        let middle = least.midpoint(greatest);
        let reach = scene.objects.iter().flat_map(|object| &object.positions);
        let radius = reach.map(|position| middle.distance(Vec3::from_array(*position))).fold(0.0, f32::max).max(1.0e-6);
        let narrow = if aspect < 1.0 { (HALF_ANGLE.tan() * aspect).atan() } else { HALF_ANGLE };
        let distance = radius / narrow.sin();
        let eye = middle + distance * THREE_QUARTER.normalize();
        let view = view::look_at_mat4(eye, middle, Vec3::Y);
        let (near, far) = ((distance - radius).max(0.01 * radius), distance + radius);
        let projection = directx::perspective(2.0 * HALF_ANGLE, aspect, 0.99 * near, 1.01 * far);
        Camera { view_projection: (projection * view).to_cols_array(), eye: Eye::At(eye.to_array()) }
    }
}
