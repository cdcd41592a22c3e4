//! What can go wrong between a plan and its pixels, as values: each says what is wrong and what the way out is.

use std::fmt;

use fragbuf_templates::vocabulary::FormulaError;

/// Why the runtime cannot go on. Whatever failed has changed nothing: buffers, sizes and k are as before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The plan has a step or a resource that this runtime does not run.
    Unsupported {
        /// The step or resource.
        what: String,
        /// The way out.
        hint: String,
    },
    /// A formula has no value.
    Formula {
        /// Whose formula.
        what: String,
        /// Why.
        error: FormulaError,
    },
    /// A size is beyond a limit of the device.
    TooLarge {
        /// The resource, or the dimension of the frame.
        what: String,
        /// What is needed, in the limit's unit.
        needed: u64,
        /// What the device allows.
        limit: u64,
        /// wgpu's name for the limit.
        limit_name: &'static str,
        /// The way out.
        hint: &'static str,
    },
    /// The device lacks features that the shaders need.
    MissingFeatures(wgpu::Features),
    /// There is not enough memory.
    OutOfMemory {
        /// What was being made.
        what: String,
        /// Its size in bytes, as far as it is known.
        bytes: u64,
    },
    /// wgpu refused something: the caller's settings and the plan do not fit, or the fault is ours.
    Validation {
        /// What was being made.
        what: String,
        /// wgpu's words.
        message: String,
    },
    /// The driver failed.
    Internal {
        /// What was being made.
        what: String,
        /// wgpu's words.
        message: String,
    },
    /// What was to be read back never came: the device was lost, or its buffer destroyed.
    Lost,
    /// Nothing that was recorded was submitted, so that there is nothing to wait for.
    NotSubmitted,
    /// The frame began before another frame, a new size or a new k took its place.
    StaleFrame,
    /// A value that the plan does not take.
    BadValue {
        /// The value's name.
        name: String,
        /// What it must be.
        wanted: String,
    },
    /// The shaders have no entry point where the plan needs one.
    MissingCode {
        /// The pass.
        pass: String,
        /// The stage.
        stage: &'static str,
    },
    /// No adapter of that name, or none at all.
    NoAdapter {
        /// What was asked for.
        wanted: String,
        /// What there is.
        found: Vec<String>,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Unsupported { what, hint } => write!(f, "the runtime does not run {what}: {hint}"),
            Error::Formula { what, error } => write!(f, "the size of {what} has no value: {error}"),
            Error::TooLarge { what, needed, limit, limit_name, hint } => {
                write!(f, "{what} needs {needed}, and the device allows {limit} ({limit_name}): {hint}")
            }
            Error::MissingFeatures(features) => {
                write!(f, "the device lacks {features:?}: request them, or take shaders of the target `wgsl`")
            }
            Error::OutOfMemory { what, bytes } => {
                write!(f, "out of memory at {what} ({bytes} bytes): take a smaller frame, or keep less")
            }
            Error::Validation { what, message } => write!(f, "wgpu refuses {what}: {message}"),
            Error::Internal { what, message } => write!(f, "the driver failed at {what}: {message}"),
            Error::Lost => f.write_str("a readback never came: the device is lost; make a new one and a new renderer"),
            Error::NotSubmitted => f.write_str("nothing to wait for: submit what was recorded first"),
            Error::StaleFrame => f.write_str("this frame is over: another frame, a new size or a new k took its place"),
            Error::BadValue { name, wanted } => write!(f, "{name} must be {wanted}"),
            Error::MissingCode { pass, stage } => {
                write!(f, "the shaders have no {stage} entry point for pass `{pass}`")
            }
            Error::NoAdapter { wanted, found } if found.is_empty() => {
                write!(
                    f,
                    "no adapter at all (wanted: {wanted}): install a driver; mesa-vulkan-drivers has one for the CPU"
                )
            }
            Error::NoAdapter { wanted, found } => {
                write!(f, "no adapter is {wanted}; there are: {}", found.join(", "))
            }
        }
    }
}

impl std::error::Error for Error {}

impl From<fragbuf_frame::Error> for Error {
    fn from(error: fragbuf_frame::Error) -> Self {
        match error {
            fragbuf_frame::Error::Unsupported { what, hint } => Error::Unsupported { what, hint },
            fragbuf_frame::Error::Formula { what, error } => Error::Formula { what, error },
            fragbuf_frame::Error::TooLarge { what, needed, limit, limit_name, hint } => {
                Error::TooLarge { what, needed, limit, limit_name, hint }
            }
            fragbuf_frame::Error::BadValue { name, wanted } => Error::BadValue { name, wanted },
        }
    }
}
