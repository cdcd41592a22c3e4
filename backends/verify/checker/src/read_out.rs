//! Reads what a pixel holds through the storage's own functions: `storage_first`, `storage_next`, `storage_read`.
//!
//! Input: a plan, and the words of its resources after a frame of any device. Output: the fragments of a pixel, each as its
//! words in memory, the key first, in the order in which the storage gives them. The functions are linked into a compute
//! pass that the interpreter runs. So no storage layout is repeated here, and a user's storage is read in the same way.

use std::collections::BTreeSet;

use fragbuf_codegen::{FIRST_BINDING, Form, Linking, Plan, Profile, link};
use fragbuf_interpreter::{Bytecode, Exit, Machine, Texture, Unsupported};
use fragbuf_model::{Diagnostic, Diagnostics, SourceSpan, codes};
use fragbuf_targets::{Checked, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Element, TextureFormat};

use crate::frame_memory::{FrameMemory, ReadOutError};
use crate::memory::{Memory, memory_index, with_buffers};
use crate::probe::{probe_pass, probe_row};
use crate::programs::{CheckedSource, diagnostics, options};
use crate::report::code_location;
use crate::sampled::{Reader, SampledTexture, is_readable};

/// The probe passes; each is a file.
const READ_OUT: &str = "read_out";
const READ_BOUND: &str = "read_bound";
const READ_COPIES: &str = "read_copies";

/// The functions that read a pixel out, compiled. They belong to one plan, and to frames drawn with it.
///
/// ```
/// use fragbuf_checker::{FrameMemory, ReadOut};
/// use fragbuf_codegen::{Profile, plan};
/// use fragbuf_model::{Draft, SourceSpan, Selection, check};
/// use fragbuf_templates::Registry;
///
/// let registry = Registry::builtin();
/// let draft = Draft::from_technique("kb", &SourceSpan::new("mine", 1, 1));
/// let variant = check(&draft, &registry).expect("a legal description");
/// let plan = plan(&variant, &Selection::first(&variant), &registry).expect("a plan");
/// let read_out = ReadOut::new(&plan, Profile::Native, &registry).expect("programs");
///
/// // An empty frame of one pixel and k = 2: every bit of this storage's empty slots is set.
/// let symbol = |name: &str| [("width", 1), ("height", 1), ("k", 2)].into_iter().find(|one| one.0 == name).map(|one| one.1);
/// let mut frame = FrameMemory::new(&plan, [1, 1], symbol, |_| Some(vec![u32::MAX; 4]));
/// assert_eq!(read_out.pixel(&mut frame, [0, 0]), Ok(Vec::new()));
/// ```
#[derive(Debug)]
pub struct ReadOut {
    /// From a position in the frame to the pixel's index.
    index: Bytecode,
    /// From a pixel and a number to the cursor after so many fragments. The walk is one invocation, because a storage may
    /// count fragments along the way.
    walk: Bytecode,
    /// From a cursor to a fragment.
    read: Bytecode,
    /// From a pixel and the number of fragments that the storage holds to the number that the effect reads, copies of a fragment included; and
    /// from the pixel to this fragment. Where iterations keep what earlier ones displace.
    copies: Option<(Bytecode, Bytecode)>,
    /// The key that no fragment of the k best exceeds, where the storage provides one.
    pub(crate) bound: Option<Bytecode>,
    /// The sources of the functions that read the entries, of the copies and of the bound.
    source: CheckedSource,
    copies_source: CheckedSource,
    bound_source: CheckedSource,
    /// The formats of textures, by the plan's resources.
    formats: Vec<Option<TextureFormat>>,
}

/// The most fragments that are read from a pixel. A longer walk is reported as endless.
const LONGEST: usize = 1 << 14;

