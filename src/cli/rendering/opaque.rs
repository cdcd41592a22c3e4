//! The opaque scene of `--opaque`, which is rendered first.
//!
//! Input: a scene view. Output: its description, and the name of the depth buffer that it leaves.
//! Its depth buffer hides transparent fragments behind it; its image is their background.

use fragbuf::vocabulary::{Capability, Init, Technique};
use fragbuf::{Plan, Registry, Variant};

use super::precision::{UNROUNDED, needs_unrounded_colors};
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::view::SceneView;

/// The axis that decides on fragments behind opaque surfaces.
const AXIS: &str = "opaque";

/// The opaque scene and the variant that renders it.
pub(super) struct OpaqueScene<'a> {
    pub(super) scene: &'a SceneView,
    pub(super) variant: Variant,
    pub(super) input: Input,
}

impl<'a> OpaqueScene<'a> {
    /// Selects the technique that leaves a depth buffer.
    pub(super) fn new(scene: &'a SceneView, registry: &Registry) -> Result<Self, Failure> {
        let none = || Failure::Input("no technique leaves the depth of the nearest fragment".to_owned());
        let mut input = Input::read(depth_technique(registry).ok_or_else(none)?, registry)?;
        let defaults = if needs_unrounded_colors(scene) { &[UNROUNDED][..] } else { &[] };
        let variant = input.variant_with_defaults(&[], defaults, registry)?;
        Ok(OpaqueScene { scene, variant, input })
    }
}

/// Returns the choice that culls fragments behind opaque surfaces: the first row with an external depth buffer.
pub(super) fn occlusion_choice(registry: &Registry) -> Option<(&str, &str)> {
    let mut rows = registry.rows_of(AXIS);
    let row = rows.find(|row| row.resources.iter().any(|resource| resource.init == Init::External))?;
    Some((AXIS, &row.key))
}

/// Returns the key of the technique that leaves the depth of the nearest fragment. Peeling leaves that of the last.
fn depth_technique(registry: &Registry) -> Option<&str> {
    let leaves_depth = |technique: &&Technique| {
        let rows = || technique.choices.iter().filter_map(|(axis, key)| registry.row(axis, key));
        let provides = |capability| rows().any(|row| row.provides.contains(&capability));
        provides(Capability::LeavesDepth) && !provides(Capability::KeepsLater)
    };
    registry.techniques().iter().find(leaves_depth).map(|technique| technique.key.as_str())
}

/// Returns the name of the depth buffer that a plan leaves: the one that a pass tests and writes.
pub(super) fn depth_texture(plan: &Plan) -> Result<String, Failure> {
    let mut tests = plan.passes.iter().filter_map(|pass| pass.state.depth.as_ref());
    let written = tests.find(|test| test.write).map(|test| test.resource.clone());
    written.ok_or_else(|| Failure::Input("the opaque technique leaves no depth buffer".to_owned()))
}

/// Blends premultiplied colours over a background.
pub(super) fn blend_over(pixels: &mut [[f32; 4]], background: &[[f32; 4]]) {
    for (pixel, behind) in pixels.iter_mut().zip(background) {
        let transmittance = 1.0 - pixel[3];
        pixel.iter_mut().zip(behind).for_each(|(channel, behind)| *channel += transmittance * behind);
    }
}
