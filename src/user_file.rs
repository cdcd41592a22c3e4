//! Reads the user files that a description names instead of registry keys: `storage: wgsl("mine.wgsl")`.
//!
//! Input: a draft. Output: the registry with one more row per file, the sources that were read, and their diagnostics.
//! Only this module reads files that a description names. Paths are relative to the file that names them.

use std::path::Path;

use fragbuf_codegen::{user_row_warnings, validate_user_row};
use fragbuf_model::{Alternative, Diagnostic, Diagnostics, Draft, SourceSpan, codes, nearest_name};
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

/// Returns changes from outside in which the absolute paths of user files are relative to the current folder. Generated source has the
/// paths of user files, and messages about the change name them.
pub(crate) fn with_relative_paths(set: &[(String, String)]) -> Vec<(String, String)> {
    let folder = std::env::current_dir().unwrap_or_default();
    let relative = |value: &str| {
        let alternatives = value.split(" else ").map(|alternative| {
            let start = ["wgsl(\"", "wgsl("]
                .iter()
                .find(|start| alternative.starts_with(**start))
                .map_or(0, |start| start.len());
            let (before, rest) = alternative.split_at(start);
            let end = rest.find(".wgsl").map_or(0, |at| at + ".wgsl".len());
            let (path, after) = rest.split_at(end);
            match Path::new(path).is_absolute() {
                true => format!("{before}{}{after}", relative_path(Path::new(path), &folder)),
                false => alternative.to_owned(),
            }
        });
        alternatives.collect::<Vec<_>>().join(" else ")
    };
    set.iter().map(|(name, value)| (name.clone(), relative(value))).collect()
}

/// Returns an absolute path as seen from a folder, with `/` between its parts.
fn relative_path(path: &Path, folder: &Path) -> String {
    let (path, folder): (Vec<_>, Vec<_>) = (path.components().collect(), folder.components().collect());
    let common = path.iter().zip(&folder).take_while(|(a, b)| a == b).count();
    let up = folder.iter().skip(common).map(|_| "..".to_owned());
    let down = path.iter().skip(common).map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// Values that no row has, and the user files of the same name.
pub(crate) struct NearNames(Vec<(SourceSpan, String)>);

/// Returns the user files that are beside a description, or in the current folder, and whose names a draft gives as values without `.wgsl`.
pub(crate) fn near_names(draft: &Draft, description: &str, registry: &Registry) -> NearNames {
    let mut found = Vec::new();
    for choice in &draft.choices {
        let unknown = choice
            .alternatives
            .iter()
            .map(|alternative| &alternative.value)
            .filter(|value| !value.value.is_empty() && registry.row(&choice.axis.value, &value.value).is_none());
        for value in unknown {
            let is_set = &*value.span.file == SET;
            let folder = if is_set { Path::new("") } else { Path::new(description).parent().unwrap_or(Path::new("")) };
            let name = format!("{}.wgsl", value.value);
            if is_file_name(&value.value) && folder.join(&name).is_file() {
                let written = match is_set {
                    true => format!("{SET} {}={name}", choice.axis.value),
                    false => format!("{}: wgsl(\"{name}\")", choice.axis.value),
                };
                found.push((value.span.clone(), format!("for the file `{name}`, write `{written}`")));
            }
        }
    }
    NearNames(found)
}

/// Whether a value could be the name of a file in the same folder.
fn is_file_name(value: &str) -> bool {
    value.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-')
}

impl NearNames {
    /// Adds the files to the errors about the values.
    pub(crate) fn named_in(&self, errors: Diagnostics) -> Diagnostics {
        let with_file = |error: &Diagnostic| {
            let file = self.0.iter().find(|(span, _)| error.code == codes::UNKNOWN_VALUE && *span == error.span);
            let help = file.map_or_else(|| error.help.clone(), |(_, file)| format!("{file}; {}", error.help));
            Diagnostic { help, ..error.clone() }
        };
        errors.iter().map(with_file).collect()
    }
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
