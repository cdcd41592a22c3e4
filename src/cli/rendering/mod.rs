//! Renders one scene through one description, and redraws it with a larger capacity until no fragment is lost to overflow.
//!
//! Input: a description and a scene view. Output: premultiplied linear colours and the statistics of the frame. Remaining
//! losses (a lock that was not free in time, more layers than any resolve pass holds) are reported on stderr.

mod cpu;
#[cfg(feature = "gpu")]
mod estimate;
#[cfg(feature = "gpu")]
mod gpu;
mod opaque;
mod precision;
mod request;
mod result;
mod selection;

pub(crate) use request::RenderRequest;
pub(crate) use result::RenderResult;
pub(crate) use selection::{DeviceSelection, select};

use fragbuf::vocabulary::Capability;
use fragbuf::{Registry, Variant};

use self::opaque::{OpaqueScene, blend_over, occlusion_choice};
use self::precision::{UNROUNDED, needs_unrounded_colors};
use self::request::{RedrawState, RenderTask};
use self::result::fixed_layers;
use self::selection::SelectedDevice;
use super::input::Input;
use super::output::Failure;
use super::progress::Progress;
use super::uniforms;
use super::view::{SceneView, View};

/// Renders the scene through the description `input`, on the device that [`select`] returned, or on the CPU device if a software driver
/// that `auto` selected turns out to be unsuitable: then `selection` changes.
pub(crate) fn render(
    request: &RenderRequest<'_>,
    input: &mut Input,
    (view, selection): (&View, &mut DeviceSelection),
    scene: &SceneView,
    progress: &Progress,
) -> Result<RenderResult, Failure> {
    let registry = Registry::builtin();
    let scenes: Vec<&SceneView> = std::iter::once(scene).chain(request.opaque).collect();
    let memory = view.memory_beside(&scenes)?.without(request.held, "the other image")?;
    let opaque = request.opaque.map(|scene| OpaqueScene::new(scene, &registry)).transpose()?;
    let defaults = defaults(request, input, scene, &registry);
    let (mut set, mut redraw) = (request.set.to_vec(), RedrawState::default());
    let mut has_fixed_layers = None;
    loop {
        let variant = input.variant_with_defaults(&set, &defaults, &registry)?;
        // Later iterations set the layers themselves.
        let has_fixed_layers = *has_fixed_layers.get_or_insert_with(|| fixed_layers(&variant).is_some());
        let task = RenderTask { request, view, scene, progress, variant: &variant, opaque: opaque.as_ref(), memory };
        let mut result = match &selection.device {
            SelectedDevice::Cpu(order) => cpu::render(&task, *order, (input, &registry), &mut redraw)?,
            #[cfg(feature = "gpu")]
            SelectedDevice::Gpu(adapter) => gpu::render(&task, adapter, (input, &registry), &mut redraw)?,
        };
        match result.more_layers().filter(|_| !has_fixed_layers) {
            Some((option, layers)) => {
                if selection.leave_driver(layers, view) {
                    // Slices and pools are those of the other device.
                    redraw = RedrawState { frames: redraw.frames, ..RedrawState::default() };
                }
                set.push((option, layers.to_string()));
            }
            None => {
                result.warn(request.description, &uniforms::values(request.uniforms, &variant)?, &scene.scene);
                if let Some(background) = result.opaque.take() {
                    blend_over(&mut result.stats.pixels, &background);
                }
                return Ok(result);
            }
        }
    }
}

/// Returns the variant of the first frame of a request.
fn variant(
    request: &RenderRequest<'_>,
    input: &mut Input,
    scene: &SceneView,
    registry: &Registry,
) -> Result<Variant, Failure> {
    let defaults = defaults(request, input, scene, registry);
    input.variant_with_defaults(request.set, &defaults, registry)
}

/// Returns the choices for axes on which neither the description nor `--set` chooses.
fn defaults<'a>(
    request: &RenderRequest<'_>,
    input: &mut Input,
    scene: &SceneView,
    registry: &'a Registry,
) -> Vec<(&'a str, &'a str)> {
    let unrounded = needs_unrounded_colors(scene);
    let mut defaults: Vec<(&str, &str)> = Vec::new();
    defaults.extend(count_all_choice(registry).filter(|_| request.count_all));
    defaults.extend(unrounded.then_some(UNROUNDED));
    defaults.extend(request.opaque.and_then(|_| occlusion_choice(registry)));
    // Some storages have slots that hold no more than the papers' payload. They round as the papers do.
    if unrounded && input.variant_with_defaults(request.set, &defaults, registry).is_err() {
        defaults.retain(|set| *set != UNROUNDED);
    }
    defaults
}

/// Returns the choice that counts every event.
fn count_all_choice(registry: &Registry) -> Option<(&str, &str)> {
    registry.providers_of(Capability::CountsEvents).next().map(|row| (row.axis.as_str(), row.key.as_str()))
}
