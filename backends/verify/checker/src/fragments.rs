//! Candidate fragments: enough different ones, in the order in which the variant prefers them.
//!
//! Input: a subject. Output: candidates, best first, each with the rasteriser's output and the words that are stored for it.
//! The program under test computes the words. Their order is computed here, independently of the templates.

use std::ops::Range;

use fragbuf_interpreter::{Bytecode, Exit, InterfaceVariable, Machine};
use naga::{Binding, BuiltIn, ScalarKind};

use crate::memory::Memory;
use crate::programs::FragmentPrograms;
use crate::sequential::{machine_with, run_alone, set_arguments};
use crate::subject::Subject;

/// One fragment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fragment {
    /// One entry per input of the fragment stage, for the pixel (0, 0).
    pub(crate) inputs: Vec<Vec<u32>>,
    /// The words that are stored: the key first.
    pub(crate) words: Vec<u32>,
}

/// Fragments that are generated.
pub(crate) const GENERATED: u32 = 96;

/// Candidates that are chosen from them.
pub(crate) const RANKS: usize = 24;

/// The values of attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AttributeValues {
    /// Floats from 0 to 1, and integers from 1 to 1000.
    Unit,
    /// Floats from 0 to 1000.
    Thousand,
    /// Floats from 0 to 1; every integer is 1.
    OneObject,
}

impl AttributeValues {
    /// In the order in which they are considered.
    pub(crate) const ALL: [AttributeValues; 3] =
        [AttributeValues::Unit, AttributeValues::Thousand, AttributeValues::OneObject];
}

/// Admitted fragments of different keys, best first; and for each two twins, which have the same key and, if possible, other
/// payloads.
pub(crate) struct Candidates {
    pub(crate) ranked: Vec<Fragment>,
    pub(crate) twins: Vec<Fragment>,
    pub(crate) second_twins: Vec<Fragment>,
}

impl Candidates {
    /// Chooses the candidates. The inner `Err` is their number, if the constraints admit too few fragments or too many have equal
    /// keys.
    pub(crate) fn new(subject: &Subject, memory: &mut Memory) -> Result<Result<Self, usize>, String> {
        let mut ranked: Vec<Fragment> = Vec::new();
        for seed in 0..GENERATED {
            ranked.extend(fragment(subject, memory, seed, seed)?);
        }
        ranked.sort_by(|a, b| a.words.cmp(&b.words));
        ranked.dedup_by_key(|fragment| fragment.words[0]);
        if ranked.len() < RANKS {
            return Ok(Err(ranked.len()));
        }
        // Candidates are spread over the whole range, so that there are keys between any two.
        let step = ranked.len() / RANKS;
        let ranked: Vec<Fragment> = ranked.into_iter().step_by(step).take(RANKS).collect();
        let mut twins = |seeds: Range<u32>| -> Result<Vec<Fragment>, String> {
            ranked.iter().map(|fragment| twin(subject, memory, fragment, seeds.clone())).collect()
        };
        let (twins, second_twins) = (twins(200..232)?, twins(232..264)?);
        Ok(Ok(Candidates { ranked, twins, second_twins }))
    }
}

/// Returns the same fragment with other attributes, if it keeps its key. If there are several words, some are less and some
/// greater, so that mixed-up words are detected.
fn twin(subject: &Subject, memory: &mut Memory, fragment: &Fragment, seeds: Range<u32>) -> Result<Fragment, String> {
    let (same, mut found) = (fragment.clone(), None);
    for seed in seeds {
        let mut other = same.clone();
        let (program, _) = geometry(subject)?;
        for (number, input) in program.inputs.iter().enumerate() {
            if !is_position(input) {
                other.inputs[number] = seeded(input, seed, subject.attributes);
            }
        }
        if let Some(words) = packed(subject, memory, &other.inputs)?
            && words[0] == fragment.words[0]
            && words != fragment.words
        {
            let pairs = || words.iter().zip(&fragment.words);
            let crosses = pairs().any(|(a, b)| a < b) && pairs().any(|(a, b)| a > b);
            let twin = Fragment { words: words.clone(), ..other };
            if crosses {
                return Ok(twin);
            }
            found.get_or_insert(twin);
        }
    }
    Ok(found.unwrap_or(same))
}

