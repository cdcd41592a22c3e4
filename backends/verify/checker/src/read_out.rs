//! What a pixel holds, read through the storage's own functions: `storage_first`, `storage_next`, `storage_read`.
//!
//! In: a plan, and the words of its resources after a frame, whatever device drew it. Out: the fragments of a pixel, each as
//! its words in memory, the key first, in the order in which the storage gives them. The functions are linked into a compute
//! pass and run by the interpreter, so no layout of any storage is stated here, and a user's storage is read like ours.

use std::collections::BTreeSet;

use fragbuf_targets::{Checked, check};
use fragbuf_codegen::{FIRST_BINDING, Form, Linking, Plan, Profile, link};
use fragbuf_interpreter::{Exit, Machine, Program, Texture, Unsupported};
use fragbuf_model::{Diagnostics, Origin};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Element, Fact, TextureFormat};

use crate::frame::{Memory, with_buffers};
use crate::frame_memory::{FrameMemory, ReadOutError};
use crate::question::{question, row};
use crate::sampled::{Reader, Sampled, is_read};
use crate::subject::{Subject, options, refused};

/// The passes, each a file.
const READ_OUT: &str = "read_out";
const READ_BOUND: &str = "read_bound";

/// The functions that read a pixel out, ready to run. They belong to one plan, and to frames drawn with it.
///
/// ```
/// use fragbuf_checker::{FrameMemory, ReadOut};
/// use fragbuf_codegen::{Profile, plan};
/// use fragbuf_model::{Draft, Origin, Selection, check};
/// use fragbuf_templates::Registry;
///
/// let registry = Registry::builtin();
/// let draft = Draft::from_technique("kb", &Origin::new("mine", 1, 1));
/// let variant = check(&draft, &registry).expect("a legal description");
/// let plan = plan(&variant, &Selection::first(&variant), &registry).expect("a plan");
/// let read_out = ReadOut::new(&plan, Profile::Native, &registry).expect("programs");
///
/// // A frame of one pixel and k = 2 of which nothing is drawn: this storage's empty slots are all ones.
/// let symbol = |name: &str| [("width", 1), ("height", 1), ("k", 2)].into_iter().find(|one| one.0 == name).map(|one| one.1);
/// let mut frame = FrameMemory::new(&plan, [1, 1], symbol, |_| Some(vec![u32::MAX; 4]));
/// assert_eq!(read_out.pixel(&mut frame, [0, 0]), Ok(Vec::new()));
/// ```
#[derive(Debug)]
pub struct ReadOut {
    /// From a position in the frame to the pixel's index.
    index: Program,
    /// The cursor after so many fragments of a pixel. A walk is one invocation, because a storage may count along the way.
    walk: Program,
    /// From a cursor to a fragment.
    read: Program,
    /// The key that no fragment of the k best exceeds, where the storage promises one.
    pub(crate) bound: Option<Program>,
    /// The formats of textures, by the plan's resources.
    formats: Vec<Option<TextureFormat>>,
}

/// Fragments of a pixel that are read at most: a walk that goes on behind them is said to have no end.
const LONGEST: usize = 1 << 14;

impl ReadOut {
    /// Links and compiles the functions. The texts are those of the profile; of what a pixel holds they say the same.
    pub fn new(plan: &Plan, profile: Profile, registry: &Registry) -> Result<Self, Diagnostics> {
        let origin = &plan.variant.name.origin;
        let has_bound = plan.selection.offers().contains(&Fact::BoundAnyInstant);
        let registry = registry
            .clone()
            .with(row(READ_OUT, include_str!("read_out.wgsl"), "checker/read_out.wgsl"))
            .with(row(READ_BOUND, include_str!("read_bound.wgsl"), "checker/read_bound.wgsl"));
        let asked = [(READ_OUT, true), (READ_BOUND, has_bound)].into_iter().filter(|(_, is_asked)| *is_asked);
        let passes = asked.map(|(anchor, _)| question(plan, anchor)).collect();
        let linking = Linking { profile, form: Form::Program, prefix: String::new(), group: 0 };
        let texts = link(&Plan { passes, ..plan.clone() }, &linking, &registry)?.passes.into_iter();
        let checked = texts.map(|text| check(text, profile, origin)).collect::<Result<Vec<_>, _>>()?;
        let formats: Vec<_> = plan.resources.iter().map(|planned| format(planned.resource.element)).collect();
        let ask = |anchor: &str, name: &str| {
            let of_pass = checked.iter().filter(|checked| checked.pass().anchor == anchor);
            of_pass.map(|checked| function(checked, name, &formats, origin)).next().transpose()
        };
        let needed = |name: &str| ask(READ_OUT, name)?.ok_or_else(Diagnostics::new);
        Ok(ReadOut {
            index: needed("pixel_index")?,
            walk: needed("walk_to")?,
            read: needed("storage_read")?,
            bound: ask(READ_BOUND, "storage_bound")?,
            formats,
        })
    }

