//! From a validated module to a finished program.
//!
//! WGSL has no recursion, so every call is inlined: a machine needs no call stack, a frame is a fixed row of words, and
//! what matters at each instruction can be computed. Frames of calls that follow each other share their words. All that
//! cannot be run is collected; nothing is guessed.

mod access;
mod call;
mod constant;
mod convert;
mod expression;
mod finish;
mod flow;
mod math;
mod matrix;
mod number;
mod place;
mod texture;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{AddressSpace, Expression, Function, Handle, Module, Span, TypeInner};
use std::collections::HashMap;

use crate::operation::{Op, Word};
use crate::program::{Buffer, Options, Program, Space, Texture, Unsupported};
use crate::shape::Shapes;
use place::Spot;

/// Instructions of one program at most: calls are inlined, and calls of calls of calls add up.
const LARGEST: usize = 1 << 20;

/// What a private variable begins with whose initial value nothing reads: no index, no depth, no EMPTY.
const UNWRITTEN: Word = 0xdead_beef;

/// What an expression has become.
#[derive(Clone, Copy, Debug)]
pub(super) enum Value {
    /// Words from this one on.
    Words(Word),
    /// A place that a pointer points to.
    Spot(Spot),
    /// The texture of this number.
    Texture(u16),
}

/// Makes one program.
pub(super) struct Compiler<'m> {
    pub(super) module: &'m Module,
    pub(super) info: &'m ModuleInfo,
    pub(super) shapes: Shapes<'m>,
    options: &'m Options<'m>,
    pub(super) ops: Vec<Op>,
    site_of: Vec<u32>,
    sites: Vec<(Span, Option<u32>)>,
    site: Option<u32>,
    /// Constants, from number `CONSTANT` on.
    constants: Vec<u32>,
    constant_words: HashMap<u32, Word>,
    /// Words of private variables and what they begin with.
    privates: Vec<u32>,
    globals: HashMap<Handle<naga::GlobalVariable>, Value>,
    buffers: Vec<Buffer>,
    pub(super) textures: Vec<Texture>,
    /// The first word that is free, and the most that were ever taken.
    pub(super) top: Word,
    highest: Word,
    faults: Vec<Unsupported>,
    pub(super) frame: Frame<'m>,
}

/// The function that is being compiled, once per call of it.
pub(super) struct Frame<'m> {
    pub(super) function: &'m Function,
    pub(super) info: &'m FunctionInfo,
    pub(super) values: Vec<Option<Value>>,
    pub(super) arguments: Vec<Value>,
    pub(super) locals: Vec<Option<(Word, u32)>>,
    pub(super) result: Word,
    /// The site of the call.
    caller: Option<u32>,
    /// Jumps to the end of the function, to be told where that is.
    pub(super) returns: Vec<usize>,
    loops: Vec<flow::Jumps>,
}

/// A construct that cannot be run, in words.
pub(super) type Result<T> = std::result::Result<T, String>;

pub(crate) fn entry_point<'m>(
    module: &'m Module,
    info: &'m ModuleInfo,
    name: &str,
    options: &'m Options<'m>,
) -> std::result::Result<Program, Vec<Unsupported>> {
    let found = module.entry_points.iter().position(|entry| entry.name == name);
    let Some(index) = found else { return Err(nothing_called(name)) };
    let entry = &module.entry_points[index];
    let size = entry.workgroup_size.map(|length| length.max(1));
    compile(module, info, &entry.function, info.get_entry_point(index), options, size)
}

pub(crate) fn function<'m>(
    module: &'m Module,
    info: &'m ModuleInfo,
    name: &str,
    options: &'m Options<'m>,
) -> std::result::Result<Program, Vec<Unsupported>> {
    let found = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(name));
    let Some((handle, function)) = found else { return Err(nothing_called(name)) };
    compile(module, info, function, &info[handle], options, [1; 3])
}

fn nothing_called(name: &str) -> Vec<Unsupported> {
    vec![Unsupported { what: format!("`{name}`, which the module does not have"), span: Span::UNDEFINED }]
}

fn compile<'m>(
    module: &'m Module,
    info: &'m ModuleInfo,
    function: &'m Function,
    function_info: &'m FunctionInfo,
    options: &'m Options<'m>,
    workgroup_size: [u32; 3],
) -> std::result::Result<Program, Vec<Unsupported>> {
    let mut compiler = Compiler {
        module,
        info,
        shapes: Shapes::new(module),
        options,
        ops: Vec::new(),
        site_of: Vec::new(),
        sites: Vec::new(),
        site: None,
        constants: Vec::new(),
        constant_words: HashMap::new(),
        privates: Vec::new(),
        globals: HashMap::new(),
        buffers: Vec::new(),
        textures: Vec::new(),
        top: 0,
        highest: 0,
        faults: Vec::new(),
        frame: Frame::new(function, function_info, 0, None),
    };
    compiler.globals(function_info);
    match compiler.whole(function) {
        Err(what) => {
            compiler.refuse(what);
            Err(compiler.faults)
        }
        Ok(_) if !compiler.faults.is_empty() => Err(compiler.faults),
        Ok((inputs, outputs)) => Ok(compiler.finish(inputs, outputs, workgroup_size)),
    }
}

