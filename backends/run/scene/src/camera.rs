//! Cameras: one that frames any scene, and one that takes vertices as they stand.

use glam::camera::rh::{proj::directx, view};
use glam::{Mat4, Vec3};

use crate::{Object, Scene};

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

/// The frame over what the scene fills of it.
const MARGIN: f32 = 1.04;

impl Camera {
    /// Positions are clip-space positions.
    pub fn clip() -> Self {
        Camera { view_projection: Mat4::IDENTITY.to_cols_array(), eye: Eye::Along([0.0, 0.0, 1.0]) }
    }

    /// Three-quarter view in perspective, as near as the whole scene fits into a frame with this aspect, width over height.
    pub fn framing(scene: &Scene, aspect: f32) -> Self {
        let (least, greatest) = scene.bounds().unwrap_or(([-1.0; 3], [1.0; 3]));
        let (least, greatest) = (Vec3::from_array(least), Vec3::from_array(greatest));
        let middle = least.midpoint(greatest);
        let turned = view::look_to_mat4(middle, -THREE_QUARTER.normalize(), Vec3::Y);
        let (tangent_y, tangent_x) = (HALF_ANGLE.tan() / MARGIN, HALF_ANGLE.tan() * aspect / MARGIN);
        // How far from the middle the eye must be for a point to be in view, and how near and far points lie.
        let (mut distance, mut depths) = (0.0_f32, (0.0_f32, 0.0_f32));
        for position in scene.objects.iter().flat_map(Object::corners) {
            let point = turned.transform_point3(Vec3::from_array(position));
            distance = distance.max(point.z + (point.x.abs() / tangent_x).max(point.y.abs() / tangent_y));
            depths = (depths.0.min(point.z), depths.1.max(point.z));
        }
        let thickness = (depths.1 - depths.0).max(1.0e-6);
        let distance = distance.max(depths.1 + 0.01 * thickness);
        let eye = middle + distance * THREE_QUARTER.normalize();
        let (near, far) = (distance - depths.1 - 0.005 * thickness, distance - depths.0 + 0.005 * thickness);
        let projection = directx::perspective(2.0 * HALF_ANGLE, aspect, near, far);
        let view = view::look_at_mat4(eye, middle, Vec3::Y);
        Camera { view_projection: (projection * view).to_cols_array(), eye: Eye::At(eye.to_array()) }
    }
}
