//! `for`: over a range, or over the fragments of a pixel.
//!
//! Input: a typed loop. Output: WGSL's `for`, whose bounds are evaluated once before the first iteration, as in Rust.

use fragbuf_model::SourceSpan;

use super::lowering::{Destination, Lowering};
use super::needs::{assigns, is_plain};
use super::source::{ExprSource, Precedence};
use crate::tree::{Block, Expr, For, Kind, Operator, Sequence, VariableId};
use crate::types::Type;

impl Lowering<'_> {
    /// Writes a loop.
    pub(super) fn for_loop(&mut self, each: &For, span: &SourceSpan) {
        if self.dead {
            return;
        }
        match &each.sequence {
            Sequence::Range { variable, ty, from, to, inclusive, reversed } => {
                let ty = self.function.inference.resolve_or_default(*ty);
                let from_source = match reversed {
                    // In reverse, every iteration compares with the start.
                    true => self.bound(*variable, "start", from),
                    false => self.start(from, to),
                };
                let to_source = self.bound(*variable, "end", to);
                if self.dead {
                    return;
                }
                self.names.open();
                match reversed {
                    false => self.forward(*variable, &from_source, &to_source, *inclusive, &each.body, span),
                    true => self.backward(*variable, ty, &from_source, &to_source, &each.body, span),
                }
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

    /// Returns the start of the range, which is evaluated before the end.
    fn start(&mut self, from: &Expr, to: &Expr) -> ExprSource {
        let source = self.value(from);
        if assigns(to) && !self.is_stable(from) { self.bind("value", &source, &from.span) } else { source }
    }

    /// Returns a bound that every iteration compares with. Its value does not change during the loop.
    fn bound(&mut self, variable: Option<VariableId>, which: &str, expr: &Expr) -> ExprSource {
        let source = self.value(expr);
        let simple =
            is_plain(expr) || matches!(expr.kind, Kind::LayerCount) || is_count(expr) || self.is_constant(expr);
        if simple && self.is_stable(expr) {
            return source;
        }
        let name = self.user_name(variable, "index");
        self.bind(&format!("{name}_{which}"), &source, &expr.span)
    }

    fn forward(
        &mut self,
        variable: Option<VariableId>,
        from: &ExprSource,
        to: &ExprSource,
        inclusive: bool,
        body: &Block,
        span: &SourceSpan,
    ) {
        let name = self.declare(variable, "index");
        let operator = if inclusive { Operator::LessEqual } else { Operator::Less };
        let condition = ExprSource::binary(operator, &ExprSource::primary(name.clone()), to);
        self.emit(format!("for (var {name} = {}; {}; {name}++) {{", from.source, condition.source), span);
        self.body(body, |_| {});
    }

    /// Writes a reverse loop. Its counter is one above the index, so that the condition also holds for unsigned integers.
    fn backward(
        &mut self,
        variable: Option<VariableId>,
        ty: Type,
        from: &ExprSource,
        to: &ExprSource,
        body: &Block,
        span: &SourceSpan,
    ) {
        let name = self.user_name(variable, "index");
        let next = self.names.fresh(&format!("{name}_next"));
        let condition = ExprSource::binary(Operator::Greater, &ExprSource::primary(next.clone()), from);
        self.emit(format!("for (var {next} = {}; {}; {next}--) {{", to.source, condition.source), span);
        let one = if ty == Type::I32 { "1i" } else { "1u" };
        self.body(body, |lowering| {
            if variable.is_some() {
                let name = lowering.declare(variable, "index");
                lowering.emit(format!("let {name} = {next} - {one};"), span);
            }
        });
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
    fn body(&mut self, body: &Block, first: impl FnOnce(&mut Self)) {
        self.open();
        first(self);
        self.block_contents(body, &Destination::Unused);
        self.close();
        self.lines.push("}".to_string(), &body.end);
    }

    /// Returns the user's name of a loop variable, or `default` for `_`.
    fn user_name(&self, variable: Option<VariableId>, default: &str) -> String {
        let variable = variable.and_then(|id| self.function.variables.get(id));
        variable.map_or(default, |variable| variable.name.as_str()).to_string()
    }

    fn declare(&mut self, variable: Option<VariableId>, default: &str) -> String {
        let name = self.names.fresh(&self.user_name(variable, default));
        if let Some(id) = variable {
            self.set_name(id, name.clone());
        }
        name
    }
}

/// Returns whether this is `fragments.len()` cast to another integer type.
fn is_count(expr: &Expr) -> bool {
    matches!(&expr.kind, Kind::Cast(inner) if matches!(inner.kind, Kind::LayerCount))
}
