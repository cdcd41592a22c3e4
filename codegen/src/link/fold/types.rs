//! Decides whether an expression has a type of its own, and whether it is evaluated at runtime.
//!
//! Input: an expression. Output: whether its type is independent of the context, and whether its value depends on more than constants.
//! Constants without a suffix take the type of their context, and the compiler evaluates constants: a replacement must have both
//! properties of the expression. The result is `false` if it is uncertain.

use super::environment::DeclarationKind;
use super::expression::{Expression, Kind, is_template};
use super::substitute::Substitute;
use super::values::Values;
use crate::link::token::TokenKind;

impl Values<'_> {
    /// Tests whether the type is independent of the context, unlike that of a number without suffix.
    pub(super) fn has_type(&self, expression: &Expression) -> bool {
        let depends_on = |part: &Expression| self.has_type(part);
        let name = self.first(expression);
        let has_own = match &expression.kind {
            Kind::Atom => matches!(name, "true" | "false") || self.is_typed_number(expression),
            Kind::Call(_) => self.is_typed_call(expression),
            Kind::Parenthesised(inner) | Kind::Unary(inner) => depends_on(inner),
            Kind::Part(base, _) => depends_on(base),
            Kind::Binary("==" | "!=" | "<" | ">" | "<=" | ">=" | "&&" | "||", ..) => true,
            Kind::Binary("<<" | ">>", left, _) => depends_on(left),
            Kind::Binary(_, left, right) => depends_on(left) || depends_on(right),
        };
        has_own || self.is_runtime(expression)
    }

    /// Tests whether an expression is evaluated at runtime, also after folding. Such an expression always has a type of its own.
    pub(super) fn is_runtime(&self, expression: &Expression) -> bool {
        let all = |parts: [&Expression; 2]| parts.iter().all(|part| self.is_runtime(part));
        match &expression.kind {
            Kind::Atom => self.is_variable(expression),
            Kind::Parenthesised(inner) | Kind::Unary(inner) => self.is_runtime(inner),
            Kind::Part(base, _) => self.is_runtime(base),
            Kind::Call(arguments) => self.is_runtime_call(expression, arguments),
            // One known side can determine the result.
            Kind::Binary("&&" | "||", left, right) => all([left, right]),
            Kind::Binary(_, left, right) => self.is_runtime(left) || self.is_runtime(right),
        }
    }

    fn is_variable(&self, atom: &Expression) -> bool {
        let name = self.first(atom);
        match self.locals.at(name, atom.tokens.start) {
            Some(local) => local.keyword != "const" && self.constant(atom).is_none(),
            None => (self.environment.kind)(name) == Some(DeclarationKind::Variable),
        }
    }

    fn is_runtime_call(&self, call: &Expression, arguments: &[Expression]) -> bool {
        let name = self.first(call);
        match (self.substitute(name), arguments) {
            (Substitute::Argument(number), _) => arguments.get(number).is_some_and(|kept| self.is_runtime(kept)),
            (Substitute::FrameMember(_), _) => true,
            (Substitute::None, [_, _, condition]) if self.is_select(call) => self.is_runtime(condition),
            (Substitute::None, _) => {
                let is_declared = (self.environment.kind)(name) == Some(DeclarationKind::Function);
                is_declared || arguments.iter().any(|argument| self.is_runtime(argument))
            }
            _ => false,
        }
    }

    /// Tests whether a call specifies its type, or calls a declared function.
    fn is_typed_call(&self, call: &Expression) -> bool {
        let name = self.first(call);
        let is_listed = is_template(name) && self.tokens[call.tokens.start + 1].text == "<";
        let is_scalar = matches!(name, "u32" | "i32" | "f32" | "f16" | "bool");
        is_listed || is_scalar || (self.environment.kind)(name).is_some()
    }

    fn is_typed_number(&self, atom: &Expression) -> bool {
        let token = self.tokens[atom.tokens.start];
        let is_hexadecimal = token.text.starts_with("0x") || token.text.starts_with("0X");
        let suffixes: &[char] = if is_hexadecimal { &['u', 'i'] } else { &['u', 'i', 'f', 'h'] };
        token.kind == TokenKind::Number && token.text.ends_with(suffixes)
    }
}
