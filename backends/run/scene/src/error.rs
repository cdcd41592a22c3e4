//! The errors of scenes, with their positions.

use std::fmt;

use crate::attribute::{AttributeRequest, AvailableAttribute};

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
    /// A scene needs more memory than its limits allow ([`Limits`](crate::Limits)).
    TooLarge {
        /// The file, or the name of the generated scene.
        file: String,
        /// The part of the scene that exceeds the limit.
        what: String,
        /// The bytes of the part, as far as they are known.
        needed: u64,
        /// The bytes that are left for it.
        left: u64,
        /// The bytes of the whole limit.
        limit: u64,
    },
    /// The vertices of a scene have no attribute of this name and number of components.
    MissingAttribute {
        /// The file, or the name of the generated scene.
        scene: String,
        /// The attribute that the caller requested.
        request: AttributeRequest,
        /// The attributes that can be requested.
        available: Vec<AvailableAttribute>,
        /// The position of something of this name in the file, and why it is no attribute of vertices.
        other: Option<Box<(FilePosition, String)>>,
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
            Error::Malformed { file, position, message } => located(f, file, *position, message),
            Error::TooLarge { file, what, needed, left, limit } => write!(
                f,
                "{file}: out of the memory budget: {needed} bytes or more are needed for {what}, and {left} of {limit} bytes are left: use a smaller model or a larger budget"
            ),
            Error::MissingAttribute { scene, request: AttributeRequest { name, components, .. }, other, .. } => {
                let plural = if *components == 1 { "" } else { "s" };
                let message = format!("vertices have no attribute `{name}` with {components} component{plural}");
                match other.as_deref() {
                    Some((position, reason)) => located(f, scene, *position, &format!("{message}: {reason}")),
                    None => write!(f, "{scene}: {message}"),
                }
            }
            Error::Unknown(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {}

/// Writes a message with its position.
pub(crate) fn located(f: &mut fmt::Formatter<'_>, file: &str, position: FilePosition, message: &str) -> fmt::Result {
    match position {
        FilePosition::Line(line) => write!(f, "{file}:{line}: {message}"),
        FilePosition::Byte(byte) => write!(f, "{file}: at byte {byte}: {message}"),
        FilePosition::Whole => write!(f, "{file}: {message}"),
    }
}

/// An error in a file whose name is not known yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FileError {
    /// The position and the message.
    Malformed(FilePosition, String),
    /// The message about an element of a list of glTF, whose position is not known yet.
    InElement { list: &'static str, index: usize, message: String },
    /// A part of the scene exceeds the limits.
    TooLarge { what: String, needed: u64, left: u64, limit: u64 },
    /// Vertices do not have an attribute that the caller requested.
    MissingAttribute(AttributeRequest, Vec<AvailableAttribute>, Option<Box<(FilePosition, String)>>),
}

impl FileError {
    pub(crate) fn line(line: usize, message: impl Into<String>) -> Self {
        FileError::Malformed(FilePosition::Line(line), message.into())
    }

    pub(crate) fn whole(message: impl Into<String>) -> Self {
        FileError::Malformed(FilePosition::Whole, message.into())
    }

    /// Returns an error about a whole file as one about an element of a list of glTF.
    pub(crate) fn in_element(self, list: &'static str, index: usize) -> Self {
        match self {
            FileError::Malformed(FilePosition::Whole, message) => FileError::InElement { list, index, message },
            other => other,
        }
    }

    /// Adds the name of the file.
    pub(crate) fn in_file(self, file: &str) -> Error {
        let file = file.to_owned();
        match self {
            FileError::Malformed(position, message) => Error::Malformed { file, position, message },
            FileError::InElement { message, .. } => Error::Malformed { file, position: FilePosition::Whole, message },
            FileError::TooLarge { what, needed, left, limit } => Error::TooLarge { file, what, needed, left, limit },
            FileError::MissingAttribute(request, available, other) => {
                Error::MissingAttribute { scene: file, request, available, other }
            }
        }
    }
}
