//! The arguments of draws and dispatches: the scene, its visible objects, or indirect arguments in a buffer.
//!
//! Indirect arguments have the layout of WebGPU: workgroups along x, y and z; vertices, instances, first vertex, first
//! instance; indices, instances, first index, base vertex, first instance. Triangles beyond the end of the mesh are skipped.

use std::ops::Range;

use fragbuf_codegen::PlannedPass;
use fragbuf_frame::{Values, resource, unsupported};
use fragbuf_templates::vocabulary::{Access, Kind, Objects, Pass};

use super::Frame;
use crate::Error;
use crate::draw_call::DrawArguments;
use crate::memory::read;

/// The vertices of the triangle that covers the whole frame.
const WHOLE_FRAME: u32 = 3;

/// Returns the arguments of a draw; boxes are drawn elsewhere.
pub(super) fn draw_arguments(frame: &Frame<'_>, pass: &Pass) -> Result<DrawArguments, Error> {
    if let Some(arguments) = indirect_words(frame, pass)? {
        return Ok(decode_arguments(&arguments, pass));
    }
    if pass.kind == Kind::Fullscreen {
        return Ok(DrawArguments::once(WHOLE_FRAME / 3));
    }
    let triangles = (frame.mesh.indices.len() / 3) as u32;
    Ok(match &pass.objects {
        Objects::Visible(query) => {
            let objects = frame.objects(query);
            DrawArguments {
                triangles: objects.into_iter().map(|object| object.start / 3..object.end / 3).collect(),
                ..DrawArguments::once(0)
            }
        }
        _ => DrawArguments::once(triangles),
    })
}

/// Returns the workgroups of a dispatch.
pub(super) fn workgroups(frame: &Frame<'_>, pass: &PlannedPass, values: &Values) -> Result<[u32; 3], Error> {
    let mut counts = [0; 3];
    match indirect_words(frame, pass)? {
        Some(words) => counts.iter_mut().zip(words).for_each(|(count, word)| *count = word),
        None => {
            for (count, groups) in counts.iter_mut().zip(&pass.groups) {
                *count = values.word(groups, "the workgroups of a pass")?;
            }
        }
    }
    Ok(counts)
}

/// Returns the words of the indirect buffer; `None` if the pass has none.
fn indirect_words(frame: &Frame<'_>, pass: &Pass) -> Result<Option<Vec<u32>>, Error> {
    let Some(usage) = pass.uses.iter().find(|usage| usage.access == Access::Indirect) else { return Ok(None) };
    if pass.objects != Objects::All {
        return Err(unsupported(format!("pass `{}`: indirect arguments for several objects", pass.name)).into());
    }
    let words = read(&frame.device.memory.resources[resource(&frame.code.plan, &usage.resource)?.0]);
    let needed = match pass.kind {
        Kind::Compute { .. } => 3,
        Kind::Fullscreen => 4,
        Kind::Geometry => 5,
    };
    if words.len() < needed {
        let what =
            format!("`{}` as indirect arguments: it has {} words, but needs {needed}", usage.resource, words.len());
        return Err(unsupported(what).into());
    }
    Ok(Some(words))
}

fn decode_arguments(words: &[u32], pass: &Pass) -> DrawArguments {
    let from = |first: u32, count: u32| -> Range<u32> { first..first.saturating_add(count) };
    match (&pass.kind, words) {
        (Kind::Geometry, [indices, instances, first, base, first_instance, ..]) => DrawArguments {
            // Triangles begin at multiples of three indices.
            triangles: vec![from(first / 3, indices / 3)],
            // Each draw counts its primitives from 0.
            zero: first / 3,
            base: base.cast_signed(),
            instances: from(*first_instance, *instances),
        },
        (_, [vertices, instances, first, first_instance, ..]) => DrawArguments {
            base: first.cast_signed(),
            instances: from(*first_instance, *instances),
            ..DrawArguments::once(vertices.min(&WHOLE_FRAME) / 3)
        },
        _ => DrawArguments::once(0),
    }
}