impl ReadOut {
    /// Links and compiles the functions. The source is that of the profile, and all profiles read the same fragments.
    pub fn new(plan: &Plan, profile: Profile, registry: &Registry) -> Result<Self, Diagnostics> {
        let span = &plan.variant.name.span;
        let has_bound = plan.selection.provides().contains(&Capability::ConservativeBound);
        let registry = registry
            .clone()
            .with(probe_row(READ_OUT, include_str!("read_out.wgsl"), "checker/read_out.wgsl"))
            .with(probe_row(READ_BOUND, include_str!("read_bound.wgsl"), "checker/read_bound.wgsl"))
            .with(probe_row(READ_COPIES, include_str!("read_copies.wgsl"), "checker/read_copies.wgsl"));
        let has_copies = plan.selection.provides().contains(&Capability::KeepsLater);
        let names = std::iter::once(READ_OUT).chain(has_bound.then_some(READ_BOUND));
        let names = names.chain(has_copies.then_some(READ_COPIES));
        let passes = names.map(|name| probe_pass(plan, name)).collect();
        let linking = Linking { profile, form: Form::Program, prefix: String::new(), group: 0 };
        let sources = link(&Plan { passes, ..plan.clone() }, &linking, &registry)?.passes.into_iter();
        let checked = sources.map(|source| check(source, profile, span)).collect::<Result<Vec<_>, _>>()?;
        let formats: Vec<_> = plan.resources.iter().map(|planned| format(planned.resource.element)).collect();
        let compiled = |pass: &str, name: &str| {
            let of_pass = checked.iter().filter(|checked| checked.pass().name == pass);
            of_pass.map(|checked| function(checked, name, &formats, span)).next().transpose()
        };
        let source = |pass: &str| {
            checked.iter().find(|checked| checked.pass().name == pass).map(CheckedSource::of).unwrap_or_default()
        };
        let required = |name: &str| compiled(READ_OUT, name)?.ok_or_else(|| missing(READ_OUT, name, span));
        Ok(ReadOut {
            index: required("pixel_index")?,
            walk: required("walk_to")?,
            read: required("storage_read")?,
            copies: compiled(READ_COPIES, "count_read")?.zip(compiled(READ_COPIES, "copied")?),
            bound: compiled(READ_BOUND, "storage_bound")?,
            source: source(READ_OUT),
            copies_source: source(READ_COPIES),
            bound_source: source(READ_BOUND),
            formats,
        })
    }

    /// Returns the fragments of the pixel at a column and a row of the frame. A loss that the storage counts while it is
    /// read is counted in `frame`, once.
    pub fn pixel(&self, frame: &mut FrameMemory, at: [u32; 2]) -> Result<Vec<Vec<u32>>, ReadOutError> {
        let pixel = self.index(frame, at)?;
        self.entries(&mut frame.memory, frame.size, pixel)
    }

    /// Returns `storage_bound` of the pixel: no further fragment with a greater key is kept. `None`: the storage has no bound.
    pub fn bound(&self, frame: &mut FrameMemory, at: [u32; 2]) -> Result<Option<u32>, ReadOutError> {
        let Some(bound) = &self.bound else { return Ok(None) };
        let pixel = self.index(frame, at)?;
        Ok(self.call((bound, &self.bound_source), &[&[pixel]], &mut frame.memory, frame.size)?.first().copied())
    }

    fn index(&self, frame: &mut FrameMemory, at: [u32; 2]) -> Result<u32, ReadOutError> {
        let centre = at.map(|at| (at as f32 + 0.5).to_bits());
        Ok(self.call((&self.index, &self.source), &[&centre], &mut frame.memory, frame.size)?[0])
    }

    /// Returns the fragments of the pixel of this index.
    pub(crate) fn entries(
        &self,
        memory: &mut Memory,
        size: [u32; 2],
        pixel: u32,
    ) -> Result<Vec<Vec<u32>>, ReadOutError> {
        let mut entries = self.copies(memory, size, pixel)?;
        let copies = entries.len();
        let mut visited = BTreeSet::new();
        // No two entries share a word, so a pixel has no more entries than memory has words.
        let most = memory.iter().map(Vec::len).sum::<usize>().min(LONGEST);
        loop {
            // Each walk starts again and may count losses. Only the counts of the last walk, which reaches the end, are kept.
            let before = self.written(memory);
            let cursor =
                self.call((&self.walk, &self.source), &[&[pixel], &[(entries.len() - copies) as u32]], memory, size)?
                    [0];
            if cursor == u32::MAX {
                let stored = entries.len() - copies;
                entries.truncate(self.count_read(memory, size, [pixel, stored as u32])?.unwrap_or(entries.len()));
                return Ok(entries);
            }
            if !visited.insert(cursor) || entries.len() - copies == most {
                return Err(ReadOutError::Cycle);
            }
            before.into_iter().for_each(|(index, words)| memory[index] = words);
            entries.push(self.call((&self.read, &self.source), &[&[pixel], &[cursor]], memory, size)?);
        }
    }

