//! Emits HLSL with naga, with fences in place of their markers. The register space is the bind group, the register is the binding.

use naga::back::hlsl;

use crate::emission::{Emission, File, Guards};
use crate::markers::with_fences;

pub(crate) fn emit(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    let module = with_fences(emission.checked.module(), emission.prefix);
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        zero_initialize_workgroup_memory: false,
        restrict_indexing: emission.guards == Guards::On,
        force_loop_bounding: emission.guards == Guards::On,
        ..hlsl::Options::default()
    };
    let mut text = emission.header();
    let pipeline = hlsl::PipelineOptions::default();
    let mut writer = hlsl::Writer::new(&mut text, &options, &pipeline);
    let reflection = writer.write(&module, emission.checked.info(), None).map_err(|error| error.to_string())?;
    for name in reflection.entry_point_names {
        name.map_err(|error| error.to_string())?;
    }
    Ok(vec![emission.whole(".hlsl", text.into_bytes())])
}
