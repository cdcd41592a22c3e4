//! Placeholder attachments of passes that write only buffers, because WebGPU rejects a render pass without attachments.

use fragbuf_codegen::{Plan, PlannedPass};
use fragbuf_frame::Values;

use crate::Error;
use crate::error_scope::in_error_scope;
use crate::samples::sample_count;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Returns the target state of passes that write only buffers.
pub(crate) fn placeholder_target() -> wgpu::ColorTargetState {
    wgpu::ColorTargetState { format: FORMAT, blend: None, write_mask: wgpu::ColorWrites::empty() }
}

/// The placeholder attachment of passes with one sample count.
#[derive(Clone)]
pub(crate) struct PlaceholderAttachment {
    /// Samples per pixel.
    samples: u32,
    view: wgpu::TextureView,
}

impl PlaceholderAttachment {
    /// Creates one attachment for every sample count of the plan's passes.
    pub(crate) async fn for_plan(device: &wgpu::Device, plan: &Plan, values: &Values) -> Result<Vec<Self>, Error> {
        let mut placeholders: Vec<Self> = Vec::new();
        for pass in &plan.passes {
            let samples = sample_count(plan, pass)?;
            if placeholders.iter().all(|placeholder| placeholder.samples != samples) {
                let bytes = u64::from(samples) * u64::from(values.width()) * u64::from(values.height());
                let make = || create(device, values, samples);
                let view = in_error_scope(device, "the attachment of geometry passes", bytes, make).await?;
                placeholders.push(PlaceholderAttachment { samples, view });
            }
        }
        Ok(placeholders)
    }

    /// Returns the view for a pass.
    pub(crate) fn view(placeholders: &[Self], plan: &Plan, pass: &PlannedPass) -> Option<wgpu::TextureView> {
        let samples = sample_count(plan, pass).ok()?;
        let placeholder = placeholders.iter().find(|placeholder| placeholder.samples == samples);
        placeholder.map(|placeholder| placeholder.view.clone())
    }
}

/// Returns the bytes per pixel of the attachments of a plan.
pub(crate) fn bytes_per_pixel(plan: &Plan) -> Result<u64, Error> {
    let mut counts: Vec<u32> = plan.passes.iter().map(|pass| sample_count(plan, pass)).collect::<Result<_, _>>()?;
    counts.sort_unstable();
    counts.dedup();
    Ok(counts.into_iter().map(u64::from).sum())
}

/// Creates a transient texture. Nothing is written to it, and tile-based GPUs give it no memory.
fn create(device: &wgpu::Device, values: &Values, samples: u32) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("fragbuf no target"),
        size: wgpu::Extent3d { width: values.width(), height: values.height(), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TRANSIENT_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
