//! What can go wrong between a variant and its pixels, as values.

use std::fmt;

use fragbuf_model::{Diagnostics, Refusal};

/// Why there is no picture.
#[derive(Clone, Debug)]
pub enum Error {
    /// Every choice of an axis needs what this device does not have.
    Refused(Refusal),
    /// The variant could not be planned or linked, or naga refused it.
    Diagnostics(Diagnostics),
    /// A size or a value that the plan does not take, or a step that is not run here.
    Frame(fragbuf_frame::Error),
    /// A shader has something that the interpreter does not run.
    Shader {
        /// The pass.
        pass: String,
        /// The construct.
        what: String,
    },
    /// There is not enough memory.
    OutOfMemory {
        /// What was being made.
        what: String,
        /// Its size.
        bytes: u64,
    },
    /// An invocation goes round for ever, or some of a workgroup wait at a barrier that others never reach.
    Stuck {
        /// The pass.
        pass: String,
        /// Which of the two.
        how: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Refused(refusal) => write!(
                f,
                "the CPU device cannot express `{}: {}`: it has no {}; choose another `{}`",
                refusal.axis,
                refusal.value,
                refusal.capability.meaning(),
                refusal.axis
            ),
            Error::Diagnostics(diagnostics) => diagnostics.fmt(f),
            Error::Frame(error) => error.fmt(f),
            Error::Shader { pass, what } => {
                write!(
                    f,
                    "pass `{pass}`: the CPU device does not run {what}: take another device, or another technique"
                )
            }
            Error::OutOfMemory { what, bytes } => {
                write!(f, "out of memory at {what} ({bytes} bytes): take a smaller frame, or keep less")
            }
            Error::Stuck { pass, how } => write!(f, "pass `{pass}` does not end: {how}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<fragbuf_frame::Error> for Error {
    fn from(error: fragbuf_frame::Error) -> Self {
        Error::Frame(error)
    }
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::Diagnostics(diagnostics)
    }
}
