//! The interface between the stages of a draw: the source of each fragment input and the target of each output.
//!
//! The tables are computed once per draw. An input without a source is an error.

use std::ops::Range;

use fragbuf_interpreter::{Bytecode, InterfaceVariable};
use naga::{Binding, BuiltIn, Interpolation, Sampling, ScalarKind};

/// The layout of the output of the vertex stage.
#[derive(Clone, Debug)]
pub(crate) struct VertexOutputLayout {
    /// The number of words of a vertex.
    pub(crate) stride: usize,
    /// The first word of the position.
    pub(crate) position: usize,
    /// How clipping interpolates each word.
    pub(crate) interpolation: Vec<ClipInterpolation>,
}

/// The interpolation of a word at a clipped corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClipInterpolation {
    /// Floats are interpolated linearly.
    Linear,
    /// Other words are those of the first corner.
    Flat,
}

/// One input of the fragment stage.
#[derive(Clone, Debug)]
pub(crate) struct FragmentInput {
    /// The words of the machine.
    pub(crate) to: Range<usize>,
    pub(crate) from: InputSource,
}

/// The source of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InputSource {
    Position,
    FrontFacing,
    PrimitiveIndex,
    SampleIndex,
    SampleMask,
    /// Words of the first corner, from this index.
    Flat(usize),
    /// Interpolated words of the corners, from this index.
    Perspective(usize),
    Linear(usize),
}

/// The outputs of the fragment stage, as words of its result.
#[derive(Clone, Debug, Default)]
pub(crate) struct FragmentOutputs {
    pub(crate) depth: Option<usize>,
    pub(crate) mask: Option<usize>,
    /// The colours, by location.
    pub(crate) colors: Vec<Option<Range<usize>>>,
}

/// The frequency of the fragment stage: once per pixel or once per sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rate {
    Pixel,
    Sample,
}

impl VertexOutputLayout {
    pub(crate) fn of(vertex: &Bytecode) -> Result<Self, String> {
        let position = vertex.outputs.iter().find(|output| output.is(BuiltIn::Position { invariant: false }));
        let position = position.ok_or_else(|| "a vertex shader without a position".to_owned())?;
        let first = vertex.result.start;
        let mut interpolation = vec![ClipInterpolation::Flat; vertex.result.len()];
        for output in vertex.outputs.iter().filter(|output| output.kind == Some(ScalarKind::Float)) {
            interpolation[output.words.start - first..output.words.end - first].fill(ClipInterpolation::Linear);
        }
        Ok(VertexOutputLayout { stride: vertex.result.len(), position: position.words.start - first, interpolation })
    }

    /// Returns the clip-space position in the words of a vertex.
    pub(crate) fn position_in(&self, words: &[u32]) -> [f32; 4] {
        std::array::from_fn(|axis| f32::from_bits(words[self.position + axis]))
    }
}

/// Returns the sources of the inputs of `fragment`, and how often it runs.
pub(crate) fn fragment_inputs(vertex: &Bytecode, fragment: &Bytecode) -> Result<(Vec<FragmentInput>, Rate), String> {
    let mut rate = Rate::Pixel;
    let mut inputs = Vec::new();
    for input in &fragment.inputs {
        let from = match &input.binding {
            Some(Binding::BuiltIn(built_in)) => {
                if *built_in == BuiltIn::SampleIndex {
                    rate = Rate::Sample;
                }
                built_in_source(*built_in)?
            }
            Some(Binding::Location { location, interpolation, sampling, .. }) => {
                if *sampling == Some(Sampling::Sample) {
                    rate = Rate::Sample;
                }
                varying_source(vertex, *location, *interpolation)?
            }
            None => return Err(format!("the input `{}`, which has no source", input.name)),
        };
        inputs.push(FragmentInput { to: input.words.clone(), from });
    }
    Ok((inputs, rate))
}

fn built_in_source(built_in: BuiltIn) -> Result<InputSource, String> {
    Ok(match built_in {
        BuiltIn::Position { .. } => InputSource::Position,
        BuiltIn::FrontFacing => InputSource::FrontFacing,
        BuiltIn::PrimitiveIndex => InputSource::PrimitiveIndex,
        BuiltIn::SampleIndex => InputSource::SampleIndex,
        BuiltIn::SampleMask => InputSource::SampleMask,
        other => return Err(format!("the built-in value {other:?} of a fragment")),
    })
}

fn varying_source(
    vertex: &Bytecode,
    location: u32,
    interpolation: Option<Interpolation>,
) -> Result<InputSource, String> {
    let output = vertex.outputs.iter().find(|output| output.location() == Some(location));
    let output = output
        .ok_or_else(|| format!("a fragment's input at location {location}, which is no output of the vertex shader"))?;
    let first = output.words.start - vertex.result.start;
    Ok(match interpolation {
        Some(Interpolation::Flat) => InputSource::Flat(first),
        Some(Interpolation::Linear) => InputSource::Linear(first),
        None | Some(Interpolation::Perspective) => InputSource::Perspective(first),
        Some(other) => return Err(format!("{other:?} interpolation")),
    })
}

/// Returns the outputs of `fragment`.
pub(crate) fn fragment_outputs(fragment: &Bytecode) -> Result<FragmentOutputs, String> {
    let mut outputs = FragmentOutputs::default();
    for output in &fragment.outputs {
        let first = fragment.result.start;
        let words = output.words.start - first..output.words.end - first;
        match output {
            _ if output.is(BuiltIn::FragDepth) => outputs.depth = Some(words.start),
            _ if output.is(BuiltIn::SampleMask) => outputs.mask = Some(words.start),
            InterfaceVariable { binding: Some(Binding::Location { location, .. }), .. } => {
                let location = *location as usize;
                outputs.colors.resize(outputs.colors.len().max(location + 1), None);
                outputs.colors[location] = Some(words);
            }
            other => return Err(format!("the output `{}` of a fragment", other.name)),
        }
    }
    Ok(outputs)
}
