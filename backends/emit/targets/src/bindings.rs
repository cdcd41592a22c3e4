//! The blocks, buffers and textures that the text of a pass declares, for each of its stages.
//!
//! Input: a checked pass. Output: one [`Binding`] per variable that a stage accesses, with what a bind group layout must know. It is read
//! from naga's module, from which every target's text is printed, not from the plan: a plan lists what a pass may use.

use fragbuf_codegen::Stage;
use fragbuf_templates::vocabulary::TextureDimension;
use naga::{AddressSpace, Handle, ImageClass, ImageDimension, ScalarKind, ShaderStage, StorageAccess, TypeInner};

use crate::Checked;

/// A block, buffer or texture that the text of a pass declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Its number in the bind group of the plan.
    pub binding: u32,
    /// The stages that access it.
    pub stages: Vec<Stage>,
    /// Its type.
    pub kind: BindingKind,
}

/// The type of a binding, in the terms of WebGPU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A uniform block.
    Uniform,
    /// A storage buffer.
    Storage {
        /// Whether the text only reads it.
        read_only: bool,
        /// The least size in bytes that can be bound: that of the block with one element of its array.
        least_bytes: u32,
    },
    /// A texture that is read texel by texel.
    Texture {
        /// What a shader reads.
        sample_type: SampleType,
        /// Its dimension.
        dimension: TextureDimension,
        /// Whether it has several samples per pixel.
        multisampled: bool,
    },
    /// A texture that the shader writes.
    StorageTexture {
        /// `write-only`, `read-only` or `read-write`.
        access: &'static str,
        /// The format in WebGPU.
        format: String,
    },
}

/// What a shader reads of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleType {
    /// Floats. Whether the format can be filtered is decided by the format.
    Float,
    /// Unsigned numbers.
    Uint,
    /// Signed numbers.
    Sint,
    /// Depth.
    Depth,
}

impl Checked {
    /// Returns what the text of the pass declares, by number. In module form the function that the caller's shader calls belongs to a
    /// fragment stage.
    pub fn bindings(&self) -> Result<Vec<Binding>, String> {
        let mut bindings = Vec::new();
        for (handle, global) in self.module().global_variables.iter() {
            let Some(binding) = &global.binding else { continue };
            let stages = self.stages(handle);
            if stages.is_empty() {
                continue;
            }
            let kind = self.kind(global).ok_or_else(|| {
                format!("`{}` has a type that no layout describes", global.name.as_deref().unwrap_or_default())
            })?;
            bindings.push(Binding { binding: binding.binding, stages, kind });
        }
        bindings.sort_by_key(|binding| binding.binding);
        Ok(bindings)
    }

    /// Returns the stages that access a variable, each once.
    fn stages(&self, global: Handle<naga::GlobalVariable>) -> Vec<Stage> {
        let (module, info) = (self.module(), self.info());
        let entries = module.entry_points.iter().enumerate();
        let mut stages: Vec<Stage> = entries
            .filter(|(index, _)| !info.get_entry_point(*index)[global].is_empty())
            .filter_map(|(_, entry)| stage(entry.stage))
            .collect();
        let is_export = |function: &naga::Function| {
            let exports = &self.pass().exports;
            function.name.as_ref().is_some_and(|name| exports.contains(name))
        };
        let mut functions = module.functions.iter();
        if functions.any(|(handle, function)| is_export(function) && !info[handle][global].is_empty()) {
            stages.push(Stage::Fragment);
        }
        stages.dedup();
        stages
    }

    fn kind(&self, global: &naga::GlobalVariable) -> Option<BindingKind> {
        let module = self.module();
        let inner = &module.types[global.ty].inner;
        match (global.space, inner) {
            (AddressSpace::Uniform, _) => Some(BindingKind::Uniform),
            (AddressSpace::Storage { access }, _) => Some(BindingKind::Storage {
                read_only: !access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC),
                least_bytes: inner.size(module.to_ctx()),
            }),
            (_, TypeInner::Image { dim: ImageDimension::D2, arrayed: false, class }) => {
                image(*class, TextureDimension::D2)
            }
            (_, TypeInner::Image { dim: ImageDimension::D3, arrayed: false, class }) => {
                image(*class, TextureDimension::D3)
            }
            _ => None,
        }
    }
}

fn image(class: ImageClass, dimension: TextureDimension) -> Option<BindingKind> {
    let (sample_type, multisampled) = match class {
        ImageClass::Depth { multi } => (SampleType::Depth, multi),
        ImageClass::Sampled { kind: ScalarKind::Float, multi } => (SampleType::Float, multi),
        ImageClass::Sampled { kind: ScalarKind::Uint, multi } => (SampleType::Uint, multi),
        ImageClass::Sampled { kind: ScalarKind::Sint, multi } => (SampleType::Sint, multi),
        ImageClass::Storage { format, access } => {
            let access = match (access.contains(StorageAccess::LOAD), access.contains(StorageAccess::STORE)) {
                (true, true) => "read-write",
                (true, false) => "read-only",
                (false, _) => "write-only",
            };
            // WebGPU's names of formats are naga's in lower case.
            return Some(BindingKind::StorageTexture { access, format: format!("{format:?}").to_lowercase() });
        }
        ImageClass::Sampled { .. } | ImageClass::External => return None,
    };
    Some(BindingKind::Texture { sample_type, dimension, multisampled })
}

fn stage(stage: ShaderStage) -> Option<Stage> {
    match stage {
        ShaderStage::Vertex => Some(Stage::Vertex),
        ShaderStage::Fragment => Some(Stage::Fragment),
        ShaderStage::Compute => Some(Stage::Compute),
        _ => None,
    }
}
