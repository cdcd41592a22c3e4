//! Errors of the argument parser, with the advice for negative values.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Replaces the advice for an argument that begins with a minus sign: it is a value of the option before it, and not one after `--`.
/// Replaces the advice for an option of another command by the names of the commands that have it.
pub(crate) fn explained(mut error: clap::Error, arguments: &[String], program: &clap::Command) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidArg) else { return error };
    if let Some(text) = option_of_others(unknown, program) {
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(text)]));
        return error;
    }
    let found = arguments.windows(2).find(|pair| pair.iter().skip(1).any(|value| is_negative(value, unknown)));
    if let Some([option, value]) = found.filter(|pair| pair.iter().take(1).all(|option| option.starts_with("--"))) {
        let text = format!("to give `{value}` to `{option}`, write `{option}={value}`");
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(text)]));
    }
    error
}

/// Returns the advice for an option that other commands have.
fn option_of_others(unknown: &str, program: &clap::Command) -> Option<String> {
    let name = unknown.strip_prefix("--")?.split('=').next()?;
    let has = |command: &&clap::Command| command.get_arguments().any(|argument| argument.get_long() == Some(name));
    let commands: Vec<String> =
        program.get_subcommands().filter(has).map(|command| format!("`{}`", command.get_name())).collect();
    (!commands.is_empty()).then(|| format!("`--{name}` is an option of {}", commands.join(", ")))
}

/// Whether `value` is a number below 0 of which the parser reports `unknown`, its first characters.
fn is_negative(value: &str, unknown: &str) -> bool {
    let number = value.strip_prefix('-').unwrap_or_default();
    value.starts_with(unknown) && number.starts_with(|letter: char| letter.is_ascii_digit() || letter == '.')
}
