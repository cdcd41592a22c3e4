//! Expressions: text with just the parentheses it needs.
//!
//! In: an expression of the function being printed. Out: its text and how tightly that binds. Baked expressions print as
//! their variable; everything else prints in place, because `schedule` has found that to be right.

use naga::proc::TypeResolution;
use naga::{Expression, Handle, Literal, TypeInner};

use crate::function::FunctionPrinter;
use crate::literal::literal;
use crate::types::{numeric, scalar_name};

/// How tightly a text binds, from loose to tight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    Ternary,
    LogicalOr,
    LogicalAnd,
    BitOr,
    BitXor,
    BitAnd,
    Equality,
    Relation,
    Shift,
    Sum,
    Product,
    Unary,
    Primary,
}

#[derive(Clone, Debug)]
pub struct Text {
    pub text: String,
    pub level: Level,
}

impl Text {
    pub fn primary(text: impl Into<String>) -> Self {
        Self { text: text.into(), level: Level::Primary }
    }

    pub fn new(text: impl Into<String>, level: Level) -> Self {
        Self { text: text.into(), level }
    }

    /// The text where something that binds at least as tightly is needed.
    pub fn at_least(self, level: Level) -> String {
        if self.level < level { format!("({})", self.text) } else { self.text }
    }

    /// The text where something that binds more tightly is needed.
    pub fn above(self, level: Level) -> String {
        if self.level <= level { format!("({})", self.text) } else { self.text }
    }
}

