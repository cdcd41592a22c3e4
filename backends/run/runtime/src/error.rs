//! Errors of the runtime. Each message says what is wrong and how to fix it.

use std::fmt;

use fragbuf_frame::MemoryNeed;
use fragbuf_templates::vocabulary::FormulaError;

/// Why a call failed. A failed call changes nothing: buffers, sizes and k stay as before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The plan has a step or a resource that the runtime does not support.
    Unsupported {
        /// The step or resource.
        what: String,
        /// The suggested fix.
        help: String,
    },
    /// A formula has no value.
    Formula {
        /// The resource or setting that the formula computes.
        what: String,
        /// The reason.
        error: FormulaError,
    },
    /// A size exceeds a limit of the device.
    TooLarge {
        /// The resource, or the dimension of the frame.
        what: String,
        /// The required amount, in the limit's unit.
        needed: u64,
        /// The device's limit.
        limit: u64,
        /// wgpu's name for the limit.
        limit_name: &'static str,
        /// The suggested fix.
        help: &'static str,
        /// Whether lower slices may need less.
        shrinks_with_rows: bool,
    },
    /// A frame needs more memory than the budget of the settings.
    OverBudget(MemoryNeed),
    /// The device lacks features that the shaders need.
    MissingFeatures(wgpu::Features),
    /// There is not enough memory.
    OutOfMemory {
        /// The object.
        what: String,
        /// Its size in bytes, as far as it is known.
        bytes: u64,
    },
    /// wgpu rejected a call: the caller's settings do not fit the plan, or fragbuf has a defect.
    Validation {
        /// The object, or the commands.
        what: String,
        /// wgpu's message.
        message: String,
    },
    /// The driver failed.
    Internal {
        /// The object, or the commands.
        what: String,
        /// wgpu's message.
        message: String,
    },
    /// A readback did not complete: the device was lost, or its buffer was destroyed.
    DeviceLost,
    /// The recorded commands were not submitted, so there is nothing to wait for.
    NotSubmitted,
    /// A later frame, a resize or a new k has replaced the frame.
    StaleFrame,
    /// A value that the plan does not accept.
    BadValue {
        /// The value's name.
        name: String,
        /// The accepted values.
        expected: String,
    },
    /// A host function cannot decide.
    Host {
        /// The function.
        function: String,
        /// The reason, and how to fix it.
        message: String,
    },
    /// The shaders lack an entry point that the plan needs.
    MissingCode {
        /// The pass.
        pass: String,
        /// The stage.
        stage: &'static str,
    },
    /// No adapter matches, or there is none.
    NoAdapter {
        /// The requested adapter.
        requested: String,
        /// The names of the available adapters.
        available: Vec<String>,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Unsupported { what, help } => write!(f, "the runtime does not support {what}: {help}"),
            Error::Formula { what, error } => write!(f, "the size of {what} has no value: {error}"),
            Error::TooLarge { what, needed, limit, limit_name, help, .. } => {
                write!(f, "{what} needs {needed}, and the device allows {limit} ({limit_name}): {help}")
            }
            Error::OverBudget(need) => need.fmt(f),
            Error::MissingFeatures(features) => {
                write!(f, "the device lacks {features:?}: request them, or use shaders of the target `wgsl`")
            }
            Error::OutOfMemory { what, bytes } => {
                write!(f, "out of memory allocating {what} ({bytes} bytes): use a smaller frame or keep fewer fragments")
            }
            Error::Validation { what, message } => write!(f, "wgpu rejects {what}: {message}"),
            Error::Internal { what, message } => write!(f, "driver error in {what}: {message}"),
            Error::DeviceLost => f.write_str(
                "a readback did not complete: the device is lost or the buffer was destroyed; create a new device and renderer",
            ),
            Error::NotSubmitted => f.write_str("nothing to wait for: submit the recorded commands first"),
            Error::StaleFrame => f.write_str("stale frame: a later frame, a resize or a new k replaced it"),
            Error::BadValue { name, expected } => write!(f, "{name} must be {expected}"),
            Error::Host { function, message } => write!(f, "the host function `{function}`: {message}"),
            Error::MissingCode { pass, stage } => {
                write!(f, "the shaders have no {stage} entry point for pass `{pass}`")
            }
            Error::NoAdapter { requested, available } if available.is_empty() => {
                write!(
                    f,
                    "no adapter found (requested: {requested}): install a driver; mesa-vulkan-drivers has one for the CPU"
                )
            }
            Error::NoAdapter { requested, available } => {
                write!(f, "no adapter is {requested}; available: {}", available.join(", "))
            }
        }
    }
}

impl std::error::Error for Error {}

impl From<fragbuf_frame::Error> for Error {
    fn from(error: fragbuf_frame::Error) -> Self {
        match error {
            fragbuf_frame::Error::Unsupported { what, help } => Error::Unsupported { what, help },
            fragbuf_frame::Error::Formula { what, error } => Error::Formula { what, error },
            fragbuf_frame::Error::TooLarge { what, needed, limit, limit_name, help, shrinks_with_rows } => {
                Error::TooLarge { what, needed, limit, limit_name, help, shrinks_with_rows }
            }
            fragbuf_frame::Error::OverBudget(need) => Error::OverBudget(need),
            fragbuf_frame::Error::BadValue { name, expected } => Error::BadValue { name, expected },
            fragbuf_frame::Error::Host { function, message } => Error::Host { function, message },
        }
    }
}
