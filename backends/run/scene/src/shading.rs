//! Light, baked into the colours of vertices: Lambert with a lamp at the eye, and the same from both sides.

use glam::Vec3;

use crate::{Eye, Scene};

/// What a surface that the light only grazes has left.
const AMBIENT: f32 = 0.2;

/// Darkens every vertex by the angle between its normal and the way to the eye. Alpha stays.
pub fn light(scene: &mut Scene, eye: Eye) {
    for object in &mut scene.objects {
        let vertices = object.positions.iter().zip(&object.normals);
        for (color, (position, normal)) in object.colors.iter_mut().zip(vertices) {
            let ray = match eye {
                Eye::At(eye) => (Vec3::from_array(eye) - Vec3::from_array(*position)).normalize_or_zero(),
                Eye::Along(ray) => Vec3::from_array(ray),
            };
            let light = AMBIENT + (1.0 - AMBIENT) * Vec3::from_array(*normal).dot(ray).abs();
            for channel in color.iter_mut().take(3) {
                *channel *= light;
            }
        }
    }
}