impl<'m> Frame<'m> {
    fn new(function: &'m Function, info: &'m FunctionInfo, result: Word, caller: Option<u32>) -> Self {
        Frame {
            function,
            info,
            values: vec![None; function.expressions.len()],
            arguments: Vec::new(),
            locals: vec![None; function.local_variables.len()],
            result,
            caller,
            returns: Vec::new(),
            loops: Vec::new(),
        }
    }
}

impl<'m> Compiler<'m> {
    /// Gives every global variable that the program may reach its place.
    fn globals(&mut self, info: &FunctionInfo) {
        for (handle, variable) in self.module.global_variables.iter() {
            if info[handle].is_empty() {
                continue;
            }
            let span = self.module.global_variables.get_span(handle);
            match self.global(variable) {
                Ok(value) => {
                    self.globals.insert(handle, value);
                }
                Err(what) => self.faults.push(Unsupported { what, span }),
            }
        }
        self.top = self.privates.len() as Word;
        self.highest = self.top;
    }

    fn global(&mut self, variable: &naga::GlobalVariable) -> Result<Value> {
        let inner = self.shapes.inner(variable.ty);
        let space = match variable.space {
            AddressSpace::Private => {
                let words = match variable.init {
                    Some(init) => self.constant_value(init)?,
                    None => vec![self.initial(variable); self.shapes.dense(inner)? as usize],
                };
                let first = self.privates.len() as Word;
                let length = words.len() as u32;
                self.privates.extend(words);
                return Ok(Value::Spot(Spot::local(first, length)));
            }
            AddressSpace::Uniform => Space::Uniform,
            AddressSpace::Storage { .. } => Space::Storage,
            AddressSpace::WorkGroup => Space::Workgroup,
            AddressSpace::Handle => return self.texture(variable),
            _ => return Err("this kind of variable".to_owned()),
        };
        let number = u16::try_from(self.buffers.len()).map_err(|_| "so many buffers".to_owned())?;
        self.buffers.push(Buffer {
            name: variable.name.clone().unwrap_or_default(),
            binding: variable.binding.map(|binding| (binding.group, binding.binding)),
            space,
            words: self.least_words(inner)?,
            is_written: false,
            commutes: false,
            is_coherent: variable.memory_decorations.contains(naga::MemoryDecorations::COHERENT),
            is_wide: false,
        });
        Ok(Value::Spot(Spot::shared(number)))
    }

    /// The words of a private variable that has no value of its own.
    fn initial(&self, variable: &naga::GlobalVariable) -> Word {
        let is_written_first = |name: &String| self.options.written_first.contains(name);
        if variable.name.as_ref().is_some_and(is_written_first) { UNWRITTEN } else { 0 }
    }

    /// Words of a buffer, arrays of unknown length not counted.
    fn least_words(&self, inner: &TypeInner) -> Result<u32> {
        match inner {
            TypeInner::Array { size: naga::ArraySize::Dynamic, .. } => Ok(0),
            TypeInner::Array { size: naga::ArraySize::Constant(length), stride, .. } => Ok(length.get() * stride / 4),
            TypeInner::Struct { members, span } => {
                let last = members.last().map(|member| self.shapes.inner(member.ty));
                let is_open = matches!(last, Some(TypeInner::Array { size: naga::ArraySize::Dynamic, .. }));
                Ok(if is_open { members.last().map_or(0, |member| member.offset / 4) } else { span / 4 })
            }
            other => {
                let mut numbers = Vec::new();
                self.shapes.numbers(other, 0, &mut numbers)?;
                Ok(numbers.iter().map(|(at, words)| at + words).max().unwrap_or(0))
            }
        }
    }

    /// Takes words of the frame.
    pub(super) fn take(&mut self, words: u32) -> Word {
        let first = self.top;
        self.top += words;
        self.highest = self.highest.max(self.top);
        first
    }

    /// Adds an instruction.
    pub(super) fn push(&mut self, op: Op) -> usize {
        if self.ops.len() == LARGEST {
            self.refuse("a program of more than a million instructions".to_owned());
        }
        if self.ops.len() <= LARGEST {
            let site = self.site.unwrap_or_else(|| self.new_site(Span::UNDEFINED));
            self.ops.push(op);
            self.site_of.push(site);
        }
        self.ops.len() - 1
    }

    /// From here on, instructions come from `span`.
    pub(super) fn at(&mut self, span: Span) {
        let site = (span, self.frame.caller);
        if self.site.and_then(|site| self.sites.get(site as usize)) != Some(&site) {
            self.new_site(span);
        }
    }

    fn new_site(&mut self, span: Span) -> u32 {
        let site = self.sites.len() as u32;
        self.sites.push((span, self.frame.caller));
        self.site = Some(site);
        site
    }

    /// Notes that something cannot be run.
    pub(super) fn refuse(&mut self, what: String) {
        let span = self.site.and_then(|site| self.sites.get(site as usize)).map_or(Span::UNDEFINED, |(span, _)| *span);
        let fault = Unsupported { what, span };
        if !self.faults.contains(&fault) {
            self.faults.push(fault);
        }
    }

    /// The type of an expression.
    pub(super) fn type_of(&self, expression: Handle<Expression>) -> &'m TypeInner {
        self.frame.info[expression].ty.inner_with(&self.module.types)
    }
}
