//! Errors that naga finds in the WGSL of a user file.
//!
//! Input: naga's message about a linked source, and its place. Output: the message and the help at the user's line. An unknown name is
//! compared with the names that the file can use: its own, the accessors of its buffers, and the functions of contracts.

use fragbuf_codegen::{CONTRACTS, LineSource, PassSource};
use fragbuf_model::{Diagnostic, Diagnostics, SourceSpan, codes, nearest_name};
use naga::SourceLocation;

use crate::rejection::{before_missing_semicolon, declared_names, explained, unknown_name};

/// Returns an error in a user file. It does not name the pass, unless the fix is in the line of the pass: the same line in several passes
/// gives one error.
pub(crate) fn user_file_error(
    pass: &PassSource,
    location: Option<SourceLocation>,
    message: &str,
    line: &SourceSpan,
) -> Diagnostics {
    if let Some(name) = unknown_name(message) {
        let span = location.and_then(|location| narrowed(pass, location, line)).unwrap_or_else(|| line.clone());
        let (message, help) = unknown(pass, name);
        return Diagnostic::new(codes::INVALID_WGSL, &span, message, help).into();
    }
    // The end of the statement before may be on another line of the file.
    let before = location.and_then(|location| before_missing_semicolon(message, location, &pass.text));
    let of_user = |location: &SourceLocation| match pass.lines.source(location.line_number as usize) {
        LineSource::UserFile(line) => Some(line),
        _ => None,
    };
    let (location, line) = match before.and_then(|before| Some((before, of_user(&before)?))) {
        Some((before, line)) => (Some(before), line),
        None => (location, line.clone()),
    };
    let span = location.and_then(|location| narrowed(pass, location, &line)).unwrap_or(line);
    let (message, fix) = explained(message, &pass.text);
    let accessors = all_accessors(pass).join("`, `");
    let is_about_values = !message.starts_with("expected ");
    let help = match accessors.is_empty() || !is_about_values {
        true => fix,
        false => format!("{fix}; the accessors of the row's buffers here are `{accessors}`"),
    };
    Diagnostic::new(codes::INVALID_WGSL, &span, message, help).into()
}

/// Returns the message and the help about an unknown name.
fn unknown(pass: &PassSource, name: &str) -> (String, String) {
    let needed = pass.user_buffers.iter().find_map(|buffer| Some((buffer, buffer.access_of(name)?)));
    let listed = all_accessors(pass);
    if let Some((buffer, access)) = needed
        && !listed.iter().any(|accessor| name_of(accessor) == name)
    {
        let declared = match buffer.access {
            Some(access) => format!("pass `{}` declares `{} {access}`", pass.name, buffer.name),
            None => format!("pass `{}` does not declare `{}`", pass.name, buffer.name),
        };
        let has = match buffer.accessors.as_slice() {
            [] => String::new(),
            accessors => format!("; it has `{}`", accessors.join("`, `")),
        };
        let help =
            format!("write `{} {access}` in the line of the pass, `//: pass {}: …`{has}", buffer.name, pass.name);
        return (format!("cannot find `{name}`: {declared}"), help);
    }
    let accessors = listed.iter().map(|accessor| name_of(accessor));
    let contracts = CONTRACTS.iter().map(|contract| contract.name);
    let mut names: Vec<&str> = accessors.chain(contracts).collect();
    names.extend(declared_names(&pass.text, name));
    let help = match nearest_name(name, &names) {
        Some(nearest) => {
            let signature = listed.iter().find(|accessor| name_of(accessor) == nearest).cloned();
            let contract = CONTRACTS.iter().find(|contract| contract.name == nearest);
            let signature = signature.or_else(|| contract.map(|found| format!("{nearest}{}", found.signature)));
            match signature {
                Some(signature) => format!("did you mean `{nearest}`? It is `fn {signature}`"),
                None => format!("did you mean `{nearest}`?"),
            }
        }
        None if listed.is_empty() => "declare it, or correct its name".to_owned(),
        None => format!(
            "declare it, or correct its name; the accessors of the row's buffers in pass `{}` are `{}`",
            pass.name,
            listed.join("`, `")
        ),
    };
    (format!("cannot find `{name}`"), help)
}

/// Returns the accessors of all buffers of the user file.
fn all_accessors(pass: &PassSource) -> Vec<String> {
    pass.user_buffers.iter().flat_map(|buffer| buffer.accessors.iter().cloned()).collect()
}

fn name_of(accessor: &str) -> &str {
    accessor.split('(').next().unwrap_or(accessor)
}

/// Returns naga's location within a line of a user file; `None` if renaming has changed the line's length.
fn narrowed(pass: &PassSource, location: SourceLocation, line: &SourceSpan) -> Option<SourceSpan> {
    let text = pass.text.lines().nth(location.line_number.checked_sub(1)? as usize)?;
    let indent = text.chars().count() - text.trim_start().chars().count();
    let is_same = indent as u32 + 1 == line.column && text.trim().chars().count() == line.length as usize;
    let before = text.get(..location.line_position.checked_sub(1)? as usize)?.chars().count() as u32;
    let most = (line.column + line.length).checked_sub(before + 1)?;
    let span = SourceSpan::new(line.file.clone(), line.line, before + 1).with_length(location.length.min(most));
    is_same.then_some(span)
}
