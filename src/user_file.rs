//! Reads the user files that a description names instead of registry keys: `storage: wgsl("mine.wgsl")`.
//!
//! Input: a draft. Output: the registry with one more row per file, the sources that were read, and their diagnostics.
//! Only this module reads files that a description names. Paths are relative to the file that names them.

use std::path::Path;

use fragbuf_codegen::{user_row_warnings, validate_user_row};
use fragbuf_model::{Alternative, Diagnostic, Diagnostics, Draft, codes, nearest_name};
use fragbuf_syntax::row;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Row;

use crate::load::SET;
use crate::source_file::{self, NotUtf8};

/// The user files of a draft.
#[derive(Clone, Debug)]
pub struct UserFiles {
    /// The registry with the rows of the files.
    pub registry: Registry,
    /// The sources of the files by their names in messages.
    pub sources: Vec<(String, String)>,
    /// The errors in them.
    pub diagnostics: Diagnostics,
    /// The warnings about them.
    pub warnings: Diagnostics,
}

/// Reads every file that `draft` names. Lists a source once, even if several choices name it.
pub fn read(draft: &Draft, registry: &Registry) -> UserFiles {
    let mut user = UserFiles {
        registry: registry.clone(),
        sources: Vec::new(),
        diagnostics: Diagnostics::new(),
        warnings: Diagnostics::new(),
    };
    for choice in &draft.choices {
        for alternative in &choice.alternatives {
            if let Some(path) = alternative.file() {
                match read_row(alternative, path, &choice.axis.value, registry, &mut user.sources) {
                    Ok((row, warnings)) => {
                        user.registry = user.registry.with(row);
                        user.warnings.extend(warnings);
                    }
                    Err(errors) => user.diagnostics.extend(errors),
                }
            }
        }
    }
    user
}

/// Reads the row of one file and validates it; returns the warnings, too.
fn read_row(
    alternative: &Alternative,
    path: &str,
    axis: &str,
    registry: &Registry,
    sources: &mut Vec<(String, String)>,
) -> Result<(Row, Diagnostics), Diagnostics> {
    let value = &alternative.value;
    let folder = Path::new(&*value.span.file).parent().unwrap_or(Path::new(""));
    let file = folder.join(path).display().to_string();
    let text = source_file::read(&folder.join(path)).map_err(|error| {
        if let Some(found) = NotUtf8::from_error(&error) {
            sources.push((file.clone(), found.lossy.clone()));
            return found.diagnostic(&file).label(&value.span, "the description names it here");
        }
        let message = format!("`{file}` cannot be read: {error}");
        let help = match &*value.span.file == SET {
            true => "paths of `--set` are relative to the current folder",
            false => "paths are relative to the file that names them",
        };
        Diagnostic::new(codes::MISSING_FILE, &value.span, message, help)
    })?;
    if !sources.iter().any(|(known, _)| *known == file) {
        sources.push((file.clone(), text.clone()));
    }
    let user_row = row(&text, path, &value.value, &file)?;
    let known: Vec<&str> = registry.axes().iter().filter(|axis| axis.chosen).map(|axis| axis.key).collect();
    if !known.contains(&user_row.row.axis.as_str()) {
        let nearest = nearest_name(&user_row.row.axis, &known).map(|nearest| format!("did you mean `{nearest}`? "));
        let help = format!("{}the axes are {}", nearest.unwrap_or_default(), known.join(", "));
        let message = format!("there is no axis `{}`", user_row.row.axis);
        return Err(Diagnostic::new(codes::UNKNOWN_AXIS, &user_row.spans.row, message, help).into());
    }
    if user_row.row.axis != axis {
        let message = format!("`{path}` is a {}, not a {axis}", user_row.row.axis);
        let help = format!("write `{}: wgsl(\"{path}\");`, or change the first line of its row", user_row.row.axis);
        let diagnostic = Diagnostic::new(codes::UNKNOWN_VALUE, &value.span, message, help);
        return Err(diagnostic.label(&user_row.spans.row, "the file declares it here").into());
    }
    let warnings = user_row_warnings(&user_row, registry);
    Ok((validate_user_row(user_row, registry)?, warnings))
}
