//! How the stages of a draw hang together: which words of a vertex feed which input of a fragment, and where its outputs go.
//!
//! In: the programs of a pass. Out: plain tables, made once per draw. What is fed by nothing here is refused by name.

use std::ops::Range;

use fragbuf_interpreter::{Input, Program};
use naga::{Binding, BuiltIn, Interpolation, Sampling, ScalarKind};

/// The words of a vertex as it leaves its stage.
#[derive(Clone, Debug)]
pub(crate) struct Varyings {
    /// Words of a vertex.
    pub(crate) stride: usize,
    /// Where its position begins.
    pub(crate) position: usize,
    /// Per word, whether it is a float, which clipping may weigh; others are taken from the first corner.
    pub(crate) weighed: Vec<Weighed>,
}

/// What clipping makes of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weighed {
    Float,
    Flat,
}

/// What an input of the fragment stage is fed with.
#[derive(Clone, Debug)]
pub(crate) struct Feed {
    /// The machine's words.
    pub(crate) to: Range<usize>,
    pub(crate) from: Source,
}

/// Where it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Position,
    FrontFacing,
    PrimitiveIndex,
    SampleIndex,
    SampleMask,
    /// Words of the first corner, from this one on.
    Flat(usize),
    /// Words of all corners.
    Perspective(usize),
    Linear(usize),
}

/// Where what a fragment returns goes: words of its result, from the first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outputs {
    pub(crate) depth: Option<usize>,
    pub(crate) mask: Option<usize>,
    /// By location.
    pub(crate) colors: Vec<Option<Range<usize>>>,
}

/// How often a fragment runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rate {
    Pixel,
    Sample,
}

impl Varyings {
    pub(crate) fn of(vertex: &Program) -> Result<Self, String> {
        let position = vertex.outputs.iter().find(|output| output.is(BuiltIn::Position { invariant: false }));
        let position = position.ok_or_else(|| "a vertex without a position".to_owned())?;
        let first = vertex.result.start;
        let mut weighed = vec![Weighed::Flat; vertex.result.len()];
        for output in vertex.outputs.iter().filter(|output| output.kind == Some(ScalarKind::Float)) {
            weighed[output.words.start - first..output.words.end - first].fill(Weighed::Float);
        }
        Ok(Varyings { stride: vertex.result.len(), position: position.words.start - first, weighed })
    }
}

impl Varyings {
    /// The position among the words of a vertex, in clip space.
    pub(crate) fn position_in(&self, words: &[u32]) -> [f32; 4] {
        std::array::from_fn(|axis| f32::from_bits(words[self.position + axis]))
    }
}

/// What feeds the inputs of `fragment`, and how often it runs.
pub(crate) fn feeds(vertex: &Program, fragment: &Program) -> Result<(Vec<Feed>, Rate), String> {
    let mut rate = Rate::Pixel;
    let mut feeds = Vec::new();
    for input in &fragment.inputs {
        let from = match &input.binding {
            Some(Binding::BuiltIn(built_in)) => {
                if *built_in == BuiltIn::SampleIndex {
                    rate = Rate::Sample;
                }
                source(*built_in)?
            }
            Some(Binding::Location { location, interpolation, sampling, .. }) => {
                if *sampling == Some(Sampling::Sample) {
                    rate = Rate::Sample;
                }
                varying(vertex, *location, *interpolation)?
            }
            None => return Err(format!("the input `{}`, which nothing feeds", input.name)),
        };
        feeds.push(Feed { to: input.words.clone(), from });
    }
    Ok((feeds, rate))
}

fn source(built_in: BuiltIn) -> Result<Source, String> {
    Ok(match built_in {
        BuiltIn::Position { .. } => Source::Position,
        BuiltIn::FrontFacing => Source::FrontFacing,
        BuiltIn::PrimitiveIndex => Source::PrimitiveIndex,
        BuiltIn::SampleIndex => Source::SampleIndex,
        BuiltIn::SampleMask => Source::SampleMask,
        other => return Err(format!("the built-in value {other:?} of a fragment")),
    })
}

fn varying(vertex: &Program, location: u32, interpolation: Option<Interpolation>) -> Result<Source, String> {
    let output = vertex.outputs.iter().find(|output| output.location() == Some(location));
    let output = output.ok_or_else(|| format!("a fragment's input at location {location}, which no vertex has"))?;
    let first = output.words.start - vertex.result.start;
    Ok(match interpolation {
        Some(Interpolation::Flat) => Source::Flat(first),
        Some(Interpolation::Linear) => Source::Linear(first),
        None | Some(Interpolation::Perspective) => Source::Perspective(first),
        Some(other) => return Err(format!("interpolation of the kind {other:?}")),
    })
}

/// Where the results of `fragment` go.
pub(crate) fn outputs(fragment: &Program) -> Result<Outputs, String> {
    let mut outputs = Outputs::default();
    for output in &fragment.outputs {
        let first = fragment.result.start;
        let words = output.words.start - first..output.words.end - first;
        match output {
            _ if output.is(BuiltIn::FragDepth) => outputs.depth = Some(words.start),
            _ if output.is(BuiltIn::SampleMask) => outputs.mask = Some(words.start),
            Input { binding: Some(Binding::Location { location, .. }), .. } => {
                let location = *location as usize;
                outputs.colors.resize(outputs.colors.len().max(location + 1), None);
                outputs.colors[location] = Some(words);
            }
            other => return Err(format!("the output `{}` of a fragment", other.name)),
        }
    }
    Ok(outputs)
}
