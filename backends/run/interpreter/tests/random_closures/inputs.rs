//! The inputs of closures: edge values and numbers between.

use super::edges::{FLOATS, SIGNED, UNSIGNED};
use super::random::Random;
use super::types::{ATTRIBUTES, FRAGMENTS, Type, UNIFORMS};
use super::value::Input;

/// Numbers that only ranges of results can be compared for: devices may flush them or have infinite results.
const EXTREMES: &[f32] = &[1e-40, 1e20, -1e20, f32::MAX, f32::MIN_POSITIVE];

/// Returns the inputs that every closure runs on.
pub fn inputs(count: usize) -> Vec<Input> {
    let mut random = Random::new(0x5eed);
    (0..count).map(|at| input(&mut random, at)).collect()
}

fn input(random: &mut Random, at: usize) -> Input {
    let mut words = Vec::new();
    // Every second input has ordinary numbers only, so that long closures have defined results, too.
    let is_ordinary = at.is_multiple_of(2);
    let fields = UNIFORMS.iter().chain(ATTRIBUTES.iter().cycle().take(ATTRIBUTES.len() * FRAGMENTS));
    for (_, ty) in fields {
        words.extend((0..ty.words()).map(|_| word(random, *ty, is_ordinary)));
    }
    words.push(if at % 8 == 7 { 0 } else { 1 + random.below(FRAGMENTS) as u32 });
    Input::from_words(words)
}

fn word(random: &mut Random, ty: Type, is_ordinary: bool) -> u32 {
    match (ty, is_ordinary) {
        (Type::U32, true) => random.next() >> (8 + random.below(24)),
        (Type::I32, true) => (random.next().cast_signed() >> (8 + random.below(24))).cast_unsigned(),
        (_, true) => (random.below(4001) as f32 / 64.0 - 31.0).to_bits(),
        (Type::U32, false) => random.pick(UNSIGNED),
        (Type::I32, false) => random.pick(SIGNED).cast_unsigned(),
        (_, false) if random.below(5) == 0 => random.pick(EXTREMES).to_bits(),
        (_, false) => random.pick(FLOATS).to_bits(),
    }
}
