//! The server: one message in, its answers out.
//!
//! Input: the text of a message. Output: messages, and whether the server ends. A request that panics is answered with an error.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use fragbuf::Registry;
use serde_json::{Value, json};

use super::documents::Documents;
use super::lifecycle::{State, capabilities};
use super::parameters::{self, RequestError};
use super::{answers, uri};

/// What the server does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    Continue,
    Exit,
}

/// The state of the server.
pub(super) struct Server {
    registry: Registry,
    documents: Documents,
    state: State,
}

impl Server {
    /// Makes a server that waits for `initialize`.
    pub(super) fn new() -> Self {
        Server { registry: Registry::builtin(), documents: Documents::default(), state: State::New }
    }

    /// Returns the exit code: 0 after `shutdown`, as the protocol demands.
    pub(super) fn exit_code(&self) -> ExitCode {
        if self.state == State::Stopped { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }

    /// Handles a message.
    pub(super) fn handle(&mut self, text: &[u8]) -> (Vec<Value>, Next) {
        let message: Value = match serde_json::from_slice(text) {
            Ok(message) => message,
            Err(error) => {
                let error = RequestError::new(RequestError::PARSE, format!("the message is not JSON: {error}"));
                return (vec![error.answer(&Value::Null)], Next::Continue);
            }
        };
        let method = message.get("method").and_then(Value::as_str);
        let id = message.get("id").filter(|id| id.is_string() || id.is_number());
        let parameters = message.get("params").unwrap_or(&Value::Null);
        match (method, id) {
            (Some(method), Some(id)) => (vec![self.answer(method, id, parameters)], Next::Continue),
            (Some("exit"), None) if message.get("id").is_none() => (Vec::new(), Next::Exit),
            (Some(method), None) if message.get("id").is_none() => (self.notify(method, parameters), Next::Continue),
            // The answer to a request of the server, which sends none.
            (None, Some(_)) if message.get("result").is_some() || message.get("error").is_some() => {
                (Vec::new(), Next::Continue)
            }
            _ => {
                let what = "a message has a `method`, and a request has an `id` that is a number or a string";
                let error = RequestError::new(RequestError::INVALID_REQUEST, what);
                (vec![error.answer(id.unwrap_or(&Value::Null))], Next::Continue)
            }
        }
    }

    /// Returns the diagnostics of the documents that have changed.
    pub(super) fn diagnostics(&mut self) -> Vec<Value> {
        if self.state != State::Running {
            return Vec::new();
        }
        let (mut messages, emptied) = self.diagnostics_of_changed();
        // A list replaces that of the same file: other documents may still have diagnostics there.
        self.documents.mark_those_with(&emptied);
        messages.extend(self.diagnostics_of_changed().0);
        messages
    }

    /// Returns the diagnostics of the documents that have changed, and the files of users that they no longer have any in.
    fn diagnostics_of_changed(&mut self) -> (Vec<Value>, Vec<String>) {
        let (mut messages, mut emptied) = (Vec::new(), Vec::new());
        let registry = &self.registry;
        for (uri, open) in self.documents.changed() {
            open.is_changed = false;
            let document = open.document(registry);
            let found = catch_unwind(AssertUnwindSafe(|| answers::diagnostics(&document, uri)));
            let Ok(mut found) = found else { continue };
            for earlier in &open.published {
                if !found.contains_key(earlier) {
                    emptied.push(earlier.clone());
                    found.insert(earlier.clone(), Vec::new());
                }
            }
            open.published = found.keys().filter(|other| *other != uri).cloned().collect();
            for (file, diagnostics) in found {
                let mut parameters = json!({ "uri": file, "diagnostics": diagnostics });
                if file == *uri && !open.version.is_null() {
                    parameters["version"] = open.version.clone();
                }
                messages.push(notification("textDocument/publishDiagnostics", parameters));
            }
        }
        (messages, emptied)
    }

    fn answer(&mut self, method: &str, id: &Value, parameters: &Value) -> Value {
        let answered = catch_unwind(AssertUnwindSafe(|| {
            self.state.accept(method)?;
            self.request(method, parameters)
        }));
        let answered = answered.unwrap_or_else(|_| {
            let message = format!("`{method}` failed: this is a defect of fragbuf");
            Err(RequestError::new(RequestError::INTERNAL, message))
        });
        match answered {
            Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
            Err(error) => error.answer(id),
        }
    }

    fn request(&mut self, method: &str, parameters: &Value) -> Result<Value, RequestError> {
        match method {
            "initialize" => {
                self.state = State::Running;
                Ok(capabilities())
            }
            "shutdown" => {
                self.state = State::Stopped;
                Ok(Value::Null)
            }
            "textDocument/hover" => self.at(parameters, |document, _, offset| answers::hover(document, offset)),
            "textDocument/completion" => {
                self.at(parameters, |document, _, offset| answers::completion(document, offset))
            }
            "textDocument/definition" => self.at(parameters, answers::definition),
            "textDocument/documentSymbol" => {
                let open = self.documents.get(parameters::document(parameters)?)?;
                Ok(answers::symbols(&open.document(&self.registry)))
            }
            "textDocument/codeAction" => self.actions(parameters),
            "workspace/textDocumentContent" => self.template(parameters).map(|text| json!({ "text": text })),
            _ => {
                let message = format!("the server has no method `{method}`");
                Err(RequestError::new(RequestError::METHOD_NOT_FOUND, message))
            }
        }
    }

    /// Answers a request about a position in a document.
    fn at(
        &self,
        parameters: &Value,
        answer: impl Fn(&fragbuf::analysis::Document<'_>, &str, usize) -> Value,
    ) -> Result<Value, RequestError> {
        let uri = parameters::document(parameters)?;
        let position = parameters::position(parameters, "/position")?;
        let open = self.documents.get(uri)?;
        let document = open.document(&self.registry);
        Ok(answer(&document, uri, document.lines().offset(position)))
    }

    fn actions(&self, parameters: &Value) -> Result<Value, RequestError> {
        let uri = parameters::document(parameters)?;
        let range = parameters::range(parameters, "/range")?;
        let open = self.documents.get(uri)?;
        let only = parameters.pointer("/context/only").and_then(Value::as_array);
        let is_asked = only.is_none_or(|kinds| kinds.iter().any(|kind| kind.as_str() == Some("quickfix")));
        Ok(if is_asked { answers::actions(&open.document(&self.registry), uri, range) } else { json!([]) })
    }

    /// Returns the source of a template.
    fn template(&self, parameters: &Value) -> Result<&str, RequestError> {
        let uri = parameters::string(parameters, "/uri").or_else(|_| parameters::document(parameters))?;
        let path = uri::template(uri).unwrap_or_default();
        let rows = self.registry.rows().iter().filter_map(|row| row.template.as_ref());
        let mut templates = rows.chain(self.registry.shared());
        let found = templates.find(|template| template.path == path.as_str());
        found
            .map(|template| &*template.source)
            .ok_or_else(|| RequestError::new(RequestError::INVALID_PARAMS, format!("there is no template `{uri}`")))
    }

    fn notify(&mut self, method: &str, parameters: &Value) -> Vec<Value> {
        if self.state != State::Running {
            return Vec::new();
        }
        let done = match method {
            "textDocument/didOpen" => self.documents.open(parameters),
            "textDocument/didChange" => self.documents.change(parameters),
            "textDocument/didClose" => match self.documents.close(parameters) {
                Ok(closed) => {
                    self.documents.mark_those_with(&closed.published);
                    let own = parameters::document(parameters).ok().map(str::to_owned);
                    let files = own.into_iter().chain(closed.published);
                    let empty =
                        |uri| notification("textDocument/publishDiagnostics", json!({ "uri": uri, "diagnostics": [] }));
                    return files.map(empty).collect();
                }
                Err(error) => Err(error),
            },
            // A user file may have been saved.
            "textDocument/didSave" | "workspace/didChangeWatchedFiles" => {
                self.documents.mark_all();
                Ok(())
            }
            _ => Ok(()),
        };
        match done {
            Ok(()) => Vec::new(),
            Err(error) => vec![notification("window/logMessage", json!({ "type": 1, "message": error.message }))],
        }
    }
}

fn notification(method: &str, parameters: Value) -> Value {
    json!({ "jsonrpc": "2.0", "method": method, "params": parameters })
}
