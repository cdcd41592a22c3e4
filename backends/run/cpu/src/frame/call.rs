//! What a pass draws or dispatches: the scene, its visible objects, or what arguments in a buffer say.
//!
//! In: a pass, the mesh, words of a buffer. Out: parts of the index list, or numbers of workgroups. Arguments are laid out as WebGPU
//! has them: workgroups along x, y and z; vertices, instances, first vertex, first instance; indices, instances, first index,
//! base vertex, first instance. What they say beyond the end of the mesh is left out.

use std::ops::Range;

use fragbuf_codegen::PlannedPass;
use fragbuf_frame::{Values, resource, unsupported};
use fragbuf_templates::vocabulary::{Access, Kind, Objects, Pass};

use super::Frame;
use crate::Error;
use crate::draw::Call;
use crate::memory::read;

/// Vertices of the triangle over the whole frame.
const WHOLE_FRAME: u32 = 3;

/// What a pass that is no dispatch draws, boxes apart.
pub(super) fn call(frame: &Frame<'_>, pass: &Pass) -> Result<Call, Error> {
    if let Some(arguments) = arguments(frame, pass)? {
        return Ok(drawn_by(&arguments, pass));
    }
    if pass.kind == Kind::Fullscreen {
        return Ok(Call::once(WHOLE_FRAME / 3));
    }
    let triangles = (frame.mesh.indices.len() / 3) as u32;
    Ok(match &pass.objects {
        Objects::Visible(query) => {
            let objects = frame.objects(query);
            Call {
                triangles: objects.into_iter().map(|object| object.start / 3..object.end / 3).collect(),
                ..Call::once(0)
            }
        }
        _ => Call::once(triangles),
    })
}

/// The workgroups of a dispatch.
pub(super) fn workgroups(frame: &Frame<'_>, pass: &PlannedPass, values: &Values) -> Result<[u32; 3], Error> {
    let mut counts = [0; 3];
    match arguments(frame, pass)? {
        Some(words) => counts.iter_mut().zip(words).for_each(|(count, word)| *count = word),
        None => {
            for (count, groups) in counts.iter_mut().zip(&pass.groups) {
                *count = values.word(groups, "the workgroups of a pass")?;
            }
        }
    }
    Ok(counts)
}

/// The words of the buffer that says what is drawn; `None`: there is none.
fn arguments(frame: &Frame<'_>, pass: &Pass) -> Result<Option<Vec<u32>>, Error> {
    let Some(usage) = pass.uses.iter().find(|usage| usage.access == Access::Indirect) else { return Ok(None) };
    if pass.objects != Objects::All {
        return Err(unsupported(format!("pass `{}`: arguments in a buffer for several objects", pass.anchor)).into());
    }
    let words = read(&frame.device.memory.resources[resource(&frame.code.plan, &usage.resource)?.0]);
    let needed = match pass.kind {
        Kind::Compute { .. } => 3,
        Kind::Fullscreen => 4,
        Kind::Geometry => 5,
    };
    if words.len() < needed {
        let what = format!("`{}` as arguments: it has {} words, and needs {needed}", usage.resource, words.len());
        return Err(unsupported(what).into());
    }
    Ok(Some(words))
}

fn drawn_by(words: &[u32], pass: &Pass) -> Call {
    let from = |first: u32, count: u32| -> Range<u32> { first..first.saturating_add(count) };
    match (&pass.kind, words) {
        (Kind::Geometry, [indices, instances, first, base, first_instance, ..]) => Call {
            // Triangles begin where the list has triangles.
            triangles: vec![from(first / 3, indices / 3)],
            // Every draw counts its own from 0.
            zero: first / 3,
            base: base.cast_signed(),
            instances: from(*first_instance, *instances),
        },
        (_, [vertices, instances, first, first_instance, ..]) => Call {
            base: first.cast_signed(),
            instances: from(*first_instance, *instances),
            ..Call::once(vertices.min(&WHOLE_FRAME) / 3)
        },
        _ => Call::once(0),
    }
}
