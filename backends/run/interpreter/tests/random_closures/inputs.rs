//! The inputs of closures: edge values and numbers between.

use super::random::Random;
use super::types::{ATTRIBUTES, FRAGMENTS, Type, UNIFORMS};
use super::value::Input;

const UNSIGNED: &[u32] = &[0, 1, 2, 3, 7, 31, 32, 33, 255, 0x7fff_ffff, 0x8000_0000, u32::MAX - 1, u32::MAX];
const SIGNED: &[i32] = &[i32::MIN, i32::MIN + 1, -100, -3, -2, -1, 0, 1, 2, 3, 31, 32, i32::MAX - 1, i32::MAX];
const FLOATS: &[f32] = &[
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    2.5,
    -2.5,
    0.1,
    -0.3,
    1e-30,
    1e-40,
    1e20,
    -1e20,
    8_388_607.5,
    16_777_216.0,
    2_147_483_648.0,
    -2_147_483_648.0,
    4_294_967_296.0,
    3.0,
    -7.0,
    100.25,
    f32::MAX,
    f32::MIN_POSITIVE,
];

/// Returns the inputs that every closure runs on.
pub fn inputs(count: usize) -> Vec<Input> {
    let mut random = Random::new(0x5eed);
    (0..count).map(|at| input(&mut random, at)).collect()
}

fn input(random: &mut Random, at: usize) -> Input {
    let mut words = Vec::new();
    // The first inputs have ordinary numbers only, so that long closures have defined results, too.
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
        (_, false) => random.pick(FLOATS).to_bits(),
    }
}
