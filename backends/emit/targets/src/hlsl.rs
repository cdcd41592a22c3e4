//! HLSL by naga, with fences in place of their markers. Register space is the bind group, register the binding.

use naga::back::hlsl;

use crate::markers::with_fences;
use crate::target::{Emission, File, Guards};

pub(crate) fn emit(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    let module = with_fences(emission.checked.module(), emission.prefix);
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        zero_initialize_workgroup_memory: false,
        restrict_indexing: emission.guards == Guards::On,
        force_loop_bounding: emission.guards == Guards::On,
        ..hlsl::Options::default()
    };
    let mut text = header(emission);
    let pipeline = hlsl::PipelineOptions::default();
    let mut writer = hlsl::Writer::new(&mut text, &options, &pipeline);
    let reflection = writer.write(&module, emission.checked.info(), None).map_err(|error| error.to_string())?;
    for name in reflection.entry_point_names {
        name.map_err(|error| error.to_string())?;
    }
    Ok(vec![emission.whole(".hlsl", text.into_bytes())])
}

/// Technique, generator, choices and algorithms, as comments.
pub(crate) fn header(emission: &Emission<'_>) -> String {
    let notes = &emission.checked.pass().notes;
    let lines = format!("{}\n{}", notes.generated, notes.algorithms);
    let commented: String = lines.lines().map(|line| format!("// {line}").trim_end().to_owned() + "\n").collect();
    commented + "\n"
}
