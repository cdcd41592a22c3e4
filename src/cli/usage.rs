//! Errors of the argument parser, with the advice for negative values.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Replaces the advice for an argument that begins with a minus sign: it is a value of the option before it, and not one after `--`.
pub(crate) fn explained(mut error: clap::Error, arguments: &[String]) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidArg) else { return error };
    let found = arguments.windows(2).find(|pair| pair.iter().skip(1).any(|value| is_negative(value, unknown)));
    if let Some([option, value]) = found.filter(|pair| pair.iter().take(1).all(|option| option.starts_with("--"))) {
        let text = format!("to give `{value}` to `{option}`, write `{option}={value}`");
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(text)]));
    }
    error
}

/// Whether `value` is a number below 0 of which the parser reports `unknown`, its first characters.
fn is_negative(value: &str, unknown: &str) -> bool {
    let number = value.strip_prefix('-').unwrap_or_default();
    value.starts_with(unknown) && number.starts_with(|letter: char| letter.is_ascii_digit() || letter == '.')
}
