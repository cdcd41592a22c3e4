//! Decides the colour format of unlit images, which must not round the scene's colours layer by layer.

use crate::cli::view::SceneView;

/// The payload that does not round a scene's colours. The papers' payload rounds each layer to 255ths.
pub(super) const UNROUNDED: (&str, &str) = ("fragment.color", "rgba16");

/// Returns whether 8 bits a channel would round the colours of an unlit scene.
pub(super) fn needs_unrounded_colors(view: &SceneView) -> bool {
    view.is_unlit && !fits_8_bits(view)
}

/// Returns whether 8 bits a channel represent every colour of the scene, up to the rounding of its text.
fn fits_8_bits(view: &SceneView) -> bool {
    let whole = |channel: &f32| (255.0 * channel - (255.0 * channel).round()).abs() < 1.0e-3;
    view.scene.objects.iter().all(|object| object.colors.iter().flatten().all(whole))
}
