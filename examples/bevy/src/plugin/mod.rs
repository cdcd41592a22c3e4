//! A plugin: cameras with a [`FragmentBuffer`] store their transparent meshes in it.
//!
//! Input: cameras with the component, meshes with a transparent `StandardMaterial`. Output: the camera's image, with its transparent
//! surfaces resolved by the buffer, and the counters of each frame as diagnostics. `views` prepares a follower per camera, `meshes` takes
//! the camera's transparent meshes from Bevy's phase, `material` changes their pipelines so that they store, `draw` follows the frame,
//! `screen` reads the camera's depth and writes its colours, `losses` reports counters. Nothing here knows a technique.

mod component;
mod draw;
mod losses;
mod material;
mod meshes;
mod screen;
mod views;

use bevy::camera::Camera3d;
use bevy::core_pipeline::core_3d::{Transparent3d, main_transparent_pass_3d};
use bevy::core_pipeline::{Core3d, Core3dSystems};
use bevy::ecs::schedule::ApplyDeferred;
use bevy::prelude::*;
use bevy::render::extract_component::ExtractComponentPlugin;
use bevy::render::render_phase::{AddRenderCommand, sort_phase_system};
use bevy::render::render_resource::TextureUsages;
use bevy::render::{Render, RenderApp, RenderSystems};

pub use component::{FragmentBuffer, FragmentCounters};

/// Adds fragment buffers for cameras to an app, behind `DefaultPlugins`.
pub struct FragmentBufferPlugin;

impl Plugin for FragmentBufferPlugin {
    fn build(&self, app: &mut App) {
        let (reports, received) = losses::channel();
        app.add_plugins(ExtractComponentPlugin::<FragmentBuffer>::default())
            .insert_resource(received)
            .add_systems(PreUpdate, losses::report)
            .add_systems(PostUpdate, make_depth_readable);
        let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
        render
            .insert_resource(reports)
            .init_resource::<views::FollowedViews>()
            .add_render_command::<Transparent3d, meshes::DrawNothing>()
            .add_render_command::<Transparent3d, meshes::DrawStored>()
            .add_systems(
                Render,
                (
                    (views::prepare, meshes::take)
                        .chain()
                        .in_set(RenderSystems::PhaseSort)
                        .before(sort_phase_system::<Transparent3d>),
                    losses::read.in_set(RenderSystems::Cleanup),
                ),
            )
            // Commands of earlier passes are pending only once their systems have been applied.
            .add_systems(
                Core3d,
                (ApplyDeferred, draw::draw).chain().after(main_transparent_pass_3d).in_set(Core3dSystems::MainPass),
            );
    }
}

/// The passes read the depth of opaque surfaces.
fn make_depth_readable(mut cameras: Query<&mut Camera3d, Added<FragmentBuffer>>) {
    for mut camera in &mut cameras {
        camera.depth_texture_usages.0 |= TextureUsages::TEXTURE_BINDING.bits();
    }
}
