//! Expressions: typed tree to text.
//!
//! In: a typed expression. Out: its text; what has to stand before it is written on the way. Operands are evaluated from
//! left to right, as in Rust: one that a later one could change gets a name first.

use fragbuf_model::mangled;

use super::Lowering;
use super::needs::{assigns, is_plain, only_value};
use super::numbers;
use super::statements::Destination;
use super::text::Text;
use crate::fold::{self, Value};
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

impl Lowering<'_> {
    /// The text of an expression.
    pub(super) fn value(&mut self, expr: &Expr) -> Text {
        match &expr.kind {
            Kind::Float(value) => numbers::float(*value, self.suffixed),
            Kind::Whole(value) => numbers::whole(*value, self.function.type_of(expr)),
            Kind::Bool(value) => Text::primary(value.to_string()),
            Kind::Variable(id) => Text::primary(self.name_of(*id)),
            Kind::Uniform(name) => Text::primary(format!("uniforms.{}", mangled(name))),
            Kind::Attribute(base, name) => {
                let base = self.value(base).postfixed();
                Text::primary(format!("{base}.{}", mangled(name)))
            }
            Kind::Components(base, names) => Text::primary(format!("{}.{names}", self.value(base).postfixed())),
            Kind::Element(base, index) => self.element(base, index),
            Kind::Layer(index) => Text::call("layer", &[self.value(index)]),
            Kind::LayerCount => Text::primary("layer_count()"),
            Kind::Negate(inner) => self.negated(inner, expr),
            Kind::Not(inner) => {
                let sign = if self.function.type_of(inner) == Type::Bool { '!' } else { '~' };
                Text::prefixed(sign, &self.value(inner))
            }
            Kind::Binary(operator, left, right) if operator.is_logical() => self.logical(*operator, left, right, expr),
            Kind::Binary(operator, left, right) => self.binary(*operator, left, right, expr),
            Kind::Cast(inner) => self.cast(inner, expr),
            Kind::Method(spelling, arguments) => self.method(*spelling, arguments),
            Kind::Helper(index, arguments) => self.helper(*index, arguments),
            Kind::Vector(components) => self.vector(components, expr),
            Kind::If(branch) if self.is_select(branch, expr) => self.select(branch),
            Kind::Block(block) => match only_value(block) {
                Some(value) => self.value(value),
                None => self.flattened(block),
            },
            Kind::If(_) => self.named_branch(expr),
            Kind::For(_) | Kind::Assign { .. } | Kind::Return(_) | Kind::Break | Kind::Continue | Kind::Error => {
                self.statement(expr, &Destination::Nothing);
                // Nothing reads this: the place is never reached, or wants no value.
                Text::primary("0u")
            }
        }
    }

    /// Several expressions, evaluated from left to right.
    pub(super) fn operands(&mut self, exprs: &[&Expr]) -> Vec<Text> {
        let mut texts = Vec::with_capacity(exprs.len());
        for (index, expr) in exprs.iter().enumerate() {
            let text = self.value(expr);
            let changed_later = exprs.iter().skip(index + 1).any(|later| assigns(later));
            texts.push(match changed_later && !self.is_stable(expr) {
                true => self.bind("value", &text, &expr.origin),
                false => text,
            });
        }
        texts
    }

    fn element(&mut self, base: &Expr, index: &Expr) -> Text {
        let texts = self.operands(&[base, index]);
        match texts.as_slice() {
            [base, index] => Text::primary(format!("{}[{}]", base.postfixed(), index.text)),
            _ => Text::primary(""),
        }
    }

    fn negated(&mut self, inner: &Expr, expr: &Expr) -> Text {
        match inner.kind {
            Kind::Whole(size) if self.function.type_of(expr) == Type::I32 => numbers::negative(size),
            _ => Text::prefixed('-', &self.value(inner)),
        }
    }

    fn binary(&mut self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> Text {
        if let Some(folded) = self.shifted_out(operator, left, right, expr) {
            return folded;
        }
        // Between constants WGSL calculates in 64 bits unless the literals say `f`.
        let outer = self.suffixed;
        self.suffixed |= self.is_constant(left) && self.is_constant(right);
        let shift = operator.is_shift();
        let texts = if shift { vec![self.value(left), self.shift_count(right)] } else { self.operands(&[left, right]) };
        self.suffixed = outer;
        let operator = match operator {
            Operator::BitXor if self.function.type_of(left) == Type::Bool => Operator::NotEqual,
            other => other,
        };
        match texts.as_slice() {
            [left, right] => Text::binary(operator, left, right),
            _ => Text::primary(""),
        }
    }

    /// WGSL refuses a constant that loses bits to the left; Rust does not, so its value is written instead.
    fn shifted_out(&self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> Option<Text> {
        if operator != Operator::ShiftLeft {
            return None;
        }
        let count = match fold::constant(right, self.function)? {
            Value::U32(count) => count,
            Value::I32(count) => u32::try_from(count).ok()?,
            _ => return None,
        };
        match (fold::constant(left, self.function)?, fold::constant(expr, self.function)?) {
            (Value::U32(from), Value::U32(to)) => {
                (to >> count != from).then(|| numbers::whole(u64::from(to), Type::U32))
            }
            (Value::I32(from), Value::I32(to)) if to >> count != from => Some(match to < 0 {
                true => numbers::negative(u64::from(to.unsigned_abs())),
                false => numbers::whole(u64::from(to.unsigned_abs()), Type::I32),
            }),
            _ => None,
        }
    }

    /// WGSL shifts by `u32` only.
    pub(super) fn shift_count(&mut self, count: &Expr) -> Text {
        match (&count.kind, self.function.type_of(count)) {
            (Kind::Whole(value), _) => numbers::whole(*value, Type::U32),
            (_, Type::I32) => Text::call("u32", &[self.value(count)]),
            _ => self.value(count),
        }
    }

    /// `&&` and `||` evaluate their right side only where it counts; statements it needs must not run otherwise.
    fn logical(&mut self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> Text {
        if !self.needs_statements(right) {
            let (left, right) = (self.value(left), self.value(right));
            return Text::binary(operator, &left, &right);
        }
        let left = self.value(left);
        let name = self.names.fresh("holds");
        self.emit(format!("var {name} = {};", left.text), &expr.origin);
        let not = if operator == Operator::Or { "!" } else { "" };
        self.emit(format!("if {not}{name} {{"), &expr.origin);
        self.open();
        self.store(right, &Destination::Assign(name.clone()));
        self.close();
        self.emit("}".to_string(), &expr.origin);
        Text::primary(name)
    }

    fn cast(&mut self, inner: &Expr, expr: &Expr) -> Text {
        let (from, to) = (self.function.type_of(inner), self.function.type_of(expr));
        let text = self.value(inner);
        if from.wgsl() == to.wgsl() {
            return text;
        }
        if !self.saturates(inner, expr) {
            return Text::call(to.wgsl(), &[text]);
        }
        let text =
            if is_plain(inner) && !self.is_constant(inner) { text } else { self.bind("value", &text, &inner.origin) };
        let template = match to {
            Type::I32 => "select(i32($0), 2147483647i, $0 >= 2147483648.0)",
            _ => "select(u32($0), 4294967295u, $0 >= 4294967296.0)",
        };
        super::methods::fill(template, &[text], "")
    }

    fn helper(&mut self, index: usize, arguments: &[Expr]) -> Text {
        let texts = self.operands(&arguments.iter().collect::<Vec<_>>());
        let name = self.helpers.get(index).map_or("", |helper| helper.name.as_str());
        Text::call(&format!("user_{name}"), &texts)
    }

    fn vector(&mut self, components: &[Expr], expr: &Expr) -> Text {
        let outer = std::mem::replace(&mut self.suffixed, false);
        let texts = self.operands(&components.iter().collect::<Vec<_>>());
        self.suffixed = outer;
        Text::call(self.function.type_of(expr).wgsl(), &texts)
    }

    fn select(&mut self, branch: &crate::tree::If) -> Text {
        let then = only_value(&branch.then);
        let otherwise = match branch.otherwise.as_ref().map(|otherwise| &otherwise.kind) {
            Some(Kind::Block(block)) => only_value(block),
            _ => None,
        };
        let condition = self.value(&branch.condition);
        match (then, otherwise) {
            (Some(then), Some(otherwise)) => {
                let (then, otherwise) = (self.value(then), self.value(otherwise));
                Text::call("select", &[otherwise, then, condition])
            }
            _ => condition,
        }
    }

    /// A branch with statements, as a value: a variable that both ways assign.
    fn named_branch(&mut self, expr: &Expr) -> Text {
        let name = self.names.fresh("value");
        let ty = self.function.type_of(expr);
        if ty.is_value() {
            self.emit(format!("var {name}: {};", ty.wgsl()), &expr.origin);
            self.store(expr, &Destination::Assign(name.clone()));
        } else {
            self.statement(expr, &Destination::Nothing);
        }
        Text::primary(name)
    }
}
