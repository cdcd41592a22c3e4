//! Takes the transparent meshes of a camera from Bevy's phase.
//!
//! Input: the items of `Transparent3d`. Output: the same items with a draw function that draws nothing, and for each of them a pipeline per
//! pass that stores. Bevy keeps its items from frame to frame, with their visibility and batches, so they stay where they are. Meshes with
//! other materials or blend modes remain Bevy's.

use std::any::TypeId;

use bevy::core_pipeline::core_3d::Transparent3d;
use bevy::ecs::query::ROQueryItem;
use bevy::ecs::system::SystemParamItem;
use bevy::pbr::{
    DrawMesh, MainPassTransparentDrawFunction, PreparedMaterial, RenderMaterialInstances, SetMaterialBindGroup,
    SetMeshBindGroup, SetMeshViewBindGroup, SetMeshViewBindingArrayBindGroup,
};
use bevy::prelude::*;
use bevy::render::erased_render_asset::ErasedRenderAssets;
use bevy::render::render_phase::{
    DrawFunctions, PhaseItem, RenderCommand, RenderCommandResult, TrackedRenderPass, ViewSortedRenderPhases,
};
use bevy::render::render_resource::{CachedPipelineState, PipelineCache};

use super::material::MATERIAL_GROUP;
use super::views::FollowedViews;

/// Draws a mesh with the pipeline and the fragment buffer that have been set.
pub type DrawStored = (
    SetMeshViewBindGroup<0>,
    SetMeshViewBindingArrayBindGroup<1>,
    SetMeshBindGroup<2>,
    SetMaterialBindGroup<MATERIAL_GROUP>,
    DrawMesh,
);

/// What Bevy's own transparent pass does with a mesh that is stored.
pub struct DrawNothing;

impl<P: PhaseItem> RenderCommand<P> for DrawNothing {
    type Param = ();
    type ViewQuery = ();
    type ItemQuery = ();

    fn render<'w>(
        _: &P,
        (): ROQueryItem<'w, '_, ()>,
        _: Option<ROQueryItem<'w, '_, ()>>,
        (): SystemParamItem<'w, '_, ()>,
        _: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        RenderCommandResult::Success
    }
}

/// Takes the items of cameras whose buffers are ready, and gives back those of others.
pub fn take(
    mut phases: ResMut<ViewSortedRenderPhases<Transparent3d>>,
    mut views: ResMut<FollowedViews>,
    functions: Res<DrawFunctions<Transparent3d>>,
    instances: Res<RenderMaterialInstances>,
    materials: Res<ErasedRenderAssets<PreparedMaterial>>,
    cache: Res<PipelineCache>,
) {
    let nothing = functions.read().id::<DrawNothing>();
    for (view, phase) in phases.iter_mut() {
        let mut followed = views.ready(view);
        for item in phase.items.values_mut() {
            let instance = instances.instances.get(&item.main_entity());
            let standard = instance.filter(|instance| instance.asset_id.type_id() == TypeId::of::<StandardMaterial>());
            let Some(material) = standard.and_then(|instance| materials.get(instance.asset_id)) else { continue };
            let is_blended = material.properties.alpha_mode == AlphaMode::Blend;
            match &mut followed {
                Some(followed) if is_blended => {
                    item.draw_function = nothing;
                    // The descriptor of a pipeline that Bevy has not processed cannot be read yet. It draws nothing in this frame either.
                    if !matches!(cache.get_render_pipeline_state(item.pipeline), CachedPipelineState::Queued) {
                        followed.specialize(item.pipeline, &cache);
                    }
                }
                _ if item.draw_function == nothing => {
                    let own = material.properties.get_draw_function(MainPassTransparentDrawFunction);
                    item.draw_function = own.unwrap_or(nothing);
                }
                _ => {}
            }
        }
    }
}
