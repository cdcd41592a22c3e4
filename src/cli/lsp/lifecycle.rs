//! The states of a server: before `initialize`, running, after `shutdown`.
//!
//! Input: the method of a message. Output: whether it is accepted.

use serde_json::{Value, json};

use super::parameters::RequestError;
use super::uri;

/// The state of a server.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum State {
    /// Before `initialize`.
    #[default]
    New,
    Running,
    /// After `shutdown`.
    Stopped,
}

impl State {
    /// Returns the error of a request that this state does not accept.
    pub(super) fn accept(self, method: &str) -> Result<(), RequestError> {
        match (self, method) {
            (State::New, "initialize") => Ok(()),
            (State::New, _) => {
                let message = "the server is not initialised: send `initialize` first";
                Err(RequestError::new(RequestError::NOT_INITIALIZED, message))
            }
            (State::Running, "initialize") => {
                Err(RequestError::new(RequestError::INVALID_REQUEST, "`initialize` is sent once"))
            }
            (State::Running, _) => Ok(()),
            (State::Stopped, _) => {
                let message = "the server is shut down: send `exit`";
                Err(RequestError::new(RequestError::INVALID_REQUEST, message))
            }
        }
    }
}

/// Returns what the server can do.
pub(super) fn capabilities() -> Value {
    json!({
        "capabilities": {
            "positionEncoding": "utf-16",
            "textDocumentSync": { "openClose": true, "change": 2, "save": { "includeText": false } },
            "hoverProvider": true,
            "completionProvider": { "triggerCharacters": [".", ":", "{", "|", " "] },
            "definitionProvider": true,
            "documentSymbolProvider": true,
            "codeActionProvider": { "codeActionKinds": ["quickfix"] },
            "workspace": { "textDocumentContent": { "schemes": [uri::TEMPLATE] } },
        },
        "serverInfo": { "name": "fragbuf", "version": env!("CARGO_PKG_VERSION") },
    })
}