    /// The fragments of the pixel at a column and a row of the frame. Losses that the storage counts while it is read are
    /// counted in `frame`, once.
    pub fn pixel(&self, frame: &mut FrameMemory, at: [u32; 2]) -> Result<Vec<Vec<u32>>, ReadOutError> {
        let pixel = self.index(frame, at)?;
        self.entries(&mut frame.memory, frame.size, pixel)
    }

    /// `storage_bound` of the pixel: no further fragment of a greater key is kept. `None`: the storage states no bound.
    pub fn bound(&self, frame: &mut FrameMemory, at: [u32; 2]) -> Result<Option<u32>, ReadOutError> {
        let Some(bound) = &self.bound else { return Ok(None) };
        let pixel = self.index(frame, at)?;
        Ok(self.ask(bound, &[&[pixel]], &mut frame.memory, frame.size)?.first().copied())
    }

    fn index(&self, frame: &mut FrameMemory, at: [u32; 2]) -> Result<u32, ReadOutError> {
        let middle = at.map(|at| (at as f32 + 0.5).to_bits());
        Ok(self.ask(&self.index, &[&middle], &mut frame.memory, frame.size)?[0])
    }

    /// The fragments of the pixel of this index.
    pub(crate) fn entries(
        &self,
        memory: &mut Memory,
        size: [u32; 2],
        pixel: u32,
    ) -> Result<Vec<Vec<u32>>, ReadOutError> {
        let mut entries = Vec::new();
        let mut passed = BTreeSet::new();
        // No two entries share a word, so there are no more of them than words.
        let most = memory.iter().map(Vec::len).sum::<usize>().min(LONGEST);
        loop {
            // Of what walks count only that of the last is kept, which goes through to the end.
            let before = self.written(memory);
            let cursor = self.ask(&self.walk, &[&[pixel], &[entries.len() as u32]], memory, size)?[0];
            if cursor == u32::MAX {
                return Ok(entries);
            }
            if !passed.insert(cursor) || entries.len() == most {
                return Err(ReadOutError::Endless);
            }
            before.into_iter().for_each(|(home, words)| memory[home] = words);
            entries.push(self.ask(&self.read, &[&[pixel], &[cursor]], memory, size)?);
        }
    }

    /// What a walk may change, as it is.
    fn written(&self, memory: &Memory) -> Vec<(usize, Vec<u32>)> {
        let written = self.walk.buffers.iter().filter(|buffer| buffer.is_written);
        let homes = written.map(|buffer| Subject::memory_of(buffer.binding));
        homes.filter_map(|home| Some((home, memory.get(home)?.clone()))).collect()
    }

    fn ask(
        &self,
        program: &Program,
        arguments: &[&[u32]],
        memory: &mut Memory,
        size: [u32; 2],
    ) -> Result<Vec<u32>, ReadOutError> {
        let mut machine = Machine::new(program);
        arguments.iter().enumerate().for_each(|(number, words)| machine.set_input(number, words));
        let homes: Vec<usize> = program.textures.iter().map(|one| Subject::memory_of(one.binding)).collect();
        let lent = |home: &usize| memory.get_mut(*home).map(std::mem::take).unwrap_or_default();
        let words: Vec<Vec<u32>> = homes.iter().map(lent).collect();
        let bound = homes.iter().zip(&words).map(|(home, words)| Sampled::new(words, self.format(*home), size));
        let textures: Vec<Sampled<'_>> = bound.collect();
        let exit = with_buffers(program, memory, |buffers| machine.run(&mut Reader::new(buffers, &textures)));
        homes.into_iter().zip(words).for_each(|(home, words)| memory[home] = words);
        match (machine.fault.take(), exit) {
            (Some(_), _) => Err(ReadOutError::OutOfBounds),
            (None, Exit::Ended) => Ok(machine.result().to_vec()),
            (None, _) => Err(ReadOutError::Endless),
        }
    }

    fn format(&self, home: usize) -> Option<TextureFormat> {
        home.checked_sub(FIRST_BINDING as usize).and_then(|index| *self.formats.get(index)?)
    }
}

fn format(element: Element) -> Option<TextureFormat> {
    match element {
        Element::Texture(format) => Some(format),
        _ => None,
    }
}

/// A function of a pass, if it reads no textures but those that can be read here.
fn function(
    checked: &Checked,
    name: &str,
    formats: &[Option<TextureFormat>],
    origin: &Origin,
) -> Result<Program, Diagnostics> {
    let program = Program::function(checked.module(), checked.info(), name, &options(checked));
    program.and_then(|program| readable(program, formats)).map_err(|faults| refused(checked, &faults, origin))
}

fn readable(program: Program, formats: &[Option<TextureFormat>]) -> Result<Program, Vec<Unsupported>> {
    let format = |texture: &Texture| {
        let (_, binding) = texture.binding?;
        *formats.get(binding.checked_sub(FIRST_BINDING)? as usize)?
    };
    match program.textures.iter().all(|texture| format(texture).is_some_and(is_read)) {
        true => Ok(program),
        false => program.without_textures(),
    }
}
