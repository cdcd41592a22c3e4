//! The errors of scenes, with their positions.

use std::fmt;

/// Why a scene cannot be loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// A file cannot be read.
    Unreadable {
        /// The file.
        file: String,
        /// The reason that the system reports.
        reason: String,
    },
    /// A file is not a valid or supported model.
    Malformed {
        /// The file.
        file: String,
        /// The position in the file.
        position: FilePosition,
        /// The message.
        message: String,
    },
    /// `builtin:…` names an unknown scene or parameter, or an invalid value.
    Unknown(String),
}

/// A position in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// A line, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0, after decompression.
    Byte(usize),
    /// The whole file.
    Whole,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Unreadable { file, reason } => write!(f, "{file}: {reason}"),
            Error::Malformed { file, position: FilePosition::Line(line), message } => {
                write!(f, "{file}:{line}: {message}")
            }
            Error::Malformed { file, position: FilePosition::Byte(byte), message } => {
                write!(f, "{file}: at byte {byte}: {message}")
            }
            Error::Malformed { file, position: FilePosition::Whole, message } => write!(f, "{file}: {message}"),
            Error::Unknown(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {}

/// An error in a file whose name is not known yet: its position and message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FileError(pub(crate) FilePosition, pub(crate) String);

impl FileError {
    pub(crate) fn line(line: usize, message: impl Into<String>) -> Self {
        FileError(FilePosition::Line(line), message.into())
    }

    pub(crate) fn whole(message: impl Into<String>) -> Self {
        FileError(FilePosition::Whole, message.into())
    }

    /// Adds the name of the file.
    pub(crate) fn in_file(self, file: &str) -> Error {
        Error::Malformed { file: file.to_owned(), position: self.0, message: self.1 }
    }
}
