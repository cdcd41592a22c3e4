//! Global variables: private variables become words, the others buffers and textures.

use std::ops::Range;

use naga::valid::FunctionInfo;
use naga::{AddressSpace, ArraySize, GlobalVariable, Handle, MemoryDecorations, Scalar, TypeInner};

use super::compiler::{Compiler, Result, Value};
use super::pointer::Pointer;
use crate::bytecode::{Buffer, Space, Unsupported};
use crate::operation::Word;

/// The most ranges of words of atomic types in one buffer.
const MOST_RANGES: usize = 1 << 16;

/// The initial word of a private variable that the program writes before it reads: no index, no depth and not EMPTY.
const UNWRITTEN: Word = 0xdead_beef;

impl Compiler<'_> {
    /// Declares every global variable that the program may access.
    pub(super) fn declare_globals(&mut self, info: &FunctionInfo) {
        for (handle, variable) in self.module.global_variables.iter() {
            if info[handle].is_empty() {
                continue;
            }
            let span = self.module.global_variables.get_span(handle);
            match self.global(variable) {
                Ok(value) => {
                    self.globals.insert(handle, value);
                }
                Err(what) => self.unsupported.push(Unsupported { what, span }),
            }
        }
        self.top = self.privates.len() as Word;
        self.peak = self.top;
    }

    fn global(&mut self, variable: &GlobalVariable) -> Result<Value> {
        let inner = self.layouts.inner(variable.ty);
        let space = match variable.space {
            AddressSpace::Private => {
                let words = match variable.init {
                    Some(init) => self.constant_value(init)?,
                    None => vec![self.initial_word(variable); self.layouts.dense(inner)? as usize],
                };
                let first = self.privates.len() as Word;
                let length = words.len() as u32;
                self.privates.extend(words);
                return Ok(Value::Pointer(Pointer::to_variable(first, length)));
            }
            AddressSpace::Uniform => Space::Uniform,
            AddressSpace::Storage { .. } => Space::Storage,
            AddressSpace::WorkGroup => Space::Workgroup,
            AddressSpace::Handle => return self.texture(variable),
            _ => return Err("a variable of this address space".to_owned()),
        };
        if space == Space::Workgroup && self.is_composite_of_booleans(inner) {
            return Err("workgroup variables of several booleans".to_owned());
        }
        let number = u16::try_from(self.buffers.len()).map_err(|_| "more than 65536 buffers".to_owned())?;
        let element = self.open_element(inner);
        self.buffers.push(Buffer {
            name: variable.name.clone().unwrap_or_default(),
            binding: variable.binding.map(|binding| (binding.group, binding.binding)),
            space,
            words: self.least_words(inner)?,
            element_words: element.as_ref().map_or(0, |(_, words)| *words),
            is_written: false,
            commutes: false,
            is_coherent: variable.memory_decorations.contains(MemoryDecorations::COHERENT),
            is_mixed: false,
            is_wide: false,
            initial: if self.options.writes_workgroup_first { UNWRITTEN } else { 0 },
            atomics: self.atomics(inner)?,
            element_atomics: element.map_or(Ok(Vec::new()), |(element, _)| self.atomics(element))?,
        });
        Ok(Value::Pointer(Pointer::to_buffer(number)))
    }

    /// Returns the initial word of a private variable without an initialiser.
    fn initial_word(&self, variable: &GlobalVariable) -> Word {
        let is_written_first = |name: &String| self.options.written_first.contains(name);
        if variable.name.as_ref().is_some_and(is_written_first) { UNWRITTEN } else { 0 }
    }

    /// Returns whether a type has booleans as parts. WGSL does not lay them out.
    fn is_composite_of_booleans(&self, inner: &TypeInner) -> bool {
        let has = |kind: &Handle<naga::Type>| {
            let inner = self.layouts.inner(*kind);
            crate::layout::scalar_of(inner) == Some(Scalar::BOOL) || self.is_composite_of_booleans(inner)
        };
        match inner {
            TypeInner::Array { base, .. } => has(base),
            TypeInner::Struct { members, .. } => members.iter().any(|member| has(&member.ty)),
            TypeInner::Vector { scalar, .. } => *scalar == Scalar::BOOL,
            _ => false,
        }
    }

    /// Returns the element of the runtime-sized array at the end of a buffer, and the distance between two in words.
    fn open_element<'t>(&'t self, inner: &'t TypeInner) -> Option<(&'t TypeInner, u32)> {
        match inner {
            TypeInner::Array { base, size: ArraySize::Dynamic, stride } => {
                Some((self.layouts.inner(*base), stride / 4))
            }
            TypeInner::Struct { members, .. } => {
                members.last().and_then(|member| self.open_element(self.layouts.inner(member.ty)))
            }
            _ => None,
        }
    }

    /// Returns the words of atomic types in a value in a buffer, without a runtime-sized array.
    fn atomics(&self, inner: &TypeInner) -> Result<Vec<Range<u32>>> {
        let mut ranges: Vec<Range<u32>> = Vec::new();
        let mut add = |range: Range<u32>| match ranges.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => ranges.push(range),
        };
        match inner {
            TypeInner::Atomic(scalar) => add(0..u32::from(scalar.width) / 4),
            TypeInner::Struct { members, .. } => {
                for member in members {
                    let inside = self.atomics(self.layouts.inner(member.ty))?;
                    let first = member.offset / 4;
                    inside.into_iter().for_each(|range| add(first + range.start..first + range.end));
                }
            }
            TypeInner::Array { base, size: ArraySize::Constant(length), stride } => {
                let inside = self.atomics(self.layouts.inner(*base))?;
                let count = if inside.is_empty() { 0 } else { length.get() };
                if let [range] = inside.as_slice()
                    && *range == (0..stride / 4)
                {
                    return Ok(std::iter::once(0..count.saturating_mul(stride / 4)).collect());
                }
                if count as usize * inside.len() > MOST_RANGES {
                    return Err("an array of so many structures with atomic members".to_owned());
                }
                for first in (0..count).map(|number| number * (stride / 4)) {
                    inside.iter().for_each(|range| add(first + range.start..first + range.end));
                }
            }
            _ => {}
        }
        Ok(ranges)
    }

    /// Returns the words of a buffer without a runtime-sized array at its end.
    fn least_words(&self, inner: &TypeInner) -> Result<u32> {
        match inner {
            TypeInner::Array { size: ArraySize::Dynamic, .. } => Ok(0),
            TypeInner::Array { size: ArraySize::Constant(length), stride, .. } => Ok(length.get() * stride / 4),
            TypeInner::Struct { members, span } => {
                let last = members.last().map(|member| self.layouts.inner(member.ty));
                let is_open = matches!(last, Some(TypeInner::Array { size: ArraySize::Dynamic, .. }));
                Ok(if is_open { members.last().map_or(0, |member| member.offset / 4) } else { span / 4 })
            }
            other => {
                let mut scalars = Vec::new();
                self.layouts.scalars(other, 0, &mut scalars)?;
                Ok(scalars.iter().map(|(at, words)| at + words).max().unwrap_or(0))
            }
        }
    }
}
