//! What is wrong with a scene, and where.

use std::fmt;

/// Why there is no scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// A file cannot be read.
    Unreadable {
        /// The file.
        file: String,
        /// The system's words.
        reason: String,
    },
    /// A file was read, and is no model that this crate takes.
    Malformed {
        /// The file.
        file: String,
        /// Where in it.
        place: Place,
        /// What is wrong.
        message: String,
    },
    /// `builtin:…` asks for what there is not.
    Unknown(String),
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line, from 1.
    Line(usize),
    /// A byte of a binary file, from 0; of what was compressed, after decompression.
    Byte(usize),
    /// Nowhere in particular.
    Whole,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Unreadable { file, reason } => write!(f, "{file}: {reason}"),
            Error::Malformed { file, place: Place::Line(line), message } => write!(f, "{file}:{line}: {message}"),
            Error::Malformed { file, place: Place::Byte(byte), message } => {
                write!(f, "{file}: at byte {byte}: {message}")
            }
            Error::Malformed { file, place: Place::Whole, message } => write!(f, "{file}: {message}"),
            Error::Unknown(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {}

/// A place and what is wrong there, before the file's name is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault(pub(crate) Place, pub(crate) String);

impl Fault {
    pub(crate) fn line(line: usize, message: impl Into<String>) -> Self {
        Fault(Place::Line(line), message.into())
    }

    pub(crate) fn whole(message: impl Into<String>) -> Self {
        Fault(Place::Whole, message.into())
    }

    /// The fault of this file.
    pub(crate) fn of(self, file: &str) -> Error {
        Error::Malformed { file: file.to_owned(), place: self.0, message: self.1 }
    }
}
