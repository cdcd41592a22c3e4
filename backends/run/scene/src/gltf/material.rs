//! The colours of a primitive that its material determines.

use gltf::Material;
use gltf::material::AlphaMode;

/// Returns the factor of all vertex colours. A primitive without a material has the default material of the format, white and
/// opaque; if it has no vertex colours either, `color` replaces it.
pub(super) fn factor(material: &Material<'_>, has_colors: bool, color: [f32; 4]) -> [f32; 4] {
    match material.index() {
        None if has_colors => [1.0; 4],
        None => color,
        Some(_) => match material.pbr_specular_glossiness() {
            Some(glossiness) => glossiness.diffuse_factor(),
            None => material.pbr_metallic_roughness().base_color_factor(),
        },
    }
}

/// Returns a colour with the alpha that the material's mode shows: opaque, 0 or 1 by a limit, or its own.
pub(super) fn visible(material: &Material<'_>, [r, g, b, alpha]: [f32; 4]) -> [f32; 4] {
    let alpha = match material.alpha_mode() {
        // Without a material the colour is that of the caller or of the vertices.
        _ if material.index().is_none() => alpha,
        AlphaMode::Opaque => 1.0,
        AlphaMode::Mask if alpha >= material.alpha_cutoff().unwrap_or(0.5) => 1.0,
        AlphaMode::Mask => 0.0,
        AlphaMode::Blend => alpha,
    };
    [r, g, b, alpha]
}