    /// Returns the copies of a fragment that the pixel has beside those that the storage holds.
    fn copies(&self, memory: &mut Memory, size: [u32; 2], pixel: u32) -> Result<Vec<Vec<u32>>, ReadOutError> {
        let Some((_, copy)) = &self.copies else { return Ok(Vec::new()) };
        let count = self.count_read(memory, size, [pixel, 0])?.unwrap_or(0);
        let copy = self.call((copy, &self.copies_source), &[&[pixel]], memory, size)?;
        if count > LONGEST { Err(ReadOutError::Cycle) } else { Ok(vec![copy; count]) }
    }

    /// Returns how many fragments of a pixel the effect reads if the storage holds `stored`; `None`: all.
    fn count_read(
        &self,
        memory: &mut Memory,
        size: [u32; 2],
        [pixel, stored]: [u32; 2],
    ) -> Result<Option<usize>, ReadOutError> {
        let Some((count, _)) = &self.copies else { return Ok(None) };
        Ok(Some(self.call((count, &self.copies_source), &[&[pixel], &[stored]], memory, size)?[0] as usize))
    }

    /// Copies the buffers that a walk may write.
    fn written(&self, memory: &Memory) -> Vec<(usize, Vec<u32>)> {
        let written = self.walk.buffers.iter().filter(|buffer| buffer.is_written);
        let indices = written.map(|buffer| memory_index(buffer.binding));
        indices.filter_map(|index| Some((index, memory.get(index)?.clone()))).collect()
    }

    /// Calls one of the functions; returns its result.
    fn call(
        &self,
        (program, source): (&Bytecode, &CheckedSource),
        arguments: &[&[u32]],
        memory: &mut Memory,
        size: [u32; 2],
    ) -> Result<Vec<u32>, ReadOutError> {
        let mut machine = Machine::new(program);
        arguments.iter().enumerate().for_each(|(number, words)| machine.set_input(number, words));
        let indices: Vec<usize> = program.textures.iter().map(|texture| memory_index(texture.binding)).collect();
        let taken = |index: &usize| memory.get_mut(*index).map(std::mem::take).unwrap_or_default();
        let words: Vec<Vec<u32>> = indices.iter().map(taken).collect();
        let textures = indices.iter().zip(&words);
        let textures = textures.map(|(index, words)| SampledTexture::new(words, self.format(*index), size));
        let textures: Vec<SampledTexture<'_>> = textures.collect();
        let exit = with_buffers(program, memory, |buffers| {
            machine.run_or_repeat(&mut Reader::new(buffers, &textures), |reader| reader.changes)
        });
        indices.into_iter().zip(words).for_each(|(index, words)| memory[index] = words);
        let location = |at: u32| code_location(program, at, source);
        match (machine.out_of_bounds.take(), exit) {
            (Some(access), _) => Err(ReadOutError::OutOfBounds { location: location(access.at) }),
            (None, Exit::Ended) => Ok(machine.result().to_vec()),
            (None, _) => Err(ReadOutError::Endless { location: location(machine.at()) }),
        }
    }

    fn format(&self, index: usize) -> Option<TextureFormat> {
        index.checked_sub(FIRST_BINDING as usize).and_then(|index| *self.formats.get(index)?)
    }
}

fn format(element: Element) -> Option<TextureFormat> {
    match element {
        Element::Texture(format) => Some(format),
        _ => None,
    }
}

fn missing(pass: &str, function: &str, span: &SourceSpan) -> Diagnostics {
    let message = format!("the linked program has no pass `{pass}` to read `{function}` from");
    Diagnostic::new(codes::INTERNAL, span, message, "report it with the description").into()
}

/// Compiles a function of a pass if all textures that it reads have readable formats.
fn function(
    checked: &Checked,
    name: &str,
    formats: &[Option<TextureFormat>],
    span: &SourceSpan,
) -> Result<Bytecode, Diagnostics> {
    let program = Bytecode::function(checked.module(), checked.info(), name, &options(checked));
    let readable = program.and_then(|program| with_readable_textures(program, formats));
    readable.map_err(|unsupported| diagnostics(checked, &unsupported, span))
}

fn with_readable_textures(program: Bytecode, formats: &[Option<TextureFormat>]) -> Result<Bytecode, Vec<Unsupported>> {
    let format = |texture: &Texture| {
        let (_, binding) = texture.binding?;
        *formats.get(binding.checked_sub(FIRST_BINDING)? as usize)?
    };
    match program.textures.iter().all(|texture| format(texture).is_some_and(is_readable)) {
        true => Ok(program),
        false => program.without_textures(),
    }
}
