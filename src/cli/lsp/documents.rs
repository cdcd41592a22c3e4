//! The open documents.
//!
//! Input: notifications about documents. Output: their texts. A change of a document that is not open is an error.

use std::collections::BTreeMap;

use fragbuf::Registry;
use fragbuf::analysis::{Document, Lines};
use serde_json::Value;

use super::parameters::{self, RequestError};
use super::{frames, uri};

/// The greatest number of open documents.
const MAX_DOCUMENTS: usize = 1024;

/// A document that a client has opened.
#[derive(Debug)]
pub(super) struct Open {
    pub text: String,
    /// The version of the client, which diagnostics repeat.
    pub version: Value,
    /// Whether its diagnostics have to be published.
    pub is_changed: bool,
    /// The URIs of user files with diagnostics of this document.
    pub published: Vec<String>,
    /// The path that messages have, and whether it is one of a file.
    path: String,
    is_file: bool,
}

impl Open {
    fn new(uri: &str, text: String, version: Value) -> Self {
        let path = uri::path(uri);
        let is_file = path.is_some();
        let path = path.unwrap_or_else(|| uri.to_owned());
        Open { text, version, is_changed: true, published: Vec::new(), path, is_file }
    }

    /// Returns the document for analysis.
    pub(super) fn document<'a>(&'a self, registry: &'a Registry) -> Document<'a> {
        let document = Document::new(&self.text, &self.path, registry);
        if self.is_file { document.with_files() } else { document }
    }
}

/// The open documents, by their URIs.
#[derive(Debug, Default)]
pub(super) struct Documents(BTreeMap<String, Open>);

impl Documents {
    /// Returns an open document.
    pub(super) fn get(&self, uri: &str) -> Result<&Open, RequestError> {
        self.0.get(uri).ok_or_else(|| not_open(uri))
    }

    /// Returns the documents whose diagnostics have to be published.
    pub(super) fn changed(&mut self) -> impl Iterator<Item = (&String, &mut Open)> {
        self.0.iter_mut().filter(|(_, open)| open.is_changed)
    }

    /// Marks the documents as changed that have diagnostics in one of these files: another document has replaced them.
    pub(super) fn mark_those_with(&mut self, files: &[String]) {
        let has = |open: &Open| open.published.iter().any(|published| files.contains(published));
        self.0.values_mut().filter(|open| has(open)).for_each(|open| open.is_changed = true);
    }

    /// Marks every document as changed: a file that it names may have changed.
    pub(super) fn mark_all(&mut self) {
        self.0.values_mut().for_each(|open| open.is_changed = true);
    }

    /// Opens a document; an open one is replaced.
    pub(super) fn open(&mut self, parameters: &Value) -> Result<(), RequestError> {
        let uri = parameters::document(parameters)?;
        let text = parameters::string(parameters, "/textDocument/text")?;
        if self.0.len() >= MAX_DOCUMENTS && !self.0.contains_key(uri) {
            let message = format!("{MAX_DOCUMENTS} documents are open: close one");
            return Err(RequestError::new(RequestError::INVALID_REQUEST, message));
        }
        let version = parameters.pointer("/textDocument/version").cloned().unwrap_or_default();
        self.0.insert(uri.to_owned(), Open::new(uri, text.to_owned(), version));
        Ok(())
    }

    /// Changes the text of a document.
    pub(super) fn change(&mut self, parameters: &Value) -> Result<(), RequestError> {
        let uri = parameters::document(parameters)?;
        let open = self.0.get_mut(uri).ok_or_else(|| not_open(uri))?;
        let changes = parameters.pointer("/contentChanges").and_then(Value::as_array);
        for change in changes.into_iter().flatten() {
            let text = parameters::string(change, "/text")?;
            if change.get("range").is_some_and(|range| !range.is_null()) {
                let range = parameters::range(change, "/range")?;
                let lines = Lines::new(&open.text);
                let (start, end) = (lines.offset(range.start), lines.offset(range.end));
                open.text.replace_range(start.min(end)..end.max(start), text);
            } else {
                text.clone_into(&mut open.text);
            }
            if open.text.len() as u64 > frames::MAX_BYTES {
                let message = format!("`{uri}` has more than {} bytes: it is closed", frames::MAX_BYTES);
                self.0.remove(uri);
                return Err(RequestError::new(RequestError::INVALID_REQUEST, message));
            }
        }
        open.version = parameters.pointer("/textDocument/version").cloned().unwrap_or_default();
        open.is_changed = true;
        Ok(())
    }

    /// Closes a document, and returns it.
    pub(super) fn close(&mut self, parameters: &Value) -> Result<Open, RequestError> {
        let uri = parameters::document(parameters)?;
        self.0.remove(uri).ok_or_else(|| not_open(uri))
    }
}

fn not_open(uri: &str) -> RequestError {
    let message = format!("the document `{uri}` is not open: send `textDocument/didOpen` first");
    RequestError::new(RequestError::INVALID_PARAMS, message)
}
