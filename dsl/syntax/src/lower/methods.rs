//! Calls from the method table: the row's spelling with the arguments put in.
//!
//! In: a row's spelling and arguments. Out: text. An argument that the spelling repeats is named first, unless it is a
//! name already; and a call in which all is constant gets one named argument, so that WGSL does not evaluate it when the
//! shader is created and refuse what Rust gives infinity for.

use super::Lowering;
use super::needs::{is_plain, occurs_twice};
use super::text::{Level, Text, arguments_text};
use crate::methods::Spelling;
use crate::tree::Expr;

impl Lowering<'_> {
    pub(super) fn method(&mut self, spelling: Spelling, arguments: &[Expr]) -> Text {
        let mut texts = self.operands(&arguments.iter().collect::<Vec<_>>());
        let all_constant = self.all_constant(arguments);
        for (index, (argument, text)) in arguments.iter().zip(&mut texts).enumerate() {
            let repeated = occurs_twice(spelling, index) && !is_plain(argument);
            if repeated || (all_constant && index == 0) {
                *text = self.bind("value", text, &argument.origin);
            }
        }
        match spelling {
            Spelling::Call(name) => Text::call(name, &texts),
            Spelling::Text(template) => {
                let receiver = arguments.first().map(|receiver| self.function.type_of(receiver));
                fill(template, &texts, receiver.map_or("f32", |receiver| receiver.wgsl()))
            }
        }
    }

    /// Gives a value a name: writes `let name = …;`.
    pub(super) fn bind(&mut self, wanted: &str, text: &Text, origin: &fragbuf_model::Origin) -> Text {
        let name = self.names.fresh(wanted);
        self.emit(format!("let {name} = {};", text.text), origin);
        Text::primary(name)
    }
}

/// A spelling with its `$0`, `$1`, … replaced.
pub(super) fn fill(template: &str, arguments: &[Text], own: &str) -> Text {
    let mut text = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('$') {
        text.push_str(before);
        let mut letters = after.chars();
        let mark = letters.next();
        rest = letters.as_str();
        match mark.and_then(|mark| mark.to_digit(10)).and_then(|index| arguments.get(index as usize)) {
            Some(argument) => text.push_str(&placed(argument, &text, rest)),
            None => text.push_str(own),
        }
    }
    text.push_str(rest);
    Text { text, level: level(template) }
}

/// An argument as it stands between what precedes and what follows.
fn placed(argument: &Text, before: &str, after: &str) -> String {
    if after.starts_with('.') {
        return argument.postfixed();
    }
    let opens = before.ends_with('(') || before.ends_with(", ");
    let closes = after.starts_with(')') || after.starts_with(", ");
    match opens && closes {
        true => arguments_text(std::slice::from_ref(argument)),
        false => argument.unary(),
    }
}

/// The level of a spelling: its outermost operator.
fn level(template: &str) -> Level {
    let mut depth = 0_i32;
    let mut found = if template.starts_with('-') { Level::Unary } else { Level::Primary };
    for (index, letter) in template.char_indices() {
        let spaced = template.get(..index).is_some_and(|before| before.ends_with(' '));
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            '+' | '-' if depth == 0 && spaced => return Level::Additive,
            '*' | '/' | '%' if depth == 0 && spaced => found = Level::Multiplicative,
            _ => {}
        }
    }
    found
}
