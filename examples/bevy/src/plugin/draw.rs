//! Draws the frame of a camera: its depth is copied, the passes run, and their image is composited over the camera's colours.

use std::collections::BTreeMap;

use bevy::core_pipeline::core_3d::Transparent3d;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::render_phase::{
    DrawFunctionId, DrawFunctions, PhaseItem, SortedRenderPhase, TrackedRenderPass, ViewSortedRenderPhases,
};
use bevy::render::render_resource::{CachedRenderPipelineId, PipelineCache};
use bevy::render::renderer::{CurrentView, PendingCommandBuffers, RenderDevice, RenderQueue};
use bevy::render::view::{ExtractedView, Msaa, RetainedViewEntity, ViewDepthTexture, ViewTarget};
use fragbuf_follow::{Error, Scene};

use super::losses::Reports;
use super::meshes::{DrawNothing, DrawStored};
use super::screen::Screen;
use super::views::{FollowedView, FollowedViews};
use crate::follower::{Geometry, GeometryDraw, Output};

/// Draws the fragments of the camera whose graph runs.
pub fn draw(world: &mut World) {
    let Some(CurrentView(entity)) = world.get_resource::<CurrentView>().copied() else { return };
    let Some(view) = world.get::<ExtractedView>(entity).map(|view| view.retained_view_entity) else { return };
    let Some(mut views) = world.remove_resource::<FollowedViews>() else { return };
    let mut pending = world.remove_resource::<PendingCommandBuffers>().unwrap_or_default();
    let mut reports = world.remove_resource::<Reports>();
    let FollowedViews { screen, .. } = &mut views;
    let mut screen = std::mem::take(screen);
    let drawn = match views.ready(&view) {
        Some(followed) => Camera { world, entity, view }.draw(followed, &mut screen, &mut pending, reports.as_mut()),
        None => Ok(()),
    };
    views.screen = screen;
    if let Err(error) = drawn {
        views.fail(&view, &error);
    }
    world.insert_resource(views);
    world.insert_resource(pending);
    if let Some(reports) = reports {
        world.insert_resource(reports);
    }
}

/// The camera whose graph runs.
struct Camera<'w> {
    world: &'w World,
    entity: Entity,
    view: RetainedViewEntity,
}

impl Camera<'_> {
    fn draw(
        &self,
        followed: &mut FollowedView,
        screen: &mut Screen,
        pending: &mut PendingCommandBuffers,
        reports: Option<&mut Reports>,
    ) -> Result<(), Error> {
        let Some(meshes) = Meshes::of(self, followed) else { return Ok(()) };
        let (Some(target), Some(depth), Some(extracted)) = (
            self.world.get::<ViewTarget>(self.entity),
            self.world.get::<ViewDepthTexture>(self.entity),
            self.world.get::<ExtractedView>(self.entity),
        ) else {
            return Ok(());
        };
        let samples = self.world.get::<Msaa>(self.entity).map_or(1, Msaa::samples);
        let device = self.world.resource::<RenderDevice>().wgpu_device();
        let queue = self.world.resource::<RenderQueue>();
        let encoder = || device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("fragments") });
        if let Some(opaque) = &followed.opaque {
            let mut encoder = encoder();
            screen.copy_depth(device, &mut encoder, (depth.view(), samples), opaque);
            pending.push([encoder.finish()]);
        }
        let view = followed.image.create_view(&wgpu::TextureViewDescriptor::default());
        // Where the host must read words, everything that comes before is submitted first.
        let mut submit = |commands| {
            pending.push([commands]);
            queue.submit(pending.take());
        };
        let output = Output { view: &view, clear: Some(wgpu::Color::TRANSPARENT), submit: &mut submit };
        let scene = Scene { vertices: &[], objects: &[], view_projection: [0.0; 16] };
        let commands = followed.follower.draw(output, &meshes, &scene)?;
        let mut encoder = encoder();
        let colors = (target.get_color_attachment(), extracted.target_format, samples);
        screen.composite(device, &mut encoder, &followed.image, colors);
        if let Some(reports) = reports {
            reports.record(&followed.follower, followed.bytes(), self.view.main_entity, &mut encoder);
        }
        pending.push([commands, encoder.finish()]);
        Ok(())
    }
}

/// The meshes of a camera that are stored.
struct Meshes<'w> {
    world: &'w World,
    entity: Entity,
    phase: &'w SortedRenderPhase<Transparent3d>,
    /// The function that draws, and the one that items to be stored have.
    functions: [DrawFunctionId; 2],
    /// The pipelines, by the index of the item and that of the step.
    pipelines: BTreeMap<(usize, usize), CachedRenderPipelineId>,
}

impl<'w> Meshes<'w> {
    /// Returns the meshes of a camera, if there are any. One whose pipelines are not compiled is left out of all passes, because passes that
    /// draw the scene must produce the same fragments.
    fn of(camera: &Camera<'w>, followed: &FollowedView) -> Option<Self> {
        let world = camera.world;
        let phase = world.get_resource::<ViewSortedRenderPhases<Transparent3d>>()?.get(&camera.view)?;
        let functions = world.get_resource::<DrawFunctions<Transparent3d>>()?;
        let functions = [functions.read().get_id::<DrawStored>()?, functions.read().get_id::<DrawNothing>()?];
        let cache = world.get_resource::<PipelineCache>()?;
        let compiled = |item: &Transparent3d, step: usize| {
            followed.pipeline(item.pipeline, step).filter(|id| cache.get_render_pipeline(*id).is_some())
        };
        let mut pipelines = BTreeMap::new();
        for (index, item) in phase.items.values().enumerate().filter(|(_, item)| item.draw_function == functions[1]) {
            let of_passes =
                followed.stores.iter().map(|store| Some(((index, store.step), compiled(item, store.step)?)));
            pipelines.extend(of_passes.collect::<Option<Vec<_>>>().unwrap_or_default());
        }
        (!pipelines.is_empty()).then_some(Meshes { world, entity: camera.entity, phase, functions, pipelines })
    }
}

impl Geometry for Meshes<'_> {
    fn draw(&self, draw: &GeometryDraw<'_>, mut render: wgpu::RenderPass<'static>) -> Result<(), Error> {
        let failed = |error: &dyn std::fmt::Display| Error(format!("a mesh was not drawn: {error}"));
        if draw.call.is_queried {
            render.begin_occlusion_query(0);
        }
        let device = self.world.resource::<RenderDevice>();
        let cache = self.world.resource::<PipelineCache>();
        let mut functions = self.world.resource::<DrawFunctions<Transparent3d>>().write();
        functions.prepare(self.world);
        let function = functions.get_mut(self.functions[0]).ok_or_else(|| failed(&"it has no draw function"))?;
        let mut render = TrackedRenderPass::new(device, render);
        let camera = self.world.get::<ExtractedCamera>(self.entity);
        if let Some(viewport) = camera.and_then(|camera| camera.viewport.as_ref()) {
            render.set_camera_viewport(viewport);
        }
        let mut index = 0;
        while let Some((_, item)) = self.phase.items.get_index(index) {
            let pipeline = self.pipelines.get(&(index, draw.call.step)).and_then(|id| cache.get_render_pipeline(*id));
            if let Some(pipeline) = pipeline.filter(|_| !item.batch_range().is_empty()) {
                render.set_render_pipeline(pipeline);
                function.draw(self.world, &mut render, self.entity, item).map_err(|error| failed(&error))?;
            }
            // A batch draws the items behind its first one.
            index += item.batch_range().len().max(1);
        }
        if draw.call.is_queried {
            render.wgpu_pass().end_occlusion_query();
        }
        Ok(())
    }
}
