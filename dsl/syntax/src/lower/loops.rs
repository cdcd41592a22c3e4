//! `for`: over a range, or over the fragments of a pixel.
//!
//! Input: a typed loop. Output: WGSL's `for`. Loops over ranges are in `ranges.rs`.

use fragbuf_model::SourceSpan;

use super::lowering::{Destination, Lowering};
use super::source::{ExprSource, Precedence};
use crate::tree::{Block, For, Sequence, VariableId};

impl Lowering<'_> {
    /// Writes a loop.
    pub(super) fn for_loop(&mut self, each: &For, span: &SourceSpan) {
        if self.dead {
            return;
        }
        match &each.sequence {
            Sequence::Range { .. } => {
                let is_in_each = std::mem::take(&mut self.is_in_each);
                self.range_loop(&each.sequence, &each.body, span);
                self.is_in_each = is_in_each;
                return;
            }
            Sequence::Fragments { index, fragment, reversed: false } => {
                self.names.open();
                self.each_fragment(*index, *fragment, &each.body, span);
            }
            Sequence::Fragments { index, fragment, reversed: true } => {
                self.names.open();
                self.each_fragment_backward(*index, *fragment, &each.body, span);
            }
        }
        self.names.close();
        self.dead = false;
    }

    fn each_fragment(
        &mut self,
        index: Option<VariableId>,
        fragment: Option<VariableId>,
        body: &Block,
        span: &SourceSpan,
    ) {
        let name = self.user_name(fragment, "f");
        let counter = match index {
            Some(_) => self.declare(index, "index"),
            None => self.names.fresh(&format!("{name}_index")),
        };
        self.emit(format!("for (var {counter} = 0u; {counter} < layer_count(); {counter}++) {{"), span);
        self.body(body, |lowering| {
            if fragment.is_some() {
                let name = lowering.declare(fragment, "f");
                lowering.emit(format!("let {name} = layer({counter});"), span);
            }
        });
    }

    fn each_fragment_backward(
        &mut self,
        index: Option<VariableId>,
        fragment: Option<VariableId>,
        body: &Block,
        span: &SourceSpan,
    ) {
        let name = self.user_name(index.or(fragment), "f");
        let next = self.names.fresh(&format!("{name}_next"));
        self.emit(format!("for (var {next} = layer_count(); {next} > 0u; {next}--) {{"), span);
        self.body(body, |lowering| {
            let mut at = ExprSource { source: format!("{next} - 1u"), precedence: Precedence::Additive };
            if index.is_some() {
                let name = lowering.declare(index, "index");
                lowering.emit(format!("let {name} = {};", at.source), span);
                at = ExprSource::primary(name);
            }
            if fragment.is_some() {
                let name = lowering.declare(fragment, "f");
                lowering.emit(format!("let {name} = layer({});", at.source), span);
            }
        });
    }

    /// Writes the body after the lines of `first`.
    pub(super) fn body(&mut self, body: &Block, first: impl FnOnce(&mut Self)) {
        self.open();
        first(self);
        self.block_contents(body, &Destination::Unused);
        self.close();
        self.lines.push("}".to_string(), &body.end);
    }

    /// Returns the user's name of a loop variable, or `default` for `_`.
    pub(super) fn user_name(&self, variable: Option<VariableId>, default: &str) -> String {
        let variable = variable.and_then(|id| self.function.variables.get(id));
        variable.map_or(default, |variable| variable.name.as_str()).to_string()
    }

    pub(super) fn declare(&mut self, variable: Option<VariableId>, default: &str) -> String {
        let name = self.names.fresh(&self.user_name(variable, default));
        if let Some(id) = variable {
            self.set_name(id, name.clone());
        }
        name
    }
}
