//! Expressions: from the typed tree to WGSL source.
//!
//! Input: a typed expression. Output: its source; statements that it needs are written before it. Operands are evaluated
//! from left to right, as in Rust: an operand that a later one could change is bound to a name first.

use fragbuf_model::mangled;

use super::lowering::{Destination, Lowering};
use super::needs::{assigns, is_plain, only_value};
use super::numbers;
use super::source::ExprSource;
use crate::fold::{self, Value};
use crate::tree::{Expr, If, Kind, Operator};
use crate::types::{Shape, Type};

impl Lowering<'_> {
    /// Writes the statements that an expression needs, and returns its source.
    pub(super) fn value(&mut self, expr: &Expr) -> ExprSource {
        match &expr.kind {
            Kind::Float(value) => numbers::float(*value, self.suffixed),
            Kind::Integer(value) => numbers::integer(*value, self.function.type_of(expr)),
            Kind::Bool(value) => ExprSource::primary(value.to_string()),
            Kind::Variable(id) => ExprSource::primary(self.name_of(*id)),
            Kind::Uniform(name) => ExprSource::primary(format!("uniforms.{}", mangled(name))),
            Kind::Attribute(base, name) => {
                let base = self.value(base).postfixed();
                ExprSource::primary(format!("{base}.{}", mangled(name)))
            }
            Kind::Components(base, names) => ExprSource::primary(format!("{}.{names}", self.value(base).postfixed())),
            Kind::Element(base, index) => self.element(base, index),
            Kind::Layer(index) => ExprSource::call("layer", &[self.value(index)]),
            Kind::LayerCount => ExprSource::primary("layer_count()"),
            Kind::Negate(inner) => self.negated(inner, expr),
            Kind::Not(inner) => {
                let operator = if self.function.type_of(inner) == Type::Bool { '!' } else { '~' };
                ExprSource::prefixed(operator, &self.value(inner))
            }
            Kind::Binary(operator, left, right) if operator.is_logical() => self.logical(*operator, left, right, expr),
            Kind::Binary(operator, left, right) => self.binary(*operator, left, right, expr),
            Kind::Cast(inner) => self.cast(inner, expr),
            Kind::Method(spelling, arguments) => self.method(*spelling, arguments),
            Kind::Helper(index, arguments) => self.helper(*index, arguments),
            Kind::Lookup(shape, name, method, arguments) => {
                let sources = self.operands(&arguments.iter().collect::<Vec<_>>());
                let kind = if *shape == Shape::Image { "image" } else { "texture" };
                ExprSource::call(&format!("{method}_{kind}_{name}"), &sources)
            }
            Kind::Vector(components) => self.vector(components, expr),
            Kind::If(branch) if self.is_select(branch, expr) => self.select(branch),
            Kind::Block(block) => match only_value(block) {
                Some(value) => self.value(value),
                None => self.flattened(block),
            },
            Kind::If(_) => self.named_branch(expr),
            Kind::For(_) | Kind::Assign { .. } | Kind::Return(_) | Kind::Break | Kind::Continue | Kind::Error => {
                self.statement(expr, &Destination::Unused);
                // Nothing reads this value: the expression diverges or has no value.
                ExprSource::primary("0u")
            }
        }
    }

    /// Writes several expressions, evaluated from left to right.
    pub(super) fn operands(&mut self, exprs: &[&Expr]) -> Vec<ExprSource> {
        let mut sources = Vec::with_capacity(exprs.len());
        for (index, expr) in exprs.iter().enumerate() {
            sources.push(self.operand_before(expr, exprs.get(index + 1..).unwrap_or_default()));
        }
        sources
    }

    /// Writes an expression that is evaluated before others. If one of those changes it, it is bound to a name.
    pub(super) fn operand_before(&mut self, expr: &Expr, later: &[&Expr]) -> ExprSource {
        let source = self.value(expr);
        match later.iter().any(|later| assigns(later)) && !self.is_stable(expr) {
            true => self.bind("value", &source, &expr.span),
            false => source,
        }
    }

    fn element(&mut self, base: &Expr, index: &Expr) -> ExprSource {
        let sources = self.operands(&[base, index]);
        match sources.as_slice() {
            [base, index] => ExprSource::primary(format!("{}[{}]", base.postfixed(), index.source)),
            _ => ExprSource::primary(""),
        }
    }

    fn negated(&mut self, inner: &Expr, expr: &Expr) -> ExprSource {
        match inner.kind {
            Kind::Integer(magnitude) if self.function.type_of(expr) == Type::I32 => numbers::negative(magnitude),
            _ => ExprSource::prefixed('-', &self.value(inner)),
        }
    }

    fn binary(&mut self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> ExprSource {
        if let Some(folded) = self.lossy_shift(operator, left, right, expr) {
            // The operands may be blocks with statements.
            self.operands(&[left, right]);
            return folded;
        }
        // WGSL computes constant expressions in 64 bits unless the literals have the suffix `f`.
        let outer = self.suffixed;
        self.suffixed |= self.is_constant(left) && self.is_constant(right);
        let sources = match operator.is_shift() {
            true => {
                let left = self.operand_before(left, &[right]);
                vec![left, self.shift_count(right)]
            }
            false => self.operands(&[left, right]),
        };
        self.suffixed = outer;
        let operator = match operator {
            Operator::BitXor if self.function.type_of(left) == Type::Bool => Operator::NotEqual,
            other => other,
        };
        match sources.as_slice() {
            [left, right] => ExprSource::binary(operator, left, right),
            _ => ExprSource::primary(""),
        }
    }

    /// Returns the value of a constant left shift that loses bits: WGSL rejects the shift, Rust accepts it.
    fn lossy_shift(&self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> Option<ExprSource> {
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
                (to >> count != from).then(|| numbers::integer(u64::from(to), Type::U32))
            }
            (Value::I32(from), Value::I32(to)) if to >> count != from => Some(match to < 0 {
                true => numbers::negative(u64::from(to.unsigned_abs())),
                false => numbers::integer(u64::from(to.unsigned_abs()), Type::I32),
            }),
            _ => None,
        }
    }

    /// Writes a shift count, which is always a `u32` in WGSL.
    pub(super) fn shift_count(&mut self, count: &Expr) -> ExprSource {
        match (&count.kind, self.function.type_of(count)) {
            (Kind::Integer(value), _) => numbers::integer(*value, Type::U32),
            (_, Type::I32) => ExprSource::call("u32", &[self.value(count)]),
            _ => self.value(count),
        }
    }

    /// Writes `&&` or `||`. Statements of the right operand run only if Rust evaluates it.
    fn logical(&mut self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> ExprSource {
        if !self.needs_statements(right) {
            let (left, right) = (self.value(left), self.value(right));
            return ExprSource::binary(operator, &left, &right);
        }
        let left = self.value(left);
        let name = self.names.fresh("holds");
        self.emit(format!("var {name} = {};", left.source), &expr.span);
        let not = if operator == Operator::Or { "!" } else { "" };
        self.emit(format!("if {not}{name} {{"), &expr.span);
        self.open();
        self.store(right, &Destination::Assign(name.clone()));
        self.close();
        self.emit("}".to_string(), &expr.span);
        ExprSource::primary(name)
    }

    fn cast(&mut self, inner: &Expr, expr: &Expr) -> ExprSource {
        let (from, to) = (self.function.type_of(inner), self.function.type_of(expr));
        let source = self.value(inner);
        if from.wgsl() == to.wgsl() {
            return source;
        }
        if !self.saturates(inner, expr) {
            return ExprSource::call(to.wgsl(), &[source]);
        }
        let source =
            if is_plain(inner) && !self.is_constant(inner) { source } else { self.bind("value", &source, &inner.span) };
        let template = match to {
            Type::I32 => "select(i32($0), 2147483647i, $0 >= 2147483648.0)",
            _ => "select(u32($0), 4294967295u, $0 >= 4294967296.0)",
        };
        super::methods::fill(template, &[source], "")
    }

    fn helper(&mut self, index: usize, arguments: &[Expr]) -> ExprSource {
        let sources = self.operands(&arguments.iter().collect::<Vec<_>>());
        let name = self.helpers.get(index).map_or("", |helper| helper.name.as_str());
        ExprSource::call(&format!("user_{name}"), &sources)
    }

    fn vector(&mut self, components: &[Expr], expr: &Expr) -> ExprSource {
        let outer = std::mem::replace(&mut self.suffixed, false);
        let sources = self.operands(&components.iter().collect::<Vec<_>>());
        self.suffixed = outer;
        ExprSource::call(self.function.type_of(expr).wgsl(), &sources)
    }

    fn select(&mut self, branch: &If) -> ExprSource {
        let then = only_value(&branch.then);
        let else_branch = match branch.else_branch.as_ref().map(|else_branch| &else_branch.kind) {
            Some(Kind::Block(block)) => only_value(block),
            _ => None,
        };
        let condition = self.value(&branch.condition);
        match (then, else_branch) {
            (Some(then), Some(else_branch)) => {
                let (then, else_branch) = (self.value(then), self.value(else_branch));
                ExprSource::call("select", &[else_branch, then, condition])
            }
            _ => condition,
        }
    }

    /// Writes a branch with statements, and returns a variable that both arms assign.
    fn named_branch(&mut self, expr: &Expr) -> ExprSource {
        let name = self.names.fresh("value");
        let ty = self.function.type_of(expr);
        if ty.is_value() {
            self.emit(format!("var {name}: {};", ty.wgsl()), &expr.span);
            self.store(expr, &Destination::Assign(name.clone()));
        } else {
            self.statement(expr, &Destination::Unused);
        }
        ExprSource::primary(name)
    }
}
