//! Emits Metal with naga. The Metal index of a buffer or texture is its binding number. naga needs one more buffer
//! with the sizes of all others.

use naga::back::msl;

use crate::emission::{Emission, File, Guards};

/// The index of the buffer of sizes, the last that Metal guarantees.
const SIZES: u8 = 30;

pub(crate) fn emit(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    let options = msl::Options {
        lang_version: (2, 4),
        per_entry_point_map: resources(emission.checked.module())?,
        fake_missing_bindings: false,
        bounds_check_policies: emission.guards.policies(),
        zero_initialize_workgroup_memory: false,
        force_loop_bounding: emission.guards == Guards::On,
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions::default();
    let (text, info) = msl::write_string(emission.checked.module(), emission.checked.info(), &options, &pipeline)
        .map_err(|error| error.to_string())?;
    for name in info.entry_point_names {
        name.map_err(|error| error.to_string())?;
    }
    Ok(vec![emission.whole(".metal", (emission.header() + &text).into_bytes())])
}

fn resources(module: &naga::Module) -> Result<msl::EntryPointResourceMap, String> {
    let mut bindings = msl::BindingMap::default();
    for (_, variable) in module.global_variables.iter() {
        let Some(binding) = variable.binding else { continue };
        let slot = u8::try_from(binding.binding).map_err(|_| format!("binding {} is beyond 255", binding.binding))?;
        let is_texture = matches!(module.types[variable.ty].inner, naga::TypeInner::Image { .. });
        // Textures have indices of their own.
        if slot >= SIZES && !is_texture {
            return Err(format!("binding {slot} is not below {SIZES}, the buffer of sizes"));
        }
        let read_only = matches!(variable.space, naga::AddressSpace::Uniform)
            || matches!(variable.space, naga::AddressSpace::Storage { access } if !access.contains(naga::StorageAccess::STORE));
        let target = match is_texture {
            true => msl::BindTarget { texture: Some(slot), ..msl::BindTarget::default() },
            false => msl::BindTarget { buffer: Some(slot), mutable: !read_only, ..msl::BindTarget::default() },
        };
        bindings.insert(binding, target);
    }
    let entry = msl::EntryPointResources { resources: bindings, immediates_buffer: None, sizes_buffer: Some(SIZES) };
    Ok(module.entry_points.iter().map(|point| (point.name.clone(), entry.clone())).collect())
}
