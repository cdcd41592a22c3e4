//! Removes the zero initialisers that naga writes for private variables, from variables that are written before they are read.

use rspirv::spirv::{Op, StorageClass, Word};

/// Words before the first instruction.
const HEADER: usize = 5;

/// Removes the initialisers of the named variables.
pub(super) fn without(words: Vec<u32>, written_first: &[String]) -> Vec<u32> {
    if written_first.is_empty() {
        return words;
    }
    let names: Vec<Vec<u32>> = written_first.iter().map(|name| literal(name)).collect();
    let mut variables: Vec<Word> = Vec::new();
    let mut out = Vec::with_capacity(words.len());
    out.extend_from_slice(&words[..HEADER.min(words.len())]);
    let mut rest = words.get(HEADER..).unwrap_or_default();
    while let Some(&first) = rest.first() {
        let length = ((first >> 16) as usize).clamp(1, rest.len());
        let (instruction, after) = rest.split_at(length);
        match (first & 0xffff, instruction) {
            (NAME, [_, id, name @ ..]) if names.iter().any(|wanted| wanted == name) => variables.push(*id),
            // Type, result, storage class, initialiser.
            (VARIABLE, [_, ty, id, PRIVATE, _]) if variables.contains(id) => {
                out.extend_from_slice(&[(4 << 16) | VARIABLE, *ty, *id, PRIVATE]);
                rest = after;
                continue;
            }
            _ => {}
        }
        out.extend_from_slice(instruction);
        rest = after;
    }
    out
}

const NAME: u32 = Op::Name as u32;
const VARIABLE: u32 = Op::Variable as u32;
const PRIVATE: u32 = StorageClass::Private as u32;

/// Encodes a string literal of SPIR-V: little-endian bytes with at least one trailing zero.
fn literal(name: &str) -> Vec<u32> {
    let mut bytes = name.as_bytes().to_vec();
    bytes.resize(name.len() / 4 * 4 + 4, 0);
    let word = |bytes: &[u8]| bytes.iter().rev().fold(0, |word, byte| (word << 8) | u32::from(*byte));
    bytes.chunks(4).map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_named_variables_lose_their_initialiser() {
        let name = |id: u32, text: &str| {
            let words = literal(text);
            [vec![((2 + words.len() as u32) << 16) | NAME, id], words].concat()
        };
        let variable = |id: u32| vec![(5 << 16) | VARIABLE, 9, id, PRIVATE, 8];
        let module = [vec![0; HEADER], name(1, "layers"), name(2, "layers_"), variable(1), variable(2)].concat();
        let short = vec![(4 << 16) | VARIABLE, 9, 1, PRIVATE];
        let expected = [vec![0; HEADER], name(1, "layers"), name(2, "layers_"), short, variable(2)].concat();
        assert_eq!(without(module.clone(), &["layers".to_owned()]), expected);
        assert_eq!(without(module.clone(), &[]), module);
    }
}
