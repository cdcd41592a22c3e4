//! What goes to the user: text on stdout, failures on stderr with their exit code.

use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use fragbuf::report::render;
use fragbuf_model::Diagnostics;

/// Why a command did not do what it was asked.
pub(crate) enum Failure {
    /// The description is at fault; the texts by file name.
    Description(Diagnostics, Vec<(String, String)>),
    /// The command line asks for what there is not.
    Usage(String),
    /// A file could not be read or written.
    Files(String),
    /// A scene or a shader is at fault.
    Input(String),
    /// The device cannot do it.
    #[cfg(feature = "pictures")]
    Device(String),
}

impl Failure {
    /// A file system error on `path`.
    pub(crate) fn files(path: &Path, error: &std::io::Error) -> Self {
        Failure::Files(format!("{}: {error}", path.display()))
    }

    /// Says so on stderr.
    pub(crate) fn report(self) -> ExitCode {
        let (text, code) = match self {
            Failure::Description(diagnostics, sources) => (render(&diagnostics, &sources), 1),
            Failure::Usage(text) => (format!("error: {text}\n"), 2),
            Failure::Files(text) => (format!("error: {text}\n"), 3),
            Failure::Input(text) => (format!("error: {text}\n"), 1),
            #[cfg(feature = "pictures")]
            Failure::Device(text) => (format!("error: {text}\n"), 3),
        };
        // Nobody is left to tell when stderr is gone.
        let _ = std::io::stderr().write_all(text.as_bytes());
        ExitCode::from(code)
    }
}

#[cfg(feature = "pictures")]
impl From<fragbuf_scene::Error> for Failure {
    fn from(error: fragbuf_scene::Error) -> Self {
        let text = error.to_string();
        match error {
            fragbuf_scene::Error::Unreadable { .. } => Failure::Files(text),
            fragbuf_scene::Error::Malformed { .. } => Failure::Input(text),
            fragbuf_scene::Error::Unknown(_) => Failure::Usage(text),
        }
    }
}

#[cfg(feature = "pictures")]
impl From<fragbuf_cpu::Error> for Failure {
    fn from(error: fragbuf_cpu::Error) -> Self {
        use fragbuf_frame::Error as Numbers;
        let text = error.to_string();
        match error {
            fragbuf_cpu::Error::Refused(_)
            | fragbuf_cpu::Error::Shader { .. }
            | fragbuf_cpu::Error::Frame(Numbers::Unsupported { .. }) => Failure::Input(text),
            fragbuf_cpu::Error::Frame(Numbers::BadValue { .. }) => Failure::Usage(text),
            _ => Failure::Device(text),
        }
    }
}

#[cfg(feature = "gpu")]
impl From<fragbuf_runtime::Error> for Failure {
    fn from(error: fragbuf_runtime::Error) -> Self {
        let text = error.to_string();
        match error {
            fragbuf_runtime::Error::Unsupported { .. } => Failure::Input(text),
            fragbuf_runtime::Error::BadValue { .. } => Failure::Usage(text),
            _ => Failure::Device(text),
        }
    }
}

/// Says something on stderr without giving up.
pub(crate) fn warn(text: &str) {
    // Nobody is left to tell when stderr is gone.
    let _ = writeln!(std::io::stderr(), "warning: {text}");
}

/// Writes to stdout. A reader that has seen enough (`| head`) is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::files(Path::new("stdout"), &error)),
        _ => Ok(()),
    }
}

/// Pretty JSON with a final newline.
pub(crate) fn json(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}
