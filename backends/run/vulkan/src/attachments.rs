//! What a pass attaches, and its render pass. A render pass loads and stores every attachment, and waits for nothing:
//! barriers are recorded before it.

use std::rc::Rc;

use ash::vk;
use fragbuf_follow::manifest::{Pass, Plan};

use crate::access::Access;
use crate::context::failed;
use crate::gpu::Gpu;
use crate::names::is_depth;
use crate::{Error, OUTPUT};

/// The names of what a pass attaches.
pub struct Attachments {
    /// The colour targets in the order of their locations.
    pub colors: Vec<String>,
    pub depth: Option<String>,
    /// Whether no test writes depth or stencil.
    pub is_read_only: bool,
}

const COLOR: Access = Access::new(
    vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
    vk::AccessFlags::from_raw(
        vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw() | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
    vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
);

impl Attachments {
    /// Returns the attachments of a pass.
    pub fn of(plan: &Plan, pass: &Pass) -> Self {
        let colors: Vec<String> = pass.state.targets.iter().map(|target| target.resource.clone()).collect();
        let is_depth = |name: &&String| {
            let texture = plan.resource(name).and_then(|resource| resource.texture.as_ref());
            texture.is_some_and(|texture| texture.format.starts_with("depth"))
        };
        let mut attached = pass.uses.iter().filter(|(_, access)| *access == "attachment").map(|(name, _)| name);
        let tested = pass.state.depth.as_ref().map(|depth| &depth.resource);
        let tested = tested.or(pass.state.stencil.as_ref().map(|stencil| &stencil.resource));
        let depth = tested.or_else(|| attached.find(is_depth)).cloned();
        let is_read_only = pass.state.stencil.is_none() && pass.state.depth.as_ref().is_none_or(|depth| !depth.write);
        Attachments { colors, depth, is_read_only }
    }

    /// Returns all names: colours, then depth.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.colors.iter().chain(&self.depth).map(String::as_str)
    }

    /// Returns the access to an attachment of this name.
    pub fn access(&self, name: &str) -> Access {
        if self.depth.as_deref() != Some(name) {
            return COLOR;
        }
        let stages = vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS;
        // The store operation counts as a write, also of a layout that is read-only.
        let access = vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE;
        let layout = match self.is_read_only {
            true => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
            false => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        };
        Access::new(stages, access, layout)
    }
}

/// Returns the formula for the samples per pixel of a pass: that of its state, or of what it attaches.
pub fn sample_formula<'a>(plan: &'a Plan, pass: &'a Pass, attachments: &Attachments) -> &'a str {
    let texture = |name: &str| plan.resource(name).filter(|_| name != OUTPUT)?.texture.as_ref();
    let attached = attachments.names().find_map(texture).map(|texture| texture.samples.as_str());
    let stated = pass.state.samples.as_ref().map(|samples| samples.count.as_str());
    stated.or(attached).unwrap_or("1")
}

/// Creates the render pass of attachments with these formats.
pub fn render_pass(
    gpu: &Rc<Gpu>,
    attachments: &Attachments,
    formats: &[vk::Format],
    samples: vk::SampleCountFlags,
) -> Result<vk::RenderPass, Error> {
    let described = attachments.names().zip(formats).map(|(name, format)| {
        let layout = attachments.access(name).layout;
        vk::AttachmentDescription::default()
            .format(*format)
            .samples(samples)
            .load_op(vk::AttachmentLoadOp::LOAD)
            .store_op(vk::AttachmentStoreOp::STORE)
            .stencil_load_op(vk::AttachmentLoadOp::LOAD)
            .stencil_store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(layout)
            .final_layout(layout)
    });
    let described: Vec<_> = described.collect();
    let reference = |(index, name): (u32, &str)| {
        vk::AttachmentReference::default().attachment(index).layout(attachments.access(name).layout)
    };
    let references: Vec<_> = (0..).zip(attachments.names()).map(reference).collect();
    let (colors, depth) = references.split_at(attachments.colors.len());
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(colors);
    if let Some(depth) = depth.first() {
        subpass = subpass.depth_stencil_attachment(depth);
    }
    debug_assert!(formats.iter().filter(|format| is_depth(**format)).count() <= 1);
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default().attachments(&described).subpasses(&subpasses);
    // SAFETY: what `info` points to lives until the end of the call.
    unsafe { gpu.device.create_render_pass(&info, None) }.map_err(failed("a render pass"))
}
