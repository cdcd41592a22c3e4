//! `for`: over a range, or over the fragments of a pixel.
//!
//! In: a typed loop. Out: WGSL's `for`, whose bounds are evaluated once, before the first round, as in Rust.

use fragbuf_model::Origin;

use super::Lowering;
use super::needs::{assigns, is_plain};
use super::statements::Destination;
use super::text::{Level, Text};
use crate::tree::{Block, Expr, For, Kind, Operator, Over, VariableId};
use crate::types::Type;

impl Lowering<'_> {
    pub(super) fn for_loop(&mut self, each: &For, origin: &Origin) {
        if self.dead {
            return;
        }
        match &each.over {
            Over::Range { variable, kind, from, to, inclusive, reversed } => {
                let kind = self.function.inference.settle(*kind);
                let from_text = match reversed {
                    // Backwards, the start is what every round compares with.
                    true => self.bound(*variable, "start", from),
                    false => self.start(from, to),
                };
                let to_text = self.bound(*variable, "end", to);
                if self.dead {
                    return;
                }
                self.names.open();
                match reversed {
                    false => self.forward(*variable, &from_text, &to_text, *inclusive, &each.body, origin),
                    true => self.backward(*variable, kind, &from_text, &to_text, &each.body, origin),
                }
            }
            Over::Fragments { index, fragment, reversed: false } => {
                self.names.open();
                self.each_fragment(*index, *fragment, &each.body, origin);
            }
            Over::Fragments { index, fragment, reversed: true } => {
                self.names.open();
                self.each_fragment_backward(*index, *fragment, &each.body, origin);
            }
        }
        self.names.close();
        self.dead = false;
    }

    /// The first number; it is read before the end of the range is evaluated.
    fn start(&mut self, from: &Expr, to: &Expr) -> Text {
        let text = self.value(from);
        if assigns(to) && !self.is_stable(from) { self.bind("value", &text, &from.origin) } else { text }
    }

    /// A bound that every round compares with, as text that stays the same throughout the loop.
    fn bound(&mut self, variable: Option<VariableId>, which: &str, expr: &Expr) -> Text {
        let text = self.value(expr);
        let simple =
            is_plain(expr) || matches!(expr.kind, Kind::LayerCount) || is_count(expr) || self.is_constant(expr);
        if simple && self.is_stable(expr) {
            return text;
        }
        let name = self.wanted(variable, "index");
        self.bind(&format!("{name}_{which}"), &text, &expr.origin)
    }

    fn forward(
        &mut self,
        variable: Option<VariableId>,
        from: &Text,
        to: &Text,
        inclusive: bool,
        body: &Block,
        origin: &Origin,
    ) {
        let name = self.declare(variable, "index");
        let operator = if inclusive { Operator::LessEqual } else { Operator::Less };
        let condition = Text::binary(operator, &Text::primary(name.clone()), to);
        self.emit(format!("for (var {name} = {}; {}; {name}++) {{", from.text, condition.text), origin);
        self.body(body, |_| {});
    }

    /// Counts one above, so that the condition is right for unsigned numbers too.
    fn backward(
        &mut self,
        variable: Option<VariableId>,
        kind: Type,
        from: &Text,
        to: &Text,
        body: &Block,
        origin: &Origin,
    ) {
        let wanted = self.wanted(variable, "index");
        let next = self.names.fresh(&format!("{wanted}_next"));
        let condition = Text::binary(Operator::Greater, &Text::primary(next.clone()), from);
        self.emit(format!("for (var {next} = {}; {}; {next}--) {{", to.text, condition.text), origin);
        let one = if kind == Type::I32 { "1i" } else { "1u" };
        self.body(body, |lowering| {
            if variable.is_some() {
                let name = lowering.declare(variable, "index");
                lowering.emit(format!("let {name} = {next} - {one};"), origin);
            }
        });
    }

    fn each_fragment(
        &mut self,
        index: Option<VariableId>,
        fragment: Option<VariableId>,
        body: &Block,
        origin: &Origin,
    ) {
        let wanted = self.wanted(fragment, "f");
        let counter = match index {
            Some(_) => self.declare(index, "index"),
            None => self.names.fresh(&format!("{wanted}_index")),
        };
        self.emit(format!("for (var {counter} = 0u; {counter} < layer_count(); {counter}++) {{"), origin);
        self.body(body, |lowering| {
            if fragment.is_some() {
                let name = lowering.declare(fragment, "f");
                lowering.emit(format!("let {name} = layer({counter});"), origin);
            }
        });
    }

    fn each_fragment_backward(
        &mut self,
        index: Option<VariableId>,
        fragment: Option<VariableId>,
        body: &Block,
        origin: &Origin,
    ) {
        let wanted = self.wanted(index.or(fragment), "f");
        let next = self.names.fresh(&format!("{wanted}_next"));
        self.emit(format!("for (var {next} = layer_count(); {next} > 0u; {next}--) {{"), origin);
        self.body(body, |lowering| {
            let mut at = Text { text: format!("{next} - 1u"), level: Level::Additive };
            if index.is_some() {
                let name = lowering.declare(index, "index");
                lowering.emit(format!("let {name} = {};", at.text), origin);
                at = Text::primary(name);
            }
            if fragment.is_some() {
                let name = lowering.declare(fragment, "f");
                lowering.emit(format!("let {name} = layer({});", at.text), origin);
            }
        });
    }

    fn body(&mut self, body: &Block, first: impl FnOnce(&mut Self)) {
        self.open();
        first(self);
        self.block_contents(body, &Destination::Nothing);
        self.close();
        self.lines.push("}".to_string(), &body.end);
    }

    /// The user's name for a loop's variable, or `otherwise` for `_`.
    fn wanted(&self, variable: Option<VariableId>, otherwise: &str) -> String {
        let variable = variable.and_then(|id| self.function.variables.get(id));
        variable.map_or(otherwise, |variable| variable.name.as_str()).to_string()
    }

    fn declare(&mut self, variable: Option<VariableId>, otherwise: &str) -> String {
        let name = self.names.fresh(&self.wanted(variable, otherwise));
        if let Some(id) = variable {
            self.spell(id, name.clone());
        }
        name
    }
}

/// `fragments.len()` as another type of whole number.
fn is_count(expr: &Expr) -> bool {
    matches!(&expr.kind, Kind::Cast(inner) if matches!(inner.kind, Kind::LayerCount))
}
