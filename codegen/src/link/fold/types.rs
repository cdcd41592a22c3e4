//! Tells of which expressions the type and the value are certain to depend on more than constants.
//!
//! In: an expression. Out: whether its type is that of a variable, whatever it is given to, and whether its value is found
//! when the program runs. Constants without a suffix take the type of their place, and the compiler evaluates constants:
//! what replaces an expression must be alike in both. `false` wherever it is not certain.

use super::expression::{Expression, Kind, is_template};
use super::substitute::Substitute;
use super::values::{Declared, Values};
use crate::link::token::TokenKind;

impl Values<'_> {
    /// Whether its type does not depend on what it is given to, as that of a number without suffix does.
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

    /// Whether it is found when the program runs, and stays so: what is folded in it leaves no constant. Such an expression
    /// always has a type of its own.
    pub(super) fn is_runtime(&self, expression: &Expression) -> bool {
        let all = |parts: [&Expression; 2]| parts.iter().all(|part| self.is_runtime(part));
        match &expression.kind {
            Kind::Atom => self.is_variable(expression),
            Kind::Parenthesised(inner) | Kind::Unary(inner) => self.is_runtime(inner),
            Kind::Part(base, _) => self.is_runtime(base),
            Kind::Call(arguments) => self.is_runtime_call(expression, arguments),
            // A side that is known may decide alone.
            Kind::Binary("&&" | "||", left, right) => all([left, right]),
            Kind::Binary(_, left, right) => self.is_runtime(left) || self.is_runtime(right),
        }
    }

    fn is_variable(&self, atom: &Expression) -> bool {
        let name = self.first(atom);
        match self.locals.at(name, atom.tokens.start) {
            Some(local) => local.keyword != "const" && self.constant(atom).is_none(),
            None => (self.known.declared)(name) == Some(Declared::Variable),
        }
    }

    fn is_runtime_call(&self, call: &Expression, arguments: &[Expression]) -> bool {
        let name = self.first(call);
        match (self.substitute(name), arguments) {
            (Substitute::Argument(number), _) => arguments.get(number).is_some_and(|kept| self.is_runtime(kept)),
            (Substitute::None, [_, _, condition]) if self.is_select(call) => self.is_runtime(condition),
            (Substitute::None, _) => {
                let is_ours = (self.known.declared)(name) == Some(Declared::Function);
                is_ours || arguments.iter().any(|argument| self.is_runtime(argument))
            }
            _ => false,
        }
    }

    /// Whether a call names its type, or that of its function.
    fn is_typed_call(&self, call: &Expression) -> bool {
        let name = self.first(call);
        let is_listed = is_template(name) && self.tokens[call.tokens.start + 1].text == "<";
        let is_scalar = matches!(name, "u32" | "i32" | "f32" | "f16" | "bool");
        is_listed || is_scalar || (self.known.declared)(name).is_some()
    }

    fn is_typed_number(&self, atom: &Expression) -> bool {
        let token = self.tokens[atom.tokens.start];
        let is_hexadecimal = token.text.starts_with("0x") || token.text.starts_with("0X");
        let suffixes: &[char] = if is_hexadecimal { &['u', 'i'] } else { &['u', 'i', 'f', 'h'] };
        token.kind == TokenKind::Number && token.text.ends_with(suffixes)
    }
}
