//! Fragments to insert: enough different ones, in the order in which the variant prefers them.
//!
//! In: a subject. Out: candidates, best first, each with what the rasteriser gives for it and the words that it is stored
//! as. The words are what the program itself makes of the fragment; the order over them is stated here anew.

use fragbuf_interpreter::{Exit, Input, Machine, Program};
use naga::{Binding, BuiltIn, ScalarKind};

use crate::frame::Memory;
use crate::frame::run_alone;
use crate::subject::Subject;

/// One fragment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fragment {
    /// One entry per input of the fragment stage, for the pixel (0, 0).
    pub(crate) inputs: Vec<Vec<u32>>,
    /// As it is stored: the key first.
    pub(crate) words: Vec<u32>,
}

/// Candidates that are tried.
const TRIED: u32 = 96;

/// Candidates that are taken.
const RANKS: usize = 24;

/// Admitted fragments of different keys, best first; and one of the same key as each, which differs beside it if it can.
pub(crate) struct Candidates {
    pub(crate) ranked: Vec<Fragment>,
    pub(crate) twins: Vec<Fragment>,
}

impl Candidates {
    /// `Err`: the constraints admit too few, or the criterion hardly tells fragments apart.
    pub(crate) fn new(subject: &Subject, memory: &mut Memory) -> Result<Self, String> {
        let mut ranked: Vec<Fragment> = Vec::new();
        for seed in 0..TRIED {
            ranked.extend(fragment(subject, memory, seed, seed)?);
        }
        ranked.sort_by(|a, b| a.words.cmp(&b.words));
        ranked.dedup_by_key(|fragment| fragment.words[0]);
        if ranked.len() < RANKS {
            return Err(format!(
                "only {} of {TRIED} tried fragments are admitted and have different keys",
                ranked.len()
            ));
        }
        // Spread over the whole range, so that there is room between any two.
        let step = ranked.len() / RANKS;
        let ranked: Vec<Fragment> = ranked.into_iter().step_by(step).take(RANKS).collect();
        let twins = ranked.iter().map(|fragment| twin(subject, memory, fragment)).collect::<Result<_, _>>()?;
        Ok(Candidates { ranked, twins })
    }
}

/// The same fragment with other attributes, if that leaves its key alone: some words less and some greater, if there are
/// several, so that words that get mixed up are seen.
fn twin(subject: &Subject, memory: &mut Memory, fragment: &Fragment) -> Result<Fragment, String> {
    let (same, mut found) = (fragment.clone(), None);
    for seed in 200..232 {
        let mut other = same.clone();
        let (program, _) = geometry(subject)?;
        for (number, input) in program.inputs.iter().enumerate() {
            if !is_position(input) {
                other.inputs[number] = seeded(input, seed);
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
            // Depths in an order of their own, with all their bits in use.
            true => [0.5, 0.5, (depth * 37 % TRIED) as f32 * 0.007_731 + 0.065_1, 1.0].map(f32::to_bits).to_vec(),
            false => seeded(input, seed),
        })
        .collect();
    Ok(packed(subject, memory, &inputs)?.map(|words| Fragment { inputs, words }))
}

/// The same fragment at another pixel of the frame.
pub(crate) fn at_pixel(fragment: &Fragment, program: &Program, x: u32) -> Fragment {
    let mut moved = fragment.clone();
    for (input, words) in program.inputs.iter().zip(&mut moved.inputs) {
        if is_position(input) {
            words[0] = (x as f32 + 0.5).to_bits();
        }
    }
    moved
}

/// The greatest depth among fragments, and one that lies just behind it, whatever its key.
pub(crate) fn farthest<'f>(
    fragments: impl Iterator<Item = &'f Fragment>,
    program: &Program,
) -> Option<(f32, Fragment)> {
    let position = program.inputs.iter().position(is_position)?;
    let depth = |fragment: &Fragment| f32::from_bits(fragment.inputs[position][2]);
    let last = fragments.max_by(|a, b| depth(a).total_cmp(&depth(b)))?;
    let mut behind = last.clone();
    behind.inputs[position][2] = depth(last).next_up().to_bits();
    Some((depth(last), behind))
}

/// The fragment stage that packs, and its inputs.
fn geometry(subject: &Subject) -> Result<(&Program, &crate::subject::FragmentPrograms), String> {
    let mut passes = subject.passes.iter();
    let found = passes.find_map(|pass| {
        let programs = pass.fragment.as_ref().filter(|programs| programs.pack.is_some())?;
        Some((&pass.program, programs))
    });
    found.ok_or_else(|| "no pass of the plan stores fragments".to_owned())
}

/// The words of a fragment that is admitted.
fn packed(subject: &Subject, memory: &mut Memory, inputs: &[Vec<u32>]) -> Result<Option<Vec<u32>>, String> {
    let (_, programs) = geometry(subject)?;
    let mut unpack = Machine::new(&programs.unpack);
    inputs.iter().enumerate().for_each(|(number, words)| unpack.set_input(number, words));
    ended(&mut unpack, memory)?;
    let fragment = unpack.result().to_vec();
    if let Some(admit) = &programs.admit {
        let mut admit = Machine::new(admit);
        set_all(&mut admit, &fragment);
        ended(&mut admit, memory)?;
        if admit.result() != [1] {
            return Ok(None);
        }
    }
    let Some(pack) = &programs.pack else { return Ok(None) };
    let mut pack = Machine::new(pack);
    set_all(&mut pack, &fragment);
    ended(&mut pack, memory)?;
    Ok(Some(pack.result().to_vec()))
}

/// Spreads dense words over the inputs of a function of one argument.
pub(crate) fn set_all(machine: &mut Machine<'_>, words: &[u32]) {
    let mut at = 0;
    for (number, input) in machine.program().inputs.iter().enumerate() {
        machine.set_input(number, &words[at.min(words.len())..]);
        at += input.words.len();
    }
}

fn ended(machine: &mut Machine<'_>, memory: &mut Memory) -> Result<(), String> {
    match run_alone(machine, memory)? {
        Exit::Ended => Ok(()),
        other => Err(format!("a function of the description does not end: {other:?}")),
    }
}

fn is_position(input: &Input) -> bool {
    matches!(input.binding, Some(Binding::BuiltIn(BuiltIn::Position { .. })))
}

/// Attribute values: whole numbers, or floats from 0 to 1 in 255ths.
fn seeded(input: &Input, seed: u32) -> Vec<u32> {
    (0..input.words.len() as u32)
        .map(|component| {
            let mixed = (seed * 4 + component + 1).wrapping_mul(0x9e37_79b1) >> 8;
            match input.kind {
                Some(ScalarKind::Float) => ((mixed % 255 + 1) as f32 / 255.0).to_bits(),
                _ => mixed % 1000 + 1,
            }
        })
        .collect()
}
