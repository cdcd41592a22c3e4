//! Errors of the argument parser, with the advice for negative values.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Replaces the advice for an argument that begins with a minus sign: it is a value of the option before it, and not one after `--`.
/// Replaces the advice for an option of another command by the names of the commands that have it. Adds the advice for a value that an
/// option takes only behind `=`.
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
    if let Some(text) = value_after_option(arguments, program) {
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

/// Returns the advice for a value after an option that takes it only behind `=`, if the arguments are valid with `=`. Without it the value is
/// taken as a description, or is one too many.
fn value_after_option(arguments: &[String], program: &clap::Command) -> Option<String> {
    let command = program.get_subcommands().find(|command| arguments.iter().any(|word| word == command.get_name()))?;
    let is_after_equals = |option: &str| {
        let name = option.strip_prefix("--");
        let mut options = command.get_arguments().filter(|argument| argument.is_require_equals_set());
        name.is_some_and(|name| options.any(|argument| argument.get_long() == Some(name)))
    };
    (1..arguments.len()).find_map(|at| {
        let [option, value] = arguments.get(at - 1..=at)? else { return None };
        if !is_after_equals(option) || value.starts_with('-') {
            return None;
        }
        let joined = format!("{option}={value}");
        let (before, rest) = (arguments.get(..at - 1)?, arguments.get(at + 1..)?);
        let corrected = before.iter().chain(std::iter::once(&joined)).chain(rest);
        let parsed = program.clone().try_get_matches_from(corrected);
        parsed.is_ok().then(|| format!("to give `{value}` to `{option}`, write `{joined}`"))
    })
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
