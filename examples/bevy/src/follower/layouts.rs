//! What a pass attaches and binds.
//!
//! Input: a plan. Output: an explicit bind group layout per pass, as the manifest declares it. One layout for all passes would not do: a
//! buffer that a pass reads is read-only there.

use fragbuf_follow::Error;
use fragbuf_follow::manifest::{Binding, BindingKind, Pass, Plan};

use super::{names, scoped};
use crate::TARGET;

/// The names of what a pass attaches.
pub struct Attachments {
    /// The colour targets in the order of their locations.
    pub colors: Vec<String>,
    /// The depth and stencil attachment.
    pub depth: Option<String>,
    /// Whether no test writes depth or stencil.
    pub is_read_only: bool,
}

/// The bindings of a pass.
pub struct PassLayout {
    /// The number of the bind group.
    pub group: u32,
    /// The entries in the order of `bindings`.
    pub entries: Vec<wgpu::BindGroupLayoutEntry>,
    /// The layout of these entries.
    pub layout: wgpu::BindGroupLayout,
    /// The bindings that the text declares.
    pub bindings: Vec<Binding>,
}

impl Attachments {
    /// Returns the attachments of a pass: targets, tested depth, and what else it uses as an attachment.
    pub fn of(plan: &Plan, pass: &Pass) -> Self {
        let mut colors: Vec<String> = pass.state.targets.iter().map(|target| target.resource.clone()).collect();
        let is_depth = |name: &&String| {
            let texture = plan.resource(name).and_then(|resource| resource.texture.as_ref());
            texture.is_some_and(|texture| texture.format.starts_with("depth"))
        };
        let attached = || pass.uses.iter().filter(|(_, access)| *access == "attachment").map(|(name, _)| name);
        let tested = pass.state.depth.as_ref().map(|depth| &depth.resource);
        let tested = tested.or(pass.state.stencil.as_ref().map(|stencil| &stencil.resource));
        let depth = tested.or_else(|| attached().find(is_depth)).cloned();
        let others: Vec<String> =
            attached().filter(|name| !colors.contains(name) && depth.as_ref() != Some(name)).cloned().collect();
        colors.extend(others);
        let is_read_only = pass.state.stencil.is_none() && pass.state.depth.as_ref().is_none_or(|depth| !depth.write);
        Attachments { colors, depth, is_read_only }
    }

    /// Whether nothing is attached.
    pub fn is_empty(&self) -> bool {
        self.colors.is_empty() && self.depth.is_none()
    }
}

/// Returns the formula for the samples per pixel of a pass: that of its state, or of what it attaches.
pub fn sample_formula<'a>(plan: &'a Plan, pass: &'a Pass) -> &'a str {
    let attachments = Attachments::of(plan, pass);
    let names = attachments.colors.iter().chain(&attachments.depth).filter(|name| *name != "output");
    let mut textures = names.filter_map(|name| plan.resource(name)?.texture.as_ref());
    let stated = pass.state.samples.as_ref().map(|samples| samples.count.as_str());
    stated.or(textures.next().map(|texture| texture.samples.as_str())).unwrap_or("1")
}

/// Creates the layout of every pass, by the index of its step.
pub fn create(device: &wgpu::Device, plan: &Plan) -> Result<Vec<Option<PassLayout>>, Error> {
    let mut layouts: Vec<Option<PassLayout>> = plan.steps.iter().map(|_| None).collect();
    for (step, pass) in plan.passes() {
        let bindings = pass.bindings(TARGET).to_vec();
        let entries = bindings.iter().map(|binding| entry(plan, binding)).collect::<Result<Vec<_>, Error>>()?;
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(&pass.name), entries: &entries };
        let what = format!("the bindings of the pass `{}`", pass.name);
        let layout = scoped(device, &what, || device.create_bind_group_layout(&descriptor))?;
        let group = bindings.first().map_or(0, |binding| binding.group);
        layouts[step] = Some(PassLayout { group, entries, layout, bindings });
    }
    Ok(layouts)
}

fn entry(plan: &Plan, binding: &Binding) -> Result<wgpu::BindGroupLayoutEntry, Error> {
    let block = plan.uniform_blocks.iter().find(|block| block.name == binding.name);
    let size = block.and_then(|block| std::num::NonZeroU64::new(block.bytes as u64));
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: size };
    let ty = match binding.kind {
        BindingKind::Uniform => buffer(wgpu::BufferBindingType::Uniform),
        BindingKind::Storage => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
        BindingKind::ReadOnlyStorage => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
        BindingKind::Texture => wgpu::BindingType::Texture {
            sample_type: names::sample_type(binding.sample_type.as_deref().unwrap_or("float"))?,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: binding.multisampled,
        },
    };
    Ok(wgpu::BindGroupLayoutEntry {
        binding: binding.binding,
        visibility: names::stages(&binding.stages)?,
        ty,
        count: None,
    })
}
