//! Cameras: one that frames a scene, and one that uses positions as clip-space positions.

use glam::camera::rh::{proj::directx, view};
use glam::{Mat4, Vec3};

use crate::scene::bounds;
use crate::{Object, Scene};

/// A view-projection matrix, and the eye, which is also the position of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The matrix from positions to clip space, column by column; y up, z from 0 to 1.
    pub view_projection: [f32; 16],
    /// The eye.
    pub eye: Eye,
}

/// The position of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// A point.
    At([f32; 3]),
    /// At infinity: all rays have the direction of this unit vector, from the eye into the scene.
    Along([f32; 3]),
}

/// Half the vertical angle of view.
const HALF_ANGLE: f32 = 20.0 * std::f32::consts::PI / 180.0;

/// The direction from the centre of the scene to the eye of [`Camera::framing`]: right, above and in front.
const THREE_QUARTER: Vec3 = Vec3::new(0.55, 0.45, 1.0);

/// The size of the frame relative to the scene.
const MARGIN: f32 = 1.04;

impl Camera {
    /// Returns a camera that uses positions as clip-space positions.
    pub fn clip() -> Self {
        Camera { view_projection: Mat4::IDENTITY.to_cols_array(), eye: Eye::Along([0.0, 0.0, 1.0]) }
    }

    /// Returns a perspective three-quarter view. All scenes together just fit into a frame with this aspect, width over height.
    pub fn framing(scenes: &[&Scene], aspect: f32) -> Self {
        let objects = || scenes.iter().flat_map(|scene| &scene.objects);
        let (least, greatest) = bounds(objects()).unwrap_or(([-1.0; 3], [1.0; 3]));
        let (least, greatest) = (Vec3::from_array(least), Vec3::from_array(greatest));
        let centre = least.midpoint(greatest);
        let turned = view::look_to_mat4(centre, -THREE_QUARTER.normalize(), Vec3::Y);
        let (tangent_y, tangent_x) = (HALF_ANGLE.tan() / MARGIN, HALF_ANGLE.tan() * aspect / MARGIN);
        // The distance of the eye from the centre for all points to be in view, and the range of depths.
        let (mut distance, mut depths) = (0.0_f32, (0.0_f32, 0.0_f32));
        for position in objects().flat_map(Object::corners) {
            let point = turned.transform_point3(Vec3::from_array(position));
            distance = distance.max(point.z + (point.x.abs() / tangent_x).max(point.y.abs() / tangent_y));
            depths = (depths.0.min(point.z), depths.1.max(point.z));
        }
        let thickness = (depths.1 - depths.0).max(1.0e-6);
        let distance = distance.max(depths.1 + 0.01 * thickness);
        let eye = centre + distance * THREE_QUARTER.normalize();
        let (near, far) = (distance - depths.1 - 0.005 * thickness, distance - depths.0 + 0.005 * thickness);
        let projection = directx::perspective(2.0 * HALF_ANGLE, aspect, near, far);
        // The same as a view from the eye, which may round to the centre if the scene is a point.
        let view = Mat4::from_translation(-distance * Vec3::Z) * turned;
        Camera { view_projection: (projection * view).to_cols_array(), eye: Eye::At(eye.to_array()) }
    }
}
