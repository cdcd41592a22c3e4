//! The initial memory of a shader: zero, or the words that the caller gives.
//!
//! Input: the programs of a shader and the words by name. Output: the words of every binding. A texture holds one in every
//! channel of every texel, as a cleared depth buffer does.

use fragbuf_interpreter::{Buffer, Bytecode, Space};
use fragbuf_model::{counted, nearest_name};
use naga::ScalarKind;

use crate::memory::{Memory, TexelLayout, memory_index};
use crate::verdict::Error;

use super::Shader;

/// The least words of a runtime-sized array.
const OPEN_WORDS: u32 = 64;

/// The least elements of a runtime-sized array.
const OPEN_ELEMENTS: u32 = 16;

/// The most words of all buffers, including workgroup variables. Every state has them.
pub(super) const MOST_WORDS: u64 = 1 << 14;

/// The most words of all states of a search that are in memory at a time, about.
pub(super) const STATE_WORDS: usize = 1 << 29;

/// The textures of a shader.
pub(super) const TEXELS: TexelLayout = TexelLayout { width: 16, height: 16, channels: 4 };

/// A buffer or a texture. Several variables may have one binding.
#[derive(Default)]
struct Bound<'a> {
    names: Vec<&'a str>,
    words: usize,
    /// Whether it ends in a runtime-sized array.
    is_open: bool,
    /// The content of words that the caller does not give.
    other: u32,
}

/// Returns the initial content of every binding.
pub(super) fn memory(programs: &[&Bytecode], shader: &Shader<'_>) -> Result<Memory, Error> {
    check_size(programs)?;
    let mut bound: Vec<Bound<'_>> = Vec::new();
    for program in programs {
        for buffer in program.buffers.iter().filter(|buffer| buffer.space != Space::Workgroup) {
            let known = at_binding(&mut bound, buffer.binding);
            known.names.push(&buffer.name);
            known.words = known.words.max(buffer.words.saturating_add(open_words(buffer)) as usize);
            known.is_open |= buffer.element_words > 0;
        }
        for texture in &program.textures {
            let known = at_binding(&mut bound, texture.binding);
            known.names.push(&texture.name);
            known.words = (TEXELS.width * TEXELS.height * TEXELS.channels) as usize;
            known.other = if texture.kind == ScalarKind::Float { 1f32.to_bits() } else { 1 };
        }
    }
    let mut names: Vec<&str> = bound.iter().flat_map(|bound| bound.names.iter().copied()).collect();
    names.sort_unstable();
    names.dedup();
    if let Some((name, _)) = shader.fill.iter().find(|(name, _)| !names.contains(&name.as_str())) {
        return Err(unknown(name, &names, shader));
    }
    bound.iter().map(|bound| content(bound, shader)).collect()
}

fn at_binding<'b, 'a>(bound: &'b mut Vec<Bound<'a>>, binding: Option<(u32, u32)>) -> &'b mut Bound<'a> {
    let index = memory_index(binding);
    if bound.len() <= index {
        bound.resize_with(index + 1, Bound::default);
    }
    &mut bound[index]
}

/// Returns the words of a binding.
fn content(bound: &Bound<'_>, shader: &Shader<'_>) -> Result<Vec<u32>, Error> {
    let mut given = shader.fill.iter().filter(|(name, _)| bound.names.contains(&name.as_str()));
    let Some((name, filled)) = given.next() else { return Ok(vec![bound.other; bound.words]) };
    if let Some((other, _)) = given.next() {
        return Err(Error::Unable(format!("`{name}` and `{other}` fill the same words: give one of the two")));
    }
    let most = if bound.is_open { MOST_WORDS as usize } else { bound.words };
    if filled.len() > most {
        return Err(Error::Unable(format!(
            "`{name}` can have {}, and is filled with {}",
            counted(most, "word"),
            filled.len()
        )));
    }
    let mut words = filled.clone();
    words.resize(words.len().max(bound.words), bound.other);
    Ok(words)
}

/// Returns the words that a runtime-sized array has at least.
fn open_words(buffer: &Buffer) -> u32 {
    match buffer.element_words {
        0 => 0,
        element => OPEN_WORDS.max(element.saturating_mul(OPEN_ELEMENTS)),
    }
}

/// Checks that states are small.
fn check_size(programs: &[&Bytecode]) -> Result<(), Error> {
    for program in programs {
        let words = program.buffers.iter().map(|buffer| u64::from(buffer.words) + u64::from(open_words(buffer)));
        let sum: u64 = words.sum();
        if sum > MOST_WORDS {
            let text = format!("the buffers have {sum} words, and a check can have {MOST_WORDS}: use smaller arrays");
            return Err(Error::Unable(text));
        }
    }
    Ok(())
}

fn unknown(name: &str, names: &[&str], shader: &Shader<'_>) -> Error {
    let known = match names {
        [] => "it accesses no buffer or texture".to_owned(),
        _ => format!("it accesses {}", names.join(", ")),
    };
    let suggestion = nearest_name(name, names).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    Error::Unable(format!(
        "`{}` of {} accesses no buffer or texture `{name}`: {known}{suggestion}",
        shader.entry, shader.file
    ))
}
