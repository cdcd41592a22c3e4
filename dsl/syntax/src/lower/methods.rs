//! Calls from the method table: a row's WGSL with the arguments inserted.
//!
//! Input: a row's WGSL and arguments. Output: source. An argument that the template repeats is bound to a name first, unless
//! it is a name. If all arguments are constant, one is bound to a name: otherwise WGSL evaluates the call when the shader
//! is created, and rejects it where Rust returns infinity.

use super::lowering::Lowering;
use super::needs::{is_plain, occurs_twice};
use super::source::{ExprSource, Precedence, arguments_source};
use crate::methods::Spelling;
use crate::tree::Expr;

impl Lowering<'_> {
    /// Writes a method call.
    pub(super) fn method(&mut self, spelling: Spelling, arguments: &[Expr]) -> ExprSource {
        let mut sources = self.operands(&arguments.iter().collect::<Vec<_>>());
        let all_constant = self.all_constant(arguments);
        let spelling = self.chosen(spelling, arguments);
        for (index, (argument, source)) in arguments.iter().zip(&mut sources).enumerate() {
            let repeated = occurs_twice(spelling, index) && !is_plain(argument);
            if repeated || (all_constant && index == 0) {
                *source = self.bind("value", source, &argument.span);
            }
        }
        match spelling {
            Spelling::Call(name) => ExprSource::call(name, &sources),
            Spelling::Template(template) | Spelling::ByZero { other: template, .. } => {
                let receiver = arguments.first().map(|receiver| self.function.type_of(receiver));
                fill(template, &sources, receiver.map_or("f32", |receiver| receiver.wgsl()))
            }
        }
    }
}

/// Returns a template with `$0`, `$1`, … replaced by the arguments and `$T` by the receiver's type.
pub(super) fn fill(template: &str, arguments: &[ExprSource], receiver: &str) -> ExprSource {
    let mut source = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('$') {
        source.push_str(before);
        let mut letters = after.chars();
        let mark = letters.next();
        rest = letters.as_str();
        match mark.and_then(|mark| mark.to_digit(10)).and_then(|index| arguments.get(index as usize)) {
            Some(argument) => source.push_str(&inserted(argument, &source, rest)),
            None => source.push_str(receiver),
        }
    }
    source.push_str(rest);
    ExprSource { source, precedence: precedence(template) }
}

/// Returns an argument with the parentheses that it needs between `before` and `after`.
fn inserted(argument: &ExprSource, before: &str, after: &str) -> String {
    if after.starts_with('.') {
        return argument.postfixed();
    }
    let opens = before.ends_with('(') || before.ends_with(", ");
    let closes = after.starts_with(')') || after.starts_with(", ");
    match opens && closes {
        // `--` would be one token.
        false if before.ends_with('-') && argument.source.starts_with('-') => format!("({})", argument.source),
        true => arguments_source(std::slice::from_ref(argument)),
        false => argument.unary(),
    }
}

/// Returns the precedence of the outermost operator of a template.
fn precedence(template: &str) -> Precedence {
    let mut depth = 0_i32;
    let mut found = if template.starts_with('-') { Precedence::Unary } else { Precedence::Primary };
    for (index, letter) in template.char_indices() {
        let spaced = template.get(..index).is_some_and(|before| before.ends_with(' '));
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            '+' | '-' if depth == 0 && spaced => return Precedence::Additive,
            '*' | '/' | '%' if depth == 0 && spaced => found = Precedence::Multiplicative,
            _ => {}
        }
    }
    found
}
