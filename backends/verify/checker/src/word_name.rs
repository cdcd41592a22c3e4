//! Names of words: the path of members and indices from a variable of a shader to a word.
//!
//! Input: a type and the number of a word in a value of it. Output: what follows the variable's name, such as `.first[3]`.

use naga::{Handle, Module, Type, TypeInner, VectorSize};

/// Returns the path to a word of a value.
pub(crate) fn word_path(module: &Module, kind: Handle<Type>, word: u32) -> String {
    match &module.types[kind].inner {
        TypeInner::Struct { members, .. } => {
            let Some(member) = members.iter().rfind(|member| member.offset / 4 <= word) else { return String::new() };
            let name = member.name.as_deref().unwrap_or("?");
            format!(".{name}{}", word_path(module, member.ty, word - member.offset / 4))
        }
        TypeInner::Array { base, stride, .. } => {
            let stride = (stride / 4).max(1);
            format!("[{}]{}", word / stride, word_path(module, *base, word % stride))
        }
        TypeInner::Vector { .. } => component(word),
        TypeInner::Matrix { rows, .. } => {
            let stride = if *rows == VectorSize::Bi { 2 } else { 4 };
            format!("[{}]{}", word / stride, component(word % stride))
        }
        _ => String::new(),
    }
}

fn component(word: u32) -> String {
    ["x", "y", "z", "w"].get(word as usize).map_or(String::new(), |name| format!(".{name}"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::word_path;

    #[test]
    fn a_path_names_members_elements_and_components() {
        let source = "struct Node { key: u32, color: vec3<f32>, turn: mat2x2<f32> }
            struct Heads { count: atomic<u32>, nodes: array<Node> }
            @group(0) @binding(0) var<storage, read_write> heads: Heads;";
        let module = naga::front::wgsl::parse_str(source).unwrap();
        let (_, heads) = module.global_variables.iter().next().unwrap();
        // A node has 48 bytes and begins at a multiple of 16: key, padding, color, padding, two columns.
        for (word, path) in [
            (0, ".count"),
            (4, ".nodes[0].key"),
            (8, ".nodes[0].color.x"),
            (10, ".nodes[0].color.z"),
            (12, ".nodes[0].turn[0].x"),
            (15, ".nodes[0].turn[1].y"),
            (16, ".nodes[1].key"),
        ] {
            assert_eq!(word_path(&module, heads.ty, word), path, "{word}");
        }
    }
}
