//! The followers of cameras.
//!
//! Input: cameras with a `FragmentBuffer`. Output: a follower per camera for the size of its target, the passes that draw meshes, and the
//! pipelines of these. What fails is logged once, and the camera draws as if it had no buffer until the component or the size changes.

use std::collections::BTreeMap;
use std::sync::Arc;

use bevy::asset::AssetServer;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::render_resource::{CachedRenderPipelineId, PipelineCache};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::view::{ExtractedView, RetainedViewEntity};
use fragbuf_follow::Error;
use fragbuf_follow::manifest::Objects;

use super::FragmentBuffer;
use super::material::{IMAGE_FORMAT, StorePass, store_passes};
use super::screen::Screen;
use crate::follower::texture_bytes;
use crate::{Follower, Gpu, Passes};

/// The name of the external texture with the depth of opaque surfaces.
pub const OPAQUE: &str = "opaque";

/// The followers of all cameras.
#[derive(Resource, Default)]
pub struct FollowedViews {
    views: HashMap<RetainedViewEntity, View>,
    /// What reads the depth and writes the colours of cameras.
    pub screen: Screen,
}

struct View {
    passes: Arc<Passes>,
    size: [u32; 2],
    /// `None`: it failed.
    followed: Option<FollowedView>,
}

/// A camera whose buffer is ready.
pub struct FollowedView {
    /// What follows the manifest.
    pub follower: Follower,
    /// The passes that draw meshes.
    pub stores: Vec<StorePass>,
    /// The image that the passes resolve into.
    pub image: wgpu::Texture,
    /// The depth of opaque surfaces, if the passes read it.
    pub opaque: Option<wgpu::Texture>,
    /// The pipelines that store, by the pipeline that Bevy would blend with and the index of the step.
    pipelines: BTreeMap<(usize, usize), CachedRenderPipelineId>,
}

/// Prepares the follower of every camera that has a buffer, and drops those of other cameras.
pub fn prepare(
    cameras: Query<(&ExtractedCamera, &ExtractedView, &FragmentBuffer)>,
    mut followed: ResMut<FollowedViews>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
    assets: Res<AssetServer>,
) {
    let views = &mut followed.views;
    views.retain(|view, _| cameras.iter().any(|(_, camera, _)| camera.retained_view_entity == *view));
    for (camera, view, buffer) in &cameras {
        let Some(size) = camera.physical_target_size.map(|size| size.to_array()) else { continue };
        let key = view.retained_view_entity;
        let is_present =
            views.get(&key).is_some_and(|view| Arc::ptr_eq(&view.passes, &buffer.passes) && view.size == size);
        if !is_present {
            let gpu = Gpu { device: device.wgpu_device().clone(), queue: (**queue.0).clone() };
            let followed = logged(FollowedView::new(&gpu, buffer, size, &assets), buffer);
            views.insert(key, View { passes: buffer.passes.clone(), size, followed });
        }
        if let Some(view) = views.get_mut(&key)
            && let Some(followed) = &mut view.followed
            && logged(followed.set(buffer, size), buffer).is_none()
        {
            view.followed = None;
        }
    }
}

/// Logs an error.
fn logged<T>(result: Result<T, Error>, buffer: &FragmentBuffer) -> Option<T> {
    result.map_err(|error| error!("the fragment buffer `{}` is not drawn: {error}", buffer.passes.name)).ok()
}

impl FollowedViews {
    /// Returns the follower of a camera, if it is ready.
    pub fn ready(&mut self, view: &RetainedViewEntity) -> Option<&mut FollowedView> {
        self.views.get_mut(view)?.followed.as_mut()
    }

    /// Logs an error of a camera, which draws without its buffer from now on.
    pub fn fail(&mut self, view: &RetainedViewEntity, error: &Error) {
        if let Some(view) = self.views.get_mut(view) {
            error!("the fragment buffer `{}` is not drawn: {error}", view.passes.name);
            view.followed = None;
        }
    }
}

impl FollowedView {
    fn new(gpu: &Gpu, buffer: &FragmentBuffer, size: [u32; 2], assets: &AssetServer) -> Result<Self, Error> {
        let limits = gpu.device.limits();
        if limits.max_bind_groups as usize <= super::material::MATERIAL_GROUP {
            return Err(Error(format!(
                "`maxBindGroups` is {}: Bevy's meshes and the buffer need 5",
                limits.max_bind_groups
            )));
        }
        let mut follower = Follower::new(gpu, &buffer.passes, size, IMAGE_FORMAT)?;
        if let Some((_, pass)) = follower.plan().passes().find(|(_, pass)| !matches!(pass.objects, Objects::All)) {
            return Err(Error(format!("the pass `{}` draws boxes of objects: choose `objects: all`", pass.name)));
        }
        let opaque = match follower.external_textures().find(|name| *name != OPAQUE) {
            Some(name) => return Err(Error(format!("the plugin has no texture `{name}`: it has `{OPAQUE}`"))),
            None if follower.external_textures().next().is_none() => None,
            None => Some(gpu.device.create_texture(&follower.texture_descriptor(OPAQUE)?)),
        };
        if let Some(texture) = &opaque {
            follower.set_texture(OPAQUE, texture)?;
        }
        let stores = store_passes(&follower, &buffer.passes, assets)?;
        let [width, height] = size;
        let image = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("resolved fragments"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: IMAGE_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Ok(FollowedView { follower, stores, image, opaque, pipelines: BTreeMap::new() })
    }

    /// Sets what may change from frame to frame.
    fn set(&mut self, buffer: &FragmentBuffer, [width, height]: [u32; 2]) -> Result<(), Error> {
        let fragments = (f64::from(width) * f64::from(height) * f64::from(buffer.fragments_per_pixel)).max(1.0) as u64;
        let pools =
            self.follower.plan().symbols.iter().filter(|symbol| symbol.when == "readback" && symbol.value.is_none());
        let pools: Vec<(String, u64)> = pools
            .filter(|symbol| symbol.default.is_none())
            .map(|symbol| (symbol.name.clone(), fragments.clamp(symbol.least, symbol.most)))
            .collect();
        for (name, value) in &pools {
            self.follower.set_symbol(name, *value)?;
        }
        buffer.symbols.iter().try_for_each(|(name, value)| self.follower.set_symbol(name, *value))?;
        buffer.uniforms.iter().try_for_each(|(name, bytes)| self.follower.set_uniform(name, bytes))
    }

    /// The bytes of the buffers and textures of the plan, of the resolved image and of the copied depth.
    pub fn bytes(&self) -> u64 {
        let textures = [Some(&self.image), self.opaque.as_ref()];
        self.follower.bytes() + textures.into_iter().flatten().map(texture_bytes).sum::<u64>()
    }

    /// Creates the pipelines that store what a pipeline of Bevy would blend.
    pub fn specialize(&mut self, blended: CachedRenderPipelineId, cache: &PipelineCache) {
        for store in &self.stores {
            self.pipelines.entry((blended.id(), store.step)).or_insert_with(|| {
                cache.queue_render_pipeline(store.pipeline(cache.get_render_pipeline_descriptor(blended)))
            });
        }
    }

    /// Returns the pipeline that stores in a pass what a pipeline of Bevy would blend.
    pub fn pipeline(&self, blended: CachedRenderPipelineId, step: usize) -> Option<CachedRenderPipelineId> {
        self.pipelines.get(&(blended.id(), step)).copied()
    }
}
