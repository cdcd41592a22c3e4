//! Cameras: one that frames a scene from a direction, one that the caller places, and one that uses positions as clip-space positions.
//!
//! Input: scenes in the same coordinates, and the aspect of the frame, width over height. Output: a matrix and the eye. Near and far
//! planes follow from the scenes.

use std::fmt;

use glam::camera::rh::{proj::directx, view};
use glam::{DVec3, Mat4, Vec3, dcamera};

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

/// The vertical field of view of [`Camera::framing`], in degrees.
pub const FIELD_OF_VIEW: f64 = 40.0;

/// Half of it.
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

    /// Returns a perspective three-quarter view. All scenes together just fit into a frame with this aspect.
    pub fn framing(scenes: &[&Scene], aspect: f32) -> Self {
        Camera::framing_from(scenes, aspect, (THREE_QUARTER.normalize(), Vec3::Y), HALF_ANGLE)
    }

    /// Returns azimuth and elevation of the view of [`Camera::framing`], in degrees, as [`Camera::orbit`] takes them.
    pub fn framing_angles() -> [f64; 2] {
        let direction = THREE_QUARTER.as_dvec3().normalize();
        [direction.x.atan2(direction.z).to_degrees(), direction.y.asin().to_degrees()]
    }

    /// Returns a perspective view from a direction, in degrees. All scenes together just fit into a frame with this aspect.
    ///
    /// The azimuth 0 is in front (positive z), 90 on the right (positive x); the elevation 90 is above (positive y). `field_of_view`
    /// is the vertical one.
    pub fn orbit(scenes: &[&Scene], aspect: f32, [azimuth, elevation]: [f64; 2], field_of_view: f64) -> Self {
        // Reduced first, so that multiples of 360 degrees are exact.
        let ((sin_a, cos_a), (sin_e, cos_e)) =
            ((azimuth % 360.0).to_radians().sin_cos(), elevation.to_radians().sin_cos());
        let direction = DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        // The direction in which the eye rises. It is perpendicular to the view, from above and from below, too.
        let up = DVec3::new(-sin_a * sin_e, cos_e, -cos_a * sin_e);
        let half_angle = (0.5 * field_of_view).to_radians() as f32;
        Camera::framing_from(scenes, aspect, (direction.as_vec3().normalize(), up.as_vec3().normalize()), half_angle)
    }

    /// Returns the view with the centre of the image magnified. Near and far planes stay.
    pub fn magnified(mut self, factor: f64) -> Self {
        for column in self.view_projection.chunks_exact_mut(4) {
            column.iter_mut().take(2).for_each(|value| *value *= factor as f32);
        }
        self
    }

    /// Returns a view from the direction that just fits all scenes. `direction` and `up` are unit vectors.
    fn framing_from(scenes: &[&Scene], aspect: f32, (direction, up): (Vec3, Vec3), half_angle: f32) -> Self {
        let objects = || scenes.iter().flat_map(|scene| &scene.objects);
        let (least, greatest) = bounds(objects()).unwrap_or(EMPTY);
        let (least, greatest) = (Vec3::from_array(least), Vec3::from_array(greatest));
        let centre = least.midpoint(greatest);
        let turned = view::look_to_mat4(centre, -direction, up);
        let (tangent_y, tangent_x) = (half_angle.tan() / MARGIN, half_angle.tan() * aspect / MARGIN);
        // The distance of the eye from the centre for all points to be in view, and the range of depths.
        let (mut distance, mut depths) = (0.0_f32, (0.0_f32, 0.0_f32));
        for position in objects().flat_map(Object::corners) {
            let point = turned.transform_point3(Vec3::from_array(position));
            distance = distance.max(point.z + (point.x.abs() / tangent_x).max(point.y.abs() / tangent_y));
            depths = (depths.0.min(point.z), depths.1.max(point.z));
        }
        let thickness = (depths.1 - depths.0).max(1.0e-6);
        let distance = distance.max(depths.1 + 0.01 * thickness);
        let eye = centre + distance * direction;
        let (near, far) = (distance - depths.1 - 0.005 * thickness, distance - depths.0 + 0.005 * thickness);
        let projection = directx::perspective(2.0 * half_angle, aspect, near, far);
        // The same as a view from the eye, which may round to the centre if the scene is a point.
        let view = Mat4::from_translation(-distance * Vec3::Z) * turned;
        Camera { view_projection: (projection * view).to_cols_array(), eye: Eye::At(eye.to_array()) }
    }

    /// Returns a perspective view from `eye` to `target`, the centre of the scenes if there is none. Both are coordinates of the models.
    /// `field_of_view` is the vertical one, in degrees. The upper edge of the image is that of positive y; if the view is vertical, that of
    /// the side away from an eye in front.
    ///
    /// What is nearer than a ten-thousandth of the farthest visible point is clipped, so the eye may be inside of a scene.
    pub fn looking(
        scenes: &[&Scene],
        aspect: f64,
        (eye, target): ([f64; 3], Option<[f64; 3]>),
        field_of_view: f64,
    ) -> Result<Self, CameraError> {
        let objects = || scenes.iter().flat_map(|scene| &scene.objects);
        let placement = scenes.first().map(|scene| scene.placement).unwrap_or_default();
        let (least, greatest) = bounds(objects()).unwrap_or(EMPTY);
        let (least, greatest) = (Vec3::from_array(least).as_dvec3(), Vec3::from_array(greatest).as_dvec3());
        let size = (greatest - least).length().max(1.0e-6);
        let eye = DVec3::from_array(placement.in_scene(eye));
        let target = target.map_or(least.midpoint(greatest), |target| DVec3::from_array(placement.in_scene(target)));
        if !(eye.is_finite() && target.is_finite() && eye.distance(least.midpoint(greatest)) <= FARTHEST * size) {
            return Err(CameraError::TooFar);
        }
        // Points that are very far away have a direction, too.
        let offset = target - eye;
        let forward = (offset / offset.abs().max_element()).try_normalize().ok_or(CameraError::NoDirection)?;
        let is_vertical = forward.cross(DVec3::Y).length() < VERTICAL;
        let up = if is_vertical { DVec3::Z * forward.y.signum() } else { DVec3::Y };
        let depth = |position: [f32; 3]| (Vec3::from_array(position).as_dvec3() - eye).dot(forward);
        let depths = objects().flat_map(Object::corners).map(depth).map(|depth| (depth, depth));
        let (nearest, farthest) = depths.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((size, size));
        // A scene behind the eye has an empty image, and planes nevertheless.
        let far = (farthest + 0.005 * size).max(0.001 * size);
        let near = (nearest - 0.005 * size).max(NEAREST * far);
        let projection = dcamera::rh::proj::directx::perspective(field_of_view.to_radians(), aspect, near, far);
        let matrix = projection * dcamera::rh::view::look_to_mat4(eye, forward, up);
        Ok(Camera { view_projection: matrix.as_mat4().to_cols_array(), eye: Eye::At(eye.as_vec3().to_array()) })
    }
}

/// The bounds that a scene without triangles has for a camera.
const EMPTY: ([f32; 3], [f32; 3]) = ([-1.0; 3], [1.0; 3]);

/// The distance of the near plane relative to the far plane, at least.
const NEAREST: f64 = 1.0e-4;

/// The distance of the eye relative to the size of the scene, at most. Beyond it, depths of 32 bits do not order the scene.
const FARTHEST: f64 = 1.0e5;

/// The sine of the angle to the vertical below which a view has another upper edge.
const VERTICAL: f64 = 1.0e-6;

/// Why [`Camera::looking`] returns no camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraError {
    /// The eye and the target are the same point.
    NoDirection,
    /// The eye is too far from the scene.
    TooFar,
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            CameraError::NoDirection => "the eye and the target are the same point: move one of them",
            CameraError::TooFar => {
                "the eye is more than 100,000 times the size of the scene away from it: move it closer, and use a smaller field of view"
            }
        })
    }
}

impl std::error::Error for CameraError {}
