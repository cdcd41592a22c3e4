//! Prints expressions with only the necessary parentheses.
//!
//! Input: an expression of the current function. Output: its text and precedence. Baked expressions print as their
//! variable. All others print at their use, where `schedule` has found that to be correct.

use naga::proc::TypeResolution;
use naga::{Expression, Handle, Literal, TypeInner};

use crate::function::FunctionPrinter;
use crate::literal::literal;
use crate::precedence::{Precedence, Text};
use crate::types::{numeric, scalar_name};

impl<'m> FunctionPrinter<'_, 'm> {
    /// Prints an expression that needs no parentheses: an argument, an initialiser, a condition.
    pub fn expression(&mut self, expression: Handle<Expression>) -> String {
        self.text(expression).text
    }

    /// Prints an expression before `.` or `[`.
    pub fn primary(&mut self, expression: Handle<Expression>) -> String {
        self.text(expression).at_least(Precedence::Primary)
    }

    /// Prints an expression: as its variable if it is baked, else in full.
    pub fn text(&mut self, expression: Handle<Expression>) -> Text {
        if let Some(name) = self.values.get(&expression) {
            return Text::primary(name.clone());
        }
        self.in_place(expression)
    }

    /// Prints an expression in full, even if it gets a variable.
    pub fn in_place(&mut self, expression: Handle<Expression>) -> Text {
        if let Some(circuit) = self.plan.short_circuits.get(&expression).copied() {
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
                let debug = format!("{other:?}");
                let name: String = debug.chars().take_while(|c| c.is_alphanumeric()).collect();
                Text::primary(self.error(format!("an expression of kind {name}"), expression))
            }
        }
    }

    fn literal(&mut self, value: Literal, expression: Handle<Expression>) -> Text {
        self.printer.require_width(value.scalar());
        let Some(text) = literal(value, self.source_of(expression)) else {
            let message = crate::types::unsupported_scalar(value.scalar());
            return Text::primary(self.error(message, expression));
        };
        let precedence = if text.starts_with('-') { Precedence::Unary } else { Precedence::Primary };
        Text::new(text, precedence)
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

    /// Prints `select`: by component as `mix()`, else as `c ? a : b`.
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
        let condition = self.text(condition).above(Precedence::Ternary);
        let accept = self.text(accept).above(Precedence::Ternary);
        let reject = self.text(reject).above(Precedence::Ternary);
        Text::new(format!("{condition} ? {accept} : {reject}"), Precedence::Ternary)
    }

    /// Returns the type of an expression, named as a constructor.
    pub fn type_name(&mut self, expression: Handle<Expression>) -> String {
        let span = self.span(expression);
        let resolution: &TypeResolution = &self.order.info[expression].ty;
        self.printer.resolved_name(resolution, span)
    }

    /// Returns lanes (1 for a scalar) and scalar of a numeric expression.
    pub fn shape(&self, expression: Handle<Expression>) -> Option<(u8, naga::Scalar)> {
        let (size, scalar) = numeric(self.order.inner(expression))?;
        Some((crate::helpers::lanes(size), scalar))
    }

    /// Records an error for scalars without a GLSL name.
    pub fn check_scalar(&mut self, expression: Handle<Expression>) {
        if let Some((_, scalar)) = self.shape(expression)
            && scalar_name(scalar).is_none()
        {
            self.error(crate::types::unsupported_scalar(scalar), expression);
        }
    }

    /// Returns the literal value of an expression, or of each of its components.
    pub fn known_literal(&self, expression: Handle<Expression>) -> Option<Literal> {
        match self.function.expressions[expression] {
            Expression::Literal(value) => Some(value),
            Expression::Splat { value, .. } => self.known_literal(value),
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
