//! Lighting, baked into vertex colours: two-sided Lambert shading with the light at the eye.

use glam::Vec3;

use crate::{Eye, Scene};

/// The brightness of a surface at a grazing angle.
const AMBIENT: f32 = 0.2;

/// Darkens every vertex by the angle between its normal and the direction to the eye. Alpha does not change.
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
