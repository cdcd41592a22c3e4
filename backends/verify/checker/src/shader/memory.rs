//! The initial memory of a shader: zero, or the words that the caller gives.
//!
//! Input: the programs of a shader and the words by name. Output: the words of every binding. A texture holds one in every
//! channel of every texel, as a cleared depth buffer does.

use fragbuf_interpreter::{Bytecode, Space};
use fragbuf_model::nearest_name;
use naga::ScalarKind;

use crate::memory::{Memory, TexelLayout, memory_index};
use crate::verdict::Error;

use super::Shader;

/// The least words of a runtime-sized array.
const OPEN_WORDS: u32 = 64;

/// The least elements of a runtime-sized array.
const OPEN_ELEMENTS: u32 = 16;

/// The textures of a shader.
pub(super) const TEXELS: TexelLayout = TexelLayout { width: 16, height: 16, channels: 4 };

/// Returns the initial content of every binding.
pub(super) fn memory(programs: &[&Bytecode], shader: &Shader<'_>) -> Result<Memory, Error> {
    let mut memory: Memory = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    let mut set = |name: &str, binding: Option<(u32, u32)>, least: usize, word: u32| {
        let given = shader.fill.iter().rfind(|(filled, _)| filled == name);
        let mut words = given.map_or(Vec::new(), |(_, words)| words.clone());
        words.resize(words.len().max(least), word);
        let index = memory_index(binding);
        if memory.len() <= index {
            memory.resize(index + 1, Vec::new());
        }
        memory[index] = words;
    };
    for program in programs {
        for buffer in program.buffers.iter().filter(|buffer| buffer.space != Space::Workgroup) {
            let open = match buffer.element_words {
                0 => 0,
                element => OPEN_WORDS.max(element.saturating_mul(OPEN_ELEMENTS)),
            };
            set(&buffer.name, buffer.binding, (buffer.words.saturating_add(open)) as usize, 0);
            names.push(&buffer.name);
        }
        for texture in &program.textures {
            let one = if texture.kind == ScalarKind::Float { 1f32.to_bits() } else { 1 };
            set(&texture.name, texture.binding, (TEXELS.width * TEXELS.height * TEXELS.channels) as usize, one);
            names.push(&texture.name);
        }
    }
    for (name, words) in shader.fill {
        if !names.contains(&name.as_str()) {
            return Err(unknown(name, &names, shader));
        }
        let fixed = programs.iter().flat_map(|program| &program.buffers).find(|buffer| buffer.name == *name);
        if let Some(buffer) = fixed.filter(|buffer| buffer.element_words == 0 && words.len() > buffer.words as usize) {
            let text = format!("`{name}` has {} words, and is filled with {}", buffer.words, words.len());
            return Err(Error::Unable(text));
        }
    }
    Ok(memory)
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
