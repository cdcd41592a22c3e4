//! Emits SPIR-V with naga, one module per entry point, and replaces markers by instructions that WGSL cannot express.
//!
//! Clip space is WGSL's (y up, z from 0 to 1), as in wgpu: a Vulkan host sets a viewport of negative height. Indices are
//! clamped and loops bounded at run time only if a user file is part of the program.

mod edits;
mod initial;
mod sample_mask;

use naga::back::spv;

use crate::emission::{Emission, File, Guards, stage_name, stage_of, stage_suffix};
use crate::markers::with_fences;

pub(crate) fn emit(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    let pass = emission.checked.pass();
    let module = with_fences(emission.checked.module(), emission.prefix);
    let options = options(emission.guards);
    let mut files = Vec::with_capacity(pass.entry_points.len());
    for entry in &pass.entry_points {
        let pipeline = spv::PipelineOptions { shader_stage: stage_of(entry.stage), entry_point: entry.name.clone() };
        let words = spv::write_vec(&module, emission.checked.info(), &options, Some(&pipeline))
            .map_err(|error| error.to_string())?;
        // Parsing the words costs more than writing them.
        let words = match edits::may_apply(&module, &entry.name, emission.prefix, &pass.guarded) {
            true => edits::apply(words, emission.prefix, emission.interlock, &pass.guarded)?,
            false => words,
        };
        let words = initial::without(words, &pass.written_first);
        let bytes = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let path = emission.path(&format!(".{}.spv", stage_suffix(entry.stage)));
        files.push(emission.file(path, vec![(stage_name(entry.stage), entry.name.clone())], bytes));
    }
    Ok(files)
}

/// Returns naga's options. Every option that affects the output is set: naga's defaults differ between builds.
fn options(guards: Guards) -> spv::Options<'static> {
    spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::DEBUG | spv::WriterFlags::LABEL_VARYINGS,
        bounds_check_policies: guards.policies(),
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        force_loop_bounding: guards == Guards::On,
        ..spv::Options::default()
    }
}
