//! The errors of the CPU device.

use std::fmt;

use fragbuf_model::{Diagnostics, MissingFeature};

/// Why the device cannot render.
#[derive(Clone, Debug)]
pub enum Error {
    /// Every choice of an axis needs a feature that this device lacks.
    MissingFeature(MissingFeature),
    /// The variant cannot be planned or linked, or naga rejects it.
    Diagnostics(Diagnostics),
    /// A size or value that the plan does not accept, or an unsupported step.
    Frame(fragbuf_frame::Error),
    /// A shader uses a construct that the interpreter does not run.
    Shader {
        /// The pass.
        pass: String,
        /// The construct.
        what: String,
    },
    /// There is not enough memory.
    OutOfMemory {
        /// The allocation.
        what: String,
        /// Its size.
        bytes: u64,
    },
    /// An invocation does not terminate, or some of a workgroup wait at a barrier that the others do not reach.
    NotTerminating {
        /// The pass.
        pass: String,
        /// The reason.
        reason: &'static str,
        /// The position of the loop in the description, a user file or a template; `None`: it is not known.
        location: Option<String>,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::MissingFeature(missing) => write!(
                f,
                "the CPU device does not support `{}: {}`: it has no {}; choose another `{}`",
                missing.axis,
                missing.value,
                missing.feature.meaning(),
                missing.axis
            ),
            Error::Diagnostics(diagnostics) => diagnostics.fmt(f),
            Error::Frame(error) => error.fmt(f),
            Error::Shader { pass, what } => {
                write!(f, "pass `{pass}`: the CPU device does not run {what}: use another device or another technique")
            }
            Error::OutOfMemory { what, bytes } => {
                write!(
                    f,
                    "out of memory allocating {what} ({bytes} bytes): use a smaller frame or keep fewer fragments"
                )
            }
            Error::NotTerminating { pass, reason, location } => {
                let location = location.as_ref().map_or(String::new(), |location| format!("{location}: "));
                write!(
                    f,
                    "{location}pass `{pass}` does not terminate: {reason}: give the loop a smaller limit, or use another device"
                )
            }
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
