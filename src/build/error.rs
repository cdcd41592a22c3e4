//! The error of a build script. `Debug` prints the report itself, because a `main` that returns the error uses `Debug`.

use std::fmt;
use std::path::Path;

/// The reason why not all files were written.
pub enum Error {
    /// Errors in a description: the report, with source lines.
    Description(String),
    /// A file that cannot be read or written.
    Files(String),
    /// A call with an unknown target, or a missing `OUT_DIR`.
    Usage(String),
}

impl Error {
    pub(crate) fn files(path: &Path, error: &std::io::Error) -> Self {
        Error::Files(format!("{}: {error}", path.display()))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Description(report) => write!(f, "fragbuf rejects a description\n\n{report}"),
            Error::Files(text) | Error::Usage(text) => f.write_str(text),
        }
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}
