//! The parameters of messages.
//!
//! Input: JSON of a client. Output: their values, or an error that names the field.

use fragbuf::analysis::Position;
use serde_json::{Value, json};

/// An error that answers a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct RequestError {
    pub code: i32,
    pub message: String,
}

impl RequestError {
    pub(super) const PARSE: i32 = -32700;
    pub(super) const INVALID_REQUEST: i32 = -32600;
    pub(super) const METHOD_NOT_FOUND: i32 = -32601;
    pub(super) const INVALID_PARAMS: i32 = -32602;
    pub(super) const INTERNAL: i32 = -32603;
    pub(super) const NOT_INITIALIZED: i32 = -32002;

    pub(super) fn new(code: i32, message: impl Into<String>) -> Self {
        RequestError { code, message: message.into() }
    }

    /// Returns the message that answers a request.
    pub(super) fn answer(&self, id: &Value) -> Value {
        json!({ "jsonrpc": "2.0", "id": id, "error": { "code": self.code, "message": self.message } })
    }
}

/// A range of positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    pub start: Position,
    pub end: Position,
}

/// Returns the string at a JSON pointer.
pub(super) fn string<'a>(parameters: &'a Value, pointer: &str) -> Result<&'a str, RequestError> {
    parameters.pointer(pointer).and_then(Value::as_str).ok_or_else(|| missing(pointer, "a string"))
}

/// Returns the URI of the document that a message is about.
pub(super) fn document(parameters: &Value) -> Result<&str, RequestError> {
    string(parameters, "/textDocument/uri")
}

/// Returns the position at a JSON pointer.
pub(super) fn position(parameters: &Value, pointer: &str) -> Result<Position, RequestError> {
    let number = |field: &str| {
        let pointer = format!("{pointer}/{field}");
        let found = parameters.pointer(&pointer).and_then(Value::as_u64);
        // A number that is out of range is one behind the text.
        found.map(|number| u32::try_from(number).unwrap_or(u32::MAX)).ok_or_else(|| missing(&pointer, "a whole number"))
    };
    Ok(Position { line: number("line")?, character: number("character")? })
}

/// Returns the range at a JSON pointer.
pub(super) fn range(parameters: &Value, pointer: &str) -> Result<Range, RequestError> {
    let end = |field: &str| position(parameters, &format!("{pointer}/{field}"));
    Ok(Range { start: end("start")?, end: end("end")? })
}

fn missing(pointer: &str, what: &str) -> RequestError {
    let field = pointer.trim_start_matches('/').replace('/', ".");
    RequestError::new(RequestError::INVALID_PARAMS, format!("expected {what} in `params.{field}`"))
}
