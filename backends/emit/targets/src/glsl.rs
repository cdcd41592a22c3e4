//! Emits GLSL with `fragbuf-glsl`, one file per entry point. A module is one file without `main`.

use fragbuf_glsl::{Dialect, Marker, Options, Slot, Unit, print};

use crate::emission::{Emission, File, InterlockOrder, stage_name, stage_suffix};
use crate::markers::{CRITICAL_BEGIN, CRITICAL_END, HELPER_LANE, MEMORY_FENCE};

/// The functions of `templates/shared/markers.wgsl` and the marker that each stands for.
const MARKERS: [(&str, Marker); 3] =
    [(MEMORY_FENCE, Marker::MemoryFence), (HELPER_LANE, Marker::HelperLane), (CRITICAL_END, Marker::CriticalEnd)];

pub(crate) fn emit_opengl(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    emit(emission, Dialect::OpenGl450)
}

pub(crate) fn emit_vulkan(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    emit(emission, Dialect::Vulkan450)
}

pub(crate) fn emit_es(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    emit(emission, Dialect::Es310)
}

fn emit(emission: &Emission<'_>, dialect: Dialect) -> Result<Vec<File>, String> {
    let pass = emission.checked.pass();
    if !pass.exports.is_empty() {
        let text = printed(emission, dialect, Unit::Library)?;
        return Ok(vec![emission.whole(".glsl", text.into_bytes())]);
    }
    let mut files = Vec::with_capacity(pass.entry_points.len());
    for entry in &pass.entry_points {
        let text = printed(emission, dialect, Unit::EntryPoint(&entry.name))?;
        let path = emission.path(&format!(".{}.glsl", stage_suffix(entry.stage)));
        files.push(emission.file(path, vec![(stage_name(entry.stage), "main".to_owned())], text.into_bytes()));
    }
    Ok(files)
}

fn printed(emission: &Emission<'_>, dialect: Dialect, unit: Unit<'_>) -> Result<String, String> {
    let checked = emission.checked;
    let source = &checked.pass().text;
    let begin = match emission.interlock {
        InterlockOrder::Any => Marker::CriticalBegin,
        InterlockOrder::Submission => Marker::OrderedCriticalBegin,
    };
    let markers = MARKERS.into_iter().chain([(CRITICAL_BEGIN, begin)]);
    let markers: Vec<(String, Marker)> =
        markers.map(|(name, marker)| (format!("{}{name}", emission.prefix), marker)).collect();
    let markers: Vec<(&str, Marker)> = markers.iter().map(|(name, marker)| (name.as_str(), *marker)).collect();
    let plain_loads: Vec<&str> = emission.rechecked.iter().map(String::as_str).collect();
    let guarded: Vec<&str> = checked.pass().guarded.iter().map(String::as_str).collect();
    let written_first: Vec<&str> = checked.pass().written_first.iter().map(String::as_str).collect();
    let notes = &checked.pass().notes;
    let header = match unit {
        Unit::EntryPoint(name) if is_vertex(emission, name) => notes.generated.clone(),
        _ => format!("{}\n{}", notes.generated, notes.algorithms),
    };
    let options = Options {
        dialect,
        header: &header,
        markers: &markers,
        bindings: &|group, binding| match dialect {
            Dialect::Vulkan450 => Slot { set: group, binding },
            Dialect::OpenGl450 | Dialect::Es310 => {
                // Every pass lists what its text declares, and what a pass lists has a point.
                Slot { set: 0, binding: emission.opengl.point(binding).unwrap_or(binding) }
            }
        },
        plain_loads: &plain_loads,
        plain_functions: &guarded,
        written_first: &written_first,
        // Templates write workgroup variables before they read them.
        zero_workgroup_memory: false,
    };
    print(checked.module(), checked.info(), source, unit, &options).map_err(|errors| {
        let lines: Vec<String> = errors
            .iter()
            .map(|error| format!("line {}: {}", error.span.location(source).line_number, error.message))
            .collect();
        lines.join("; ")
    })
}

/// Tests whether an entry point is a vertex stage, whose file lists no algorithms.
fn is_vertex(emission: &Emission<'_>, name: &str) -> bool {
    let mut entries = emission.checked.pass().entry_points.iter();
    entries.any(|entry| entry.name == name && entry.stage == fragbuf_codegen::Stage::Vertex)
}
