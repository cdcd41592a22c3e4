//! Writes text to stdout, and failures to stderr with their exit code.

use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::OnceLock;

use fragbuf::report::{self, render, render_colored};
use fragbuf::source_file::NotUtf8;
use fragbuf_model::{Diagnostics, nearest_name};
use serde_json::json;

/// The format of messages on stderr.
#[derive(Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum MessageFormat {
    #[default]
    Text,
    Json,
}

/// The use of colours.
#[derive(Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ColorChoice {
    #[default]
    Auto,
    Always,
    Never,
}

/// How messages are written: the options of every command.
static MESSAGES: OnceLock<(MessageFormat, bool)> = OnceLock::new();

/// Sets how messages are written, once per process.
pub(crate) fn set_messages(format: MessageFormat, color: ColorChoice) {
    let has = |variable: &str, value: Option<&str>| {
        std::env::var_os(variable).is_some_and(|found| value.map_or(!found.is_empty(), |value| found == value))
    };
    let is_colored = match color {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => std::io::stderr().is_terminal() && !has("NO_COLOR", None) && !has("TERM", Some("dumb")),
    };
    // The first call alone counts.
    let _ = MESSAGES.set((format, is_colored));
}

fn messages() -> (MessageFormat, bool) {
    MESSAGES.get().copied().unwrap_or_default()
}

/// Formats diagnostics as the options of the command request.
fn diagnostics_text(diagnostics: &Diagnostics, sources: &[(String, String)]) -> String {
    match messages() {
        (MessageFormat::Json, _) => {
            diagnostics.iter().map(|diagnostic| format!("{}\n", report::json(diagnostic))).collect()
        }
        (MessageFormat::Text, true) => render_colored(diagnostics, sources),
        (MessageFormat::Text, false) => render(diagnostics, sources),
    }
}

/// Formats a message without a place in a source.
fn message_text(severity: &str, code: Option<&str>, text: &str) -> String {
    let label = code.map_or(severity.to_owned(), |code| format!("{severity}[{code}]"));
    match messages() {
        (MessageFormat::Json, _) => format!("{}\n", json!({ "severity": severity, "code": code, "message": text })),
        (MessageFormat::Text, false) => format!("{label}: {text}\n"),
        (MessageFormat::Text, true) => {
            let color = match severity {
                "error" => 31,
                "warning" => 33,
                _ => 36,
            };
            format!("\x1b[1;{color}m{label}\x1b[0m: {text}\n")
        }
    }
}

/// Prints the warnings about a description on stderr.
pub(crate) fn warnings(diagnostics: &Diagnostics, sources: &[(String, String)]) {
    // Ignore the error: there is no other stream to report it on.
    let _ = std::io::stderr().write_all(diagnostics_text(diagnostics, sources).as_bytes());
}

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

    /// Returns the failure for a folder to write to that is a file.
    pub(crate) fn unless_folder(path: &Path) -> Result<(), Self> {
        match path.exists() && !path.is_dir() {
            true => Err(Failure::Files(format!("{} is a file: give a folder", path.display()))),
            false => Ok(()),
        }
    }

    /// Returns the failure for an error that [`fragbuf::source_file::read`] returns for `path`.
    pub(crate) fn source(path: &Path, error: &std::io::Error) -> Self {
        let file = path.display().to_string();
        match NotUtf8::from_error(error) {
            Some(found) => Failure::Description(found.diagnostic(&file).into(), vec![(file, found.lossy.clone())]),
            None => Failure::files(path, error),
        }
    }

    /// Returns the failure for an unknown name of a `kind`: the nearest of the known names, and all of them.
    pub(crate) fn unknown(kind: &str, name: &str, known: &[&str]) -> Self {
        let nearest = nearest_name(name, known).map_or(String::new(), |nearest| format!("did you mean `{nearest}`? "));
        Failure::Usage(format!("no {kind} `{name}`: {nearest}give one of {}", known.join(", ")))
    }

    /// Returns what is wrong, without `error:` and without colours.
    #[cfg(feature = "playground")]
    pub(crate) fn message(&self) -> String {
        match self {
            Failure::Description(diagnostics, sources) => render(diagnostics, sources),
            Failure::Usage(text) | Failure::Files(text) | Failure::Input(text) | Failure::Device(text) => text.clone(),
            Failure::Model(warnings) => warnings.iter().map(|warning| format!("{warning}\n")).collect(),
        }
    }

    /// Prints the failure on stderr and returns its exit code.
    pub(crate) fn report(self) -> ExitCode {
        let (text, code) = match self {
            Failure::Description(diagnostics, sources) => (diagnostics_text(&diagnostics, &sources), 1),
            Failure::Usage(text) => (message_text("error", None, &text), 2),
            Failure::Files(text) => (message_text("error", None, &text), 3),
            Failure::Input(text) => (message_text("error", None, &text), 1),
            #[cfg(feature = "pictures")]
            Failure::Model(warnings) => {
                let line = |warning: &fragbuf_scene::Warning| {
                    message_text("error", Some(warning.kind.code()), &warning.without_instead().to_string())
                };
                let note = message_text("note", None, "`--strict` rejects the model; without it, these are warnings");
                (warnings.iter().map(line).chain([note]).collect(), 1)
            }
            #[cfg(feature = "pictures")]
            Failure::Device(text) => (message_text("error", None, &text), 3),
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
            fragbuf_scene::Error::Malformed { .. } | fragbuf_scene::Error::MissingAttribute { .. } => {
                Failure::Input(text)
            }
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
            | fragbuf_cpu::Error::Frame(FrameError::Unsupported { .. } | FrameError::Host { .. }) => {
                Failure::Input(text)
            }
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
            fragbuf_runtime::Error::Unsupported { .. } | fragbuf_runtime::Error::Host { .. } => Failure::Input(text),
            fragbuf_runtime::Error::BadValue { .. } => Failure::Usage(text),
            // The CPU device has the same budget.
            fragbuf_runtime::Error::OverBudget(_) => Failure::Device(text),
            _ => Failure::Device(format!("{text}; `--device cpu` renders without a driver")),
        }
    }
}

/// Prints a warning on stderr.
pub(crate) fn warn(text: &str) {
    // Ignore the error: there is no other stream to report it on.
    let _ = std::io::stderr().write_all(message_text("warning", None, text).as_bytes());
}

/// Prints a note on stderr.
pub(crate) fn note(text: &str) {
    // Ignore the error: there is no other stream to report it on.
    let _ = std::io::stderr().write_all(message_text("note", None, text).as_bytes());
}

/// Prints a warning with its code on stderr.
#[cfg(feature = "pictures")]
pub(crate) fn warn_code(code: &str, text: &str) {
    // Ignore the error: there is no other stream to report it on.
    let _ = std::io::stderr().write_all(message_text("warning", Some(code), text).as_bytes());
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

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::Failure;

    #[test]
    fn a_failing_driver_is_an_error_that_names_the_cpu_device() {
        let lost = Failure::from(fragbuf_runtime::Error::DeviceLost);
        assert!(matches!(lost, Failure::Device(text) if text.ends_with("; `--device cpu` renders without a driver")));
    }
}