impl<'m> FunctionPrinter<'_, 'm> {
    /// Text of an expression as a whole: an argument, an initialiser, a condition.
    pub fn expression(&mut self, expression: Handle<Expression>) -> String {
        self.text(expression).text
    }

    /// Text of an expression before `.` or `[`.
    pub fn primary(&mut self, expression: Handle<Expression>) -> String {
        self.text(expression).at_least(Level::Primary)
    }

    pub fn text(&mut self, expression: Handle<Expression>) -> Text {
        if let Some(name) = self.values.get(&expression) {
            return Text::primary(name.clone());
        }
        self.in_place(expression)
    }

    /// Text of an expression itself, even if it is about to become a variable.
    pub fn in_place(&mut self, expression: Handle<Expression>) -> Text {
        if let Some(circuit) = self.plan.circuits.get(&expression).copied() {
            return self.logical(circuit.operator, circuit.left, circuit.right);
        }
        let function = self.function;
        match function.expressions[expression] {
            Expression::Literal(value) => self.literal(value, expression),
            Expression::Constant(constant) => self.printer.constant(constant),
            Expression::ZeroValue(ty) => {
                let span = self.span(expression);
                Text::primary(self.printer.zero(ty, span))
            }
            Expression::Compose { ty, ref components } => self.compose(expression, ty, components),
            Expression::Access { base, index } => self.access(base, index),
            Expression::AccessIndex { base, index } => self.access_index(expression, base, index),
            Expression::Splat { value, .. } => {
                let ty = self.type_name(expression);
                let value = self.expression(value);
                Text::primary(format!("{ty}({value})"))
            }
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.primary(vector);
                let letters: String = pattern[..size as usize]
                    .iter()
                    .map(|component| ['x', 'y', 'z', 'w'][*component as usize])
                    .collect();
                Text::primary(format!("{vector}.{letters}"))
            }
            Expression::FunctionArgument(index) => self.argument(expression, index),
            Expression::GlobalVariable(global) => self.global(global),
            Expression::LocalVariable(local) => {
                let name = self.locals.get(&local).cloned();
                Text::primary(name.unwrap_or_else(|| self.error("a variable used before its declaration", expression)))
            }
            Expression::Load { pointer } => self.load(expression, pointer),
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => {
                self.texture(expression)
            }
            Expression::Unary { op, expr } => self.unary(op, expr),
            Expression::Binary { op, left, right } => self.binary(expression, op, left, right),
            Expression::Select { condition, accept, reject } => self.select(condition, accept, reject),
            Expression::Derivative { axis, ctrl, expr } => self.derivative(axis, ctrl, expr),
            Expression::Relational { fun, argument } => self.relational(fun, argument),
            Expression::Math { .. } => self.math(expression),
            Expression::As { expr, kind, convert } => self.convert(expression, expr, kind, convert),
            Expression::ArrayLength(array) => {
                let array = self.primary(array);
                Text::primary(format!("uint({array}.length())"))
            }
            Expression::CallResult(_) | Expression::AtomicResult { .. } => self.result_in_place(expression),
            Expression::Override(_) => Text::primary(self.error("an override; set it before printing", expression)),
            ref other => {
                let what = format!("{other:?}");
                let name: String = what.chars().take_while(|c| c.is_alphanumeric()).collect();
                Text::primary(self.error(format!("an expression of kind {name}"), expression))
            }
        }
    }

    fn literal(&mut self, value: Literal, expression: Handle<Expression>) -> Text {
        self.printer.need_width(value.scalar());
        let Some(text) = literal(value, self.written(expression)) else {
            let what = crate::types::unsupported_scalar(value.scalar());
            return Text::primary(self.error(what, expression));
        };
        let level = if text.starts_with('-') { Level::Unary } else { Level::Primary };
        Text::new(text, level)
    }

    fn compose(
        &mut self,
        expression: Handle<Expression>,
        ty: Handle<naga::Type>,
        components: &[Handle<Expression>],
    ) -> Text {
        let span = self.span(expression);
        let name = self.printer.type_name(ty, span);
        let parts: Vec<String> = components.iter().map(|component| self.expression(*component)).collect();
        Text::primary(format!("{name}({})", parts.join(", ")))
    }

    fn select(
        &mut self,
        condition: Handle<Expression>,
        accept: Handle<Expression>,
        reject: Handle<Expression>,
    ) -> Text {
        if matches!(self.order.inner(condition), TypeInner::Vector { .. }) {
            let (condition, accept, reject) =
                (self.expression(condition), self.expression(accept), self.expression(reject));
            return Text::primary(format!("mix({reject}, {accept}, {condition})"));
        }
        let condition = self.text(condition).above(Level::Ternary);
        let accept = self.text(accept).above(Level::Ternary);
        let reject = self.text(reject).above(Level::Ternary);
        Text::new(format!("{condition} ? {accept} : {reject}"), Level::Ternary)
    }

    /// The type of an expression, as it is named where a value is made.
    pub fn type_name(&mut self, expression: Handle<Expression>) -> String {
        let span = self.span(expression);
        let resolution: &TypeResolution = &self.order.info[expression].ty;
        self.printer.resolved_name(resolution, span)
    }

    /// Lanes (1 for a scalar) and scalar of a numeric expression.
    pub fn shape(&self, expression: Handle<Expression>) -> Option<(u8, naga::Scalar)> {
        let (size, scalar) = numeric(self.order.inner(expression))?;
        Some((crate::helpers::lanes(size), scalar))
    }

    /// Notes an error for scalars that have no GLSL name here.
    pub fn check_scalar(&mut self, expression: Handle<Expression>) {
        if let Some((_, scalar)) = self.shape(expression)
            && scalar_name(scalar).is_none()
        {
            self.error(crate::types::unsupported_scalar(scalar), expression);
        }
    }

    /// The literal that an expression is, or that fills it.
    pub fn known(&self, expression: Handle<Expression>) -> Option<Literal> {
        match self.function.expressions[expression] {
            Expression::Literal(value) => Some(value),
            Expression::Splat { value, .. } => self.known(value),
            Expression::Constant(constant) => {
                let init = self.printer.module.constants[constant].init;
                match self.printer.module.global_expressions[init] {
                    Expression::Literal(value) => Some(value),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}