fn fragment(subject: &Subject, memory: &mut Memory, seed: u32, depth: u32) -> Result<Option<Fragment>, String> {
    let (program, _) = geometry(subject)?;
    let inputs: Vec<Vec<u32>> = program
        .inputs
        .iter()
        .map(|input| match is_position(input) {
            // Depths are not in the order of seeds, and use all their bits.
            true => [0.5, 0.5, (depth * 37 % GENERATED) as f32 * 0.007_731 + 0.065_1, 1.0].map(f32::to_bits).to_vec(),
            false => seeded(input, seed, subject.attributes),
        })
        .collect();
    Ok(packed(subject, memory, &inputs)?.map(|words| Fragment { inputs, words }))
}

/// Returns the same fragment at another pixel of the frame.
pub(crate) fn at_pixel(fragment: &Fragment, program: &Bytecode, x: u32) -> Fragment {
    let mut moved = fragment.clone();
    for (input, words) in program.inputs.iter().zip(&mut moved.inputs) {
        if is_position(input) {
            words[0] = (x as f32 + 0.5).to_bits();
        }
    }
    moved
}

/// Returns the greatest depth of the fragments, and a fragment just behind it, whatever its key.
pub(crate) fn farthest<'f>(
    fragments: impl Iterator<Item = &'f Fragment>,
    program: &Bytecode,
) -> Option<(f32, Fragment)> {
    let position = program.inputs.iter().position(is_position)?;
    let depth = |fragment: &Fragment| f32::from_bits(fragment.inputs[position][2]);
    let last = fragments.max_by(|a, b| depth(a).total_cmp(&depth(b)))?;
    let mut behind = last.clone();
    behind.inputs[position][2] = depth(last).next_up().to_bits();
    Some((depth(last), behind))
}

/// Returns the fragment stage that packs fragments, and its functions.
fn geometry(subject: &Subject) -> Result<(&Bytecode, &FragmentPrograms), String> {
    let mut passes = subject.passes.iter();
    let found = passes.find_map(|pass| {
        let programs = pass.fragment.as_ref().filter(|programs| programs.pack.is_some())?;
        Some((&pass.program, programs))
    });
    found.ok_or_else(|| "no pass of the plan stores fragments".to_owned())
}

/// Returns the words of a fragment if it is admitted.
fn packed(subject: &Subject, memory: &mut Memory, inputs: &[Vec<u32>]) -> Result<Option<Vec<u32>>, String> {
    let (_, programs) = geometry(subject)?;
    let mut unpack = machine_with(&programs.unpack, inputs);
    run_to_end(&mut unpack, memory)?;
    let fragment = unpack.result().to_vec();
    if let Some(admit) = &programs.admit {
        let mut admit = Machine::new(admit);
        set_arguments(&mut admit, &fragment);
        run_to_end(&mut admit, memory)?;
        if admit.result() != [1] {
            return Ok(None);
        }
    }
    let Some(pack) = &programs.pack else { return Ok(None) };
    let mut pack = Machine::new(pack);
    set_arguments(&mut pack, &fragment);
    run_to_end(&mut pack, memory)?;
    Ok(Some(pack.result().to_vec()))
}

fn run_to_end(machine: &mut Machine<'_>, memory: &mut Memory) -> Result<(), String> {
    match run_alone(machine, memory)? {
        Exit::Ended => Ok(()),
        other => Err(format!("a function of the description does not end: {other:?}")),
    }
}

pub(crate) fn is_position(input: &InterfaceVariable) -> bool {
    matches!(input.binding, Some(Binding::BuiltIn(BuiltIn::Position { .. })))
}

/// Returns attribute values: whole numbers, or floats in 255ths of the greatest.
fn seeded(input: &InterfaceVariable, seed: u32, values: AttributeValues) -> Vec<u32> {
    let greatest = if values == AttributeValues::Thousand { 1000.0 } else { 1.0 };
    (0..input.words.len() as u32)
        .map(|component| {
            let mixed = (seed * 4 + component + 1).wrapping_mul(0x9e37_79b1) >> 8;
            match input.kind {
                Some(ScalarKind::Float) => ((mixed % 255 + 1) as f32 / 255.0 * greatest).to_bits(),
                _ if values == AttributeValues::OneObject => 1,
                _ => mixed % 1000 + 1,
            }
        })
        .collect()
}
