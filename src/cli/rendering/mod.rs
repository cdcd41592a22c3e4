//! Renders one scene through one description, and redraws it with a larger capacity until no fragment is lost to overflow.
//!
//! Input: a description and a scene view. Output: premultiplied linear colours and the statistics of the frame. Remaining
//! losses (a lock that was not free in time, more layers than any resolve pass holds) are reported on stderr.

mod cpu;
#[cfg(feature = "gpu")]
mod estimate;
mod external;
#[cfg(feature = "gpu")]
mod gpu;
mod importance;
#[cfg(feature = "gpu")]
mod mesh;
mod opaque;
mod precision;
mod preintegrated;
mod prepared;
mod request;
mod result;
mod selection;
pub(super) mod textures;
mod warnings;

#[cfg(feature = "figures")]
pub(crate) use prepared::FrameTime;
pub(crate) use prepared::PreparedFrame;
pub(crate) use request::RenderRequest;
pub(crate) use result::RenderResult;
#[cfg(feature = "figures")]
pub(crate) use selection::select_for_figure;
pub(crate) use selection::{DeviceSelection, select};

use fragbuf::vocabulary::Capability;
use fragbuf::{Form, Registry, Request, TARGETS, Target, Variant, generate};

use self::opaque::{OpaqueScene, blend_over, occlusion_choice};
use self::precision::{UNROUNDED, needs_unrounded_colors};
use self::request::{RedrawState, RenderTask};
use self::result::fixed_layers;
use self::selection::SelectedDevice;
use super::input::Input;
use super::output::{self, Failure};
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
    let mut result = complete(request, input, (view, selection), scene, progress)?.result;
    let uniforms = uniforms::values(request.uniforms, &result.plan.variant, scene)?;
    result.warn(request.description, &uniforms, &scene.scene);
    let has_importance = result
        .plan
        .resources
        .iter()
        .any(|planned| planned.is_external() && !planned.is_opaque_depth() && !planned.is_of_description());
    if view.importance.is_some() && !has_importance && !view.is_later_frame {
        let help = "choose `--set allocation=by_importance` for a storage that has it, or leave out `--importance`";
        output::warn(&format!("{}: `--importance` changes nothing: {help}", request.description));
    }
    if let Some(background) = result.opaque.take() {
        blend_over(&mut result.stats.pixels, &background);
    }
    Ok(result)
}

/// Renders the scene as [`render`] does, without warnings and without the image of an opaque scene.
pub(crate) fn render_quietly(
    request: &RenderRequest<'_>,
    input: &mut Input,
    (view, selection): (&View, &mut DeviceSelection),
    scene: &SceneView,
    progress: &Progress,
) -> Result<RenderResult, Failure> {
    Ok(complete(request, input, (view, selection), scene, progress)?.result)
}

/// Renders the scene as [`render`] does, without warnings, and prepares the same frame without counters, to be drawn repeatedly.
#[cfg(feature = "figures")]
pub(crate) fn prepare(
    request: &RenderRequest<'_>,
    input: &mut Input,
    (view, selection): (&View, &mut DeviceSelection),
    scene: &SceneView,
    progress: &Progress,
) -> Result<(RenderResult, PreparedFrame), Failure> {
    let registry = Registry::builtin();
    let CompleteFrame { result, mut set, mut redraw } = complete(request, input, (view, selection), scene, progress)?;
    set.extend(count_nothing_choice(&registry).map(|(axis, key)| (axis.to_owned(), key.to_owned())));
    let memory = view.memory_beside(&[scene])?.without(request.held, "the other image")?;
    let defaults = defaults(request, input, scene, &registry);
    let variant = input.variant_with_defaults(&set, &defaults, &registry)?;
    let task = RenderTask { request, view, scene, progress, variant: &variant, opaque: None, memory };
    let (_, frame) = draw(&task, &selection.device, (input, &registry), &mut redraw)?;
    Ok((result, frame))
}

/// A rendering without overflow, with the choices and the state that led to it.
#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
struct CompleteFrame {
    result: RenderResult,
    set: Vec<(String, String)>,
    redraw: RedrawState,
}

/// Renders the scene with larger pools and more layers until no fragment is lost to overflow.
fn complete(
    request: &RenderRequest<'_>,
    input: &mut Input,
    (view, selection): (&View, &mut DeviceSelection),
    scene: &SceneView,
    progress: &Progress,
) -> Result<CompleteFrame, Failure> {
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
        let (result, _) = draw(&task, &selection.device, (input, &registry), &mut redraw)?;
        match result.more_layers().filter(|_| !has_fixed_layers) {
            Some((option, layers)) => {
                if selection.leave_driver(layers, view) {
                    // Slices and pools are those of the other device.
                    redraw = RedrawState { frames: redraw.frames, ..RedrawState::default() };
                }
                set.push((option, layers.to_string()));
            }
            None => return Ok(CompleteFrame { result, set, redraw }),
        }
    }
}

/// Draws a task on a device.
fn draw(
    task: &RenderTask<'_>,
    device: &SelectedDevice,
    (input, registry): (&Input, &Registry),
    redraw: &mut RedrawState,
) -> Result<(RenderResult, PreparedFrame), Failure> {
    match device {
        SelectedDevice::Cpu(order) => {
            let (result, frame) = cpu::render(task, *order, (input, registry), redraw)?;
            Ok((result, PreparedFrame::Cpu(Box::new(frame))))
        }
        #[cfg(feature = "gpu")]
        SelectedDevice::Gpu(adapter) => {
            let (result, frame) = gpu::render(task, adapter, (input, registry), redraw)?;
            Ok((result, PreparedFrame::Gpu(Box::new(frame))))
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
    // Some storages have slots that hold no more than the papers' payload, and some user files read the word of the colour. They round
    // as the papers do.
    let is_valid = |variant: Variant| fits_user_files(&variant, registry);
    if unrounded && !input.variant_with_defaults(request.set, &defaults, registry).is_ok_and(is_valid) {
        defaults.retain(|set| *set != UNROUNDED);
    }
    defaults
}

/// Tests whether the WGSL of user files is valid with the payload of a variant.
fn fits_user_files(variant: &Variant, registry: &Registry) -> bool {
    let rows = variant.choices.iter().flat_map(|chosen| &chosen.alternatives).map(|selected| &selected.row);
    if !rows.flat_map(|row| &row.template).any(|template| template.user_file.is_some()) {
        return true;
    }
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    generate(variant, &request, registry).is_ok()
}

/// Returns the choice that counts every event.
fn count_all_choice(registry: &Registry) -> Option<(&str, &str)> {
    registry.providers_of(Capability::CountsEvents).next().map(|row| (row.axis.as_str(), row.key.as_str()))
}

/// Returns the choice that counts nothing: the row of the same axis that needs no memory.
#[cfg(feature = "figures")]
fn count_nothing_choice(registry: &Registry) -> Option<(&str, &str)> {
    let (axis, _) = count_all_choice(registry)?;
    let row = registry.rows_of(axis).find(|row| row.resources.is_empty())?;
    Some((axis, &row.key))
}
