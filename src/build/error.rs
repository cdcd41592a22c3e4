//! Why a build script stops. `Debug` is the report itself: a `main` that returns the error prints it so.

use std::fmt;
use std::path::Path;

/// Why nothing, or not everything, was written.
pub enum Error {
    /// A description is at fault: the report, with source lines.
    Description(String),
    /// A file cannot be read or written.
    Files(String),
    /// The build script asks for what there is not.
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
            Error::Description(report) => write!(f, "fragbuf refuses a description\n\n{report}"),
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
