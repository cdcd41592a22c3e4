//! Files of the user's own that a description names in place of words of the registry: `storage: wgsl("mine.wgsl")`.
//!
//! In: a draft. Out: the registry with a row more for each file, the texts that were read, and what is wrong with them.
//! This is the only place where a description leads to a file; paths are relative to the text that names them.

use std::path::Path;

use fragbuf_codegen::adopt;
use fragbuf_model::{Alternative, Diagnostic, Diagnostics, Draft, codes};
use fragbuf_syntax::row;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Row;

/// What came of reading a draft's files.
#[derive(Clone, Debug)]
pub struct Own {
    /// The registry with the rows of the files.
    pub registry: Registry,
    /// The files' texts by their names in messages.
    pub sources: Vec<(String, String)>,
    /// What is wrong.
    pub diagnostics: Diagnostics,
}

/// Reads every file that `draft` names. A file that is named twice on one axis is read once.
pub fn read(draft: &Draft, registry: &Registry) -> Own {
    let mut own = Own { registry: registry.clone(), sources: Vec::new(), diagnostics: Diagnostics::new() };
    for choice in &draft.choices {
        for alternative in &choice.alternatives {
            if let Some(path) = alternative.file() {
                match adopted(alternative, path, &choice.axis.value, registry, &mut own.sources) {
                    Ok(row) => own.registry = own.registry.with(row),
                    Err(faults) => own.diagnostics.extend(faults),
                }
            }
        }
    }
    own
}

fn adopted(
    alternative: &Alternative,
    path: &str,
    axis: &str,
    registry: &Registry,
    sources: &mut Vec<(String, String)>,
) -> Result<Row, Diagnostics> {
    let value = &alternative.value;
    let beside = Path::new(&*value.origin.file).parent().unwrap_or(Path::new(""));
    let file = beside.join(path).display().to_string();
    let text = std::fs::read_to_string(beside.join(path)).map_err(|error| {
        let message = format!("`{file}` cannot be read: {error}");
        Diagnostic::new(codes::MISSING_FILE, &value.origin, message, "paths are relative to the file that names them")
    })?;
    if !sources.iter().any(|(known, _)| *known == file) {
        sources.push((file.clone(), text.clone()));
    }
    let own = row(&text, path, &value.value, &file)?;
    if own.row.axis != axis {
        let message = format!("`{path}` is a {}, not a {axis}", own.row.axis);
        let hint = format!("write `{}: wgsl(\"{path}\");`, or change the first line of its row", own.row.axis);
        let diagnostic = Diagnostic::new(codes::UNKNOWN_VALUE, &value.origin, message, hint);
        return Err(diagnostic.label(&own.places.row, "the file says so here").into());
    }
    adopt(own, registry)
}
