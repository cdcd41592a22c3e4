//! Writes text to stdout, and failures to stderr with their exit code.

use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use fragbuf::report::render;
use fragbuf_model::Diagnostics;

/// The reason why a command failed.
pub(crate) enum Failure {
    /// Errors in the description, with the sources by file name.
    Description(Diagnostics, Vec<(String, String)>),
    /// An invalid argument.
    Usage(String),
    /// A file could not be read or written.
    Files(String),
    /// An error in a scene or a shader.
    Input(String),
    /// Parts of a model that are missing, malformed or not read.
    #[cfg(feature = "pictures")]
    Model(Vec<fragbuf_scene::Warning>),
    /// A limit or a failure of the device.
    #[cfg(feature = "pictures")]
    Device(String),
}

impl Failure {
    /// Returns the failure for a file system error on `path`.
    pub(crate) fn files(path: &Path, error: &std::io::Error) -> Self {
        Failure::Files(format!("{}: {error}", path.display()))
    }

    /// Prints the failure on stderr and returns its exit code.
    pub(crate) fn report(self) -> ExitCode {
        let (text, code) = match self {
            Failure::Description(diagnostics, sources) => (render(&diagnostics, &sources), 1),
            Failure::Usage(text) => (format!("error: {text}\n"), 2),
            Failure::Files(text) => (format!("error: {text}\n"), 3),
            Failure::Input(text) => (format!("error: {text}\n"), 1),
            #[cfg(feature = "pictures")]
            Failure::Model(warnings) => {
                let lines = warnings.iter().map(|warning| format!("error[{}]: {warning}\n", warning.kind.code()));
                (lines.collect(), 1)
            }
            #[cfg(feature = "pictures")]
            Failure::Device(text) => (format!("error: {text}\n"), 3),
        };
        // Ignore the error: there is no other stream to report it on.
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
            fragbuf_scene::Error::TooLarge { .. } => Failure::Device(format!("{text} (`--memory`)")),
            fragbuf_scene::Error::Malformed { .. } => Failure::Input(text),
            fragbuf_scene::Error::Unknown(_) => Failure::Usage(text),
        }
    }
}

#[cfg(feature = "pictures")]
impl From<fragbuf_cpu::Error> for Failure {
    fn from(error: fragbuf_cpu::Error) -> Self {
        use fragbuf_frame::Error as FrameError;
        let text = error.to_string();
        match error {
            fragbuf_cpu::Error::MissingFeature(_)
            | fragbuf_cpu::Error::Shader { .. }
            | fragbuf_cpu::Error::Frame(FrameError::Unsupported { .. }) => Failure::Input(text),
            fragbuf_cpu::Error::Frame(FrameError::BadValue { .. }) => Failure::Usage(text),
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

/// Prints a warning on stderr.
pub(crate) fn warn(text: &str) {
    // Ignore the error: there is no other stream to report it on.
    let _ = writeln!(std::io::stderr(), "warning: {text}");
}

/// Prints a warning with its code on stderr.
#[cfg(feature = "pictures")]
pub(crate) fn warn_code(code: &str, text: &str) {
    // Ignore the error: there is no other stream to report it on.
    let _ = writeln!(std::io::stderr(), "warning[{code}]: {text}");
}

/// Writes to stdout. A closed pipe (`| head`) is not a failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::files(Path::new("stdout"), &error)),
        _ => Ok(()),
    }
}

/// Formats pretty JSON with a final newline.
pub(crate) fn json(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}
