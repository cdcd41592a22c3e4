//! Effects that can be interrupted between two fragments: their parts as functions.
//!
//! Input: a checked closure, and its parts. Output: three WGSL functions, which keep variables in members of one struct. Everything else is
//! lowered as in the whole closure.

use fragbuf_model::SourceSpan;
use fragbuf_model::resumable::{COUNT, PROGRESS, Progress, RESULT, RESUMED, Uninterruptible};

use super::lines::WgslFunction;
use super::lowering::{Destination, Lowering};
use crate::environment::Signature;
use crate::resumable::{Parts, parts};
use crate::tree::{Expr, For, Function, Sequence, Statement, VariableId};

/// The parts of an effect in WGSL.
pub(crate) struct ResumableSource {
    /// The names and WGSL types of what is kept.
    pub members: Vec<(String, String)>,
    pub begin: WgslFunction,
    pub advance: WgslFunction,
    pub end: WgslFunction,
}

/// The names of the functions.
pub(crate) const NAMES: [&str; 3] = ["user_resolve_begin", "user_resolve_advance", "user_resolve_end"];

/// Lowers a closure as parts.
pub(crate) fn resumable(function: &Function, helpers: &[Signature]) -> Result<ResumableSource, Uninterruptible> {
    let parts = parts(function)?;
    let [begin_name, advance_name, end_name] = NAMES;
    let lowering = || {
        let mut lowering = Lowering::new(function, helpers);
        let members = lowering.keep(&parts.kept);
        (lowering, members)
    };
    let (begin, members) = lowering();
    let begin = begin.part(begin_name, "", |lowering| lowering.before(&parts));
    let (mut advance, _) = lowering();
    advance.is_in_effect = true;
    let mut returns = false;
    let advance = advance.part(advance_name, "", |lowering| {
        lowering.constants(parts.constants_of(&parts.each.body.statements, parts.each.body.value.as_deref()));
        lowering.each_resumed(parts.each, parts.loop_span);
        returns = lowering.returns_in_effect;
    });
    let (end, _) = lowering();
    let end = end.part(end_name, &format!(" -> {}", function.result.wgsl()), |lowering| {
        lowering.constants(parts.constants_of(parts.after, parts.value));
        lowering.statements(parts.after);
        parts.value.iter().for_each(|value| lowering.store(value, &Destination::Return));
    });
    let own = |name: &str, ty: &str| (name.to_owned(), ty.to_owned());
    let has_index = matches!(parts.each.sequence, Sequence::Fragments { index: Some(_), .. });
    let own = [
        Some(own(PROGRESS, "u32")),
        has_index.then(|| own(COUNT, "u32")),
        returns.then(|| own(RESULT, function.result.wgsl())),
    ];
    let members = own.into_iter().flatten().chain(members).collect();
    Ok(ResumableSource { members, begin, advance, end })
}

impl Lowering<'_> {
    /// Gives the variables the names of members. Returns the members.
    fn keep(&mut self, kept: &[VariableId]) -> Vec<(String, String)> {
        self.names.open();
        for own in [PROGRESS, COUNT, RESULT] {
            self.names.fresh(own);
        }
        let mut members = Vec::new();
        for id in kept {
            let Some(variable) = self.function.variables.get(*id) else { continue };
            let ty = self.function.inference.resolve_or_default(variable.ty);
            let member = self.names.fresh(&variable.name);
            self.set_name(*id, format!("{RESUMED}.{member}"));
            self.kept.insert(*id);
            members.push((member, ty.wgsl().to_owned()));
        }
        // Members do not hide the names of variables.
        self.names.close();
        members
    }

    fn part(mut self, name: &str, result: &str, contents: impl FnOnce(&mut Self)) -> WgslFunction {
        let function = self.function;
        self.lines.push(format!("fn {name}(){result} {{"), &function.span);
        self.lines.indent();
        contents(&mut self);
        self.lines.dedent();
        self.lines.push("}".to_string(), &function.body.end);
        self.lines.finish()
    }

    /// Writes what is before the loop, without constants that only later parts read.
    fn before(&mut self, parts: &Parts<'_>) {
        let needed = parts.constants_before();
        for statement in parts.before {
            if !parts.is_constant(statement) || needed.iter().any(|other| std::ptr::eq(*other, statement)) {
                self.one_statement(statement);
            }
        }
    }

    fn constants(&mut self, statements: Vec<&Statement>) {
        statements.into_iter().for_each(|statement| self.one_statement(statement));
    }

    /// Writes the loop over the fragments. The index counts those of earlier iterations too.
    fn each_resumed(&mut self, each: &For, span: &SourceSpan) {
        let Sequence::Fragments { index, fragment, .. } = each.sequence else { return };
        let name = self.user_name(fragment.or(index), "f");
        let counter = self.names.fresh(&format!("{name}_index"));
        self.emit(format!("for (var {counter} = 0u; {counter} < layer_count(); {counter}++) {{"), span);
        self.is_in_each = true;
        self.body(&each.body, |lowering| {
            if index.is_some() {
                let name = lowering.declare(index, "index");
                lowering.emit(format!("let {name} = {RESUMED}.{COUNT} + {counter};"), span);
            }
            if fragment.is_some() {
                let name = lowering.declare(fragment, "f");
                lowering.emit(format!("let {name} = layer({counter});"), span);
            }
        });
        self.is_in_each = false;
        self.dead = false;
        if index.is_some() {
            self.emit(format!("{RESUMED}.{COUNT} += layer_count();"), span);
        }
    }

    /// Writes how far the effect is, before the jump out of its loop.
    pub(super) fn progress(&mut self, progress: Progress, span: &SourceSpan) {
        self.emit(format!("{RESUMED}.{PROGRESS} = {};", progress.wgsl()), span);
    }

    /// Writes the return of a value from within the loop of the effect.
    pub(super) fn return_in_effect(&mut self, expr: &Expr) {
        let source = self.value(expr);
        self.emit(format!("{RESUMED}.{RESULT} = {};", source.source), &expr.span);
        self.progress(Progress::Returned, &expr.span);
        self.emit("return;".to_string(), &expr.span);
        self.returns_in_effect = true;
        self.dead = true;
    }
}
