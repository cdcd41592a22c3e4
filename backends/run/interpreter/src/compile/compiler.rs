//! The state of a compilation: the instructions so far, the words that are in use and the function that is being inlined.
//!
//! The other files of this folder extend [`Compiler`] with one method per kind of IR node.

use std::collections::HashMap;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{Expression, Function, GlobalVariable, Handle, Module, Span, TypeInner};

use super::pointer::Pointer;
use crate::bytecode::{Buffer, Options, Texture, Unsupported};
use crate::layout::Layouts;
use crate::operation::{Op, Word};

/// The most instructions of one program: calls are inlined, so nested calls multiply.
const MAX_INSTRUCTIONS: usize = 1 << 20;

/// The description of a construct that the interpreter does not run, as an error.
pub(super) type Result<T> = std::result::Result<T, String>;

/// The compiled form of an expression.
#[derive(Clone, Copy, Debug)]
pub(super) enum Value {
    /// Consecutive words, from this one on.
    Words(Word),
    Pointer(Pointer),
    /// The texture of this number.
    Texture(u16),
}

/// The instructions and words of one program during its compilation.
pub(super) struct Compiler<'m> {
    pub(super) module: &'m Module,
    pub(super) info: &'m ModuleInfo,
    pub(super) layouts: Layouts<'m>,
    pub(super) options: &'m Options<'m>,
    pub(super) ops: Vec<Op>,
    pub(super) site_of: Vec<u32>,
    pub(super) sites: Vec<(Span, Option<u32>)>,
    pub(super) site: Option<u32>,
    /// Constants, numbered from `CONSTANT`.
    pub(super) constants: Vec<u32>,
    pub(super) constant_words: HashMap<u32, Word>,
    /// The initial words of private variables.
    pub(super) privates: Vec<u32>,
    pub(super) globals: HashMap<Handle<GlobalVariable>, Value>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) textures: Vec<Texture>,
    /// The first free word.
    pub(super) top: Word,
    /// The largest `top` so far.
    pub(super) peak: Word,
    pub(super) unsupported: Vec<Unsupported>,
    pub(super) callee: InlinedCall<'m>,
}

/// One call of a function while its body is compiled in place.
pub(super) struct InlinedCall<'m> {
    pub(super) function: &'m Function,
    pub(super) info: &'m FunctionInfo,
    pub(super) values: Vec<Option<Value>>,
    pub(super) arguments: Vec<Value>,
    pub(super) locals: Vec<Option<(Word, u32)>>,
    pub(super) result: Word,
    /// The site of the call.
    pub(super) caller: Option<u32>,
    /// Jumps to the end of the function, patched when the end is known.
    pub(super) returns: Vec<usize>,
    pub(super) loops: Vec<PendingJumps>,
}

/// Jumps out of a loop or switch, patched when their targets are known.
#[derive(Default)]
pub(super) struct PendingJumps {
    pub(super) breaks: Vec<usize>,
    pub(super) continues: Vec<usize>,
    pub(super) is_loop: bool,
}

impl<'m> InlinedCall<'m> {
    pub(super) fn new(function: &'m Function, info: &'m FunctionInfo, result: Word, caller: Option<u32>) -> Self {
        InlinedCall {
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
    pub(super) fn new(
        module: &'m Module,
        info: &'m ModuleInfo,
        options: &'m Options<'m>,
        callee: InlinedCall<'m>,
    ) -> Self {
        Compiler {
            module,
            info,
            layouts: Layouts::new(module),
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
            peak: 0,
            unsupported: Vec::new(),
            callee,
        }
    }

    /// Allocates words and returns the first.
    pub(super) fn take(&mut self, words: u32) -> Word {
        let first = self.top;
        self.top += words;
        self.peak = self.peak.max(self.top);
        first
    }

    /// Appends an instruction and returns its index.
    pub(super) fn push(&mut self, op: Op) -> usize {
        if self.ops.len() == MAX_INSTRUCTIONS {
            self.report_unsupported("a program of more than a million instructions".to_owned());
        }
        if self.ops.len() <= MAX_INSTRUCTIONS {
            let site = self.site.unwrap_or_else(|| self.new_site(Span::UNDEFINED));
            self.ops.push(op);
            self.site_of.push(site);
        }
        self.ops.len() - 1
    }

    /// Sets the source span of the instructions that follow.
    pub(super) fn at(&mut self, span: Span) {
        let site = (span, self.callee.caller);
        if self.site.and_then(|site| self.sites.get(site as usize)) != Some(&site) {
            self.new_site(span);
        }
    }

    fn new_site(&mut self, span: Span) -> u32 {
        let site = self.sites.len() as u32;
        self.sites.push((span, self.callee.caller));
        self.site = Some(site);
        site
    }

    /// Records an unsupported construct at the current span.
    pub(super) fn report_unsupported(&mut self, what: String) {
        let span = self.site.and_then(|site| self.sites.get(site as usize)).map_or(Span::UNDEFINED, |(span, _)| *span);
        let error = Unsupported { what, span };
        if !self.unsupported.contains(&error) {
            self.unsupported.push(error);
        }
    }

    /// Returns the type of an expression.
    pub(super) fn type_of(&self, expression: Handle<Expression>) -> &'m TypeInner {
        self.callee.info[expression].ty.inner_with(&self.module.types)
    }
}
