//! Shader modules and layouts of a pass, from the files and bindings that the manifest lists for it.

use std::collections::BTreeMap;
use std::ffi::CString;
use std::rc::Rc;

use ash::vk;
use fragbuf_follow::manifest::{Binding, BindingKind, File, Pass};

use crate::context::failed;
use crate::gpu::Gpu;
use crate::names::stage;
use crate::{Error, TARGET};

/// The first word of every SPIR-V module.
const MAGIC: u32 = 0x0723_0203;

/// What a pass has before its state is known: modules, and the layout of its descriptors.
pub struct Shaders {
    gpu: Rc<Gpu>,
    pub stages: Vec<Stage>,
    /// The layouts of the descriptor sets from 0 on. Those without bindings are empty.
    pub sets: Vec<vk::DescriptorSetLayout>,
    pub layout: vk::PipelineLayout,
    pub bindings: Vec<Binding>,
}

/// An entry point.
pub struct Stage {
    pub stage: vk::ShaderStageFlags,
    pub module: vk::ShaderModule,
    pub entry_point: CString,
}

impl Shaders {
    /// Loads the files of a pass. `read` returns the bytes of a file.
    pub fn new(
        gpu: &Rc<Gpu>,
        pass: &Pass,
        files: &[File],
        read: &dyn Fn(&str) -> Result<Vec<u8>, Error>,
    ) -> Result<Self, Error> {
        let (sets, layout) = (Vec::new(), vk::PipelineLayout::null());
        let bindings = pass.bindings(TARGET).to_vec();
        // Dropping it destroys what has been created.
        let mut shaders = Shaders { gpu: gpu.clone(), stages: Vec::new(), sets, layout, bindings };
        for file in files.iter().filter(|file| file.pass == pass.name) {
            shaders.stages.push(load(gpu, file, read)?);
        }
        if shaders.stages.is_empty() {
            return Err(Error(format!("the manifest has no files of the pass `{}`: generate it again", pass.name)));
        }
        shaders.create_layout(&pass.name)?;
        Ok(shaders)
    }

    fn create_layout(&mut self, pass: &str) -> Result<(), Error> {
        let mut groups: BTreeMap<u32, Vec<vk::DescriptorSetLayoutBinding<'_>>> = BTreeMap::new();
        for binding in &self.bindings {
            let stages = binding.stages.iter().map(|name| stage(name)).collect::<Result<Vec<_>, Error>>()?;
            let entry = vk::DescriptorSetLayoutBinding::default()
                .binding(binding.binding)
                .descriptor_type(descriptor_type(binding.kind))
                .descriptor_count(1)
                .stage_flags(stages.into_iter().fold(vk::ShaderStageFlags::empty(), |all, stage| all | stage));
            groups.entry(binding.group).or_default().push(entry);
        }
        let count = groups.keys().next_back().map_or(0, |last| last.saturating_add(1));
        let device = &self.gpu.device;
        if count > self.gpu.limits.max_bound_descriptor_sets {
            return Err(Error(format!("pass `{pass}`: the device has no descriptor set {}", count - 1)));
        }
        for group in 0..count {
            let entries = groups.remove(&group).unwrap_or_default();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&entries);
            // SAFETY: the device exists.
            let set = unsafe { device.create_descriptor_set_layout(&info, None) };
            self.sets.push(set.map_err(failed("a descriptor set layout"))?);
        }
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&self.sets);
        // SAFETY: the device exists.
        self.layout = unsafe { device.create_pipeline_layout(&info, None) }.map_err(failed("a pipeline layout"))?;
        Ok(())
    }
}

impl Drop for Shaders {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: the host has waited for all commands.
        unsafe {
            device.destroy_pipeline_layout(self.layout, None);
            self.sets.iter().for_each(|set| device.destroy_descriptor_set_layout(*set, None));
            self.stages.iter().for_each(|stage| device.destroy_shader_module(stage.module, None));
        }
    }
}

fn load(gpu: &Gpu, file: &File, read: &dyn Fn(&str) -> Result<Vec<u8>, Error>) -> Result<Stage, Error> {
    let failed_with = |problem: &dyn std::fmt::Display| Error(format!("{}: {problem}", file.path));
    let stage = stage(&file.stage).map_err(|error| failed_with(&error))?;
    let entry_point = CString::new(file.entry_point.as_str()).map_err(|error| failed_with(&error))?;
    let bytes = read(&file.path)?;
    let words = ash::util::read_spv(&mut std::io::Cursor::new(bytes));
    let words = words.map_err(|error| failed_with(&format!("this is no SPIR-V: {error}")))?;
    if words.first() != Some(&MAGIC) {
        return Err(failed_with(&"this is no SPIR-V: its first word is another"));
    }
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: the device has the features that the manifest requires for these files. Only the validation layer
    // checks their words.
    let module = unsafe { gpu.device.create_shader_module(&info, None) };
    let module = module.map_err(failed(&file.path))?;
    Ok(Stage { stage, module, entry_point })
}

/// Returns the type of a descriptor.
pub fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::Storage | BindingKind::ReadOnlyStorage => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::Texture => vk::DescriptorType::SAMPLED_IMAGE,
    }
}
