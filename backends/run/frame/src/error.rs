//! Errors in the numbers of a plan's frame. Each message says what is wrong and how to fix it.

use std::fmt;

use fragbuf_templates::vocabulary::FormulaError;

/// Why a number of a frame cannot be computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The plan has a step or a resource that fragbuf's devices do not run.
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
    /// A number exceeds a limit.
    TooLarge {
        /// The resource, or the dimension of the frame.
        what: String,
        /// The required amount, in the limit's unit.
        needed: u64,
        /// The limit.
        limit: u64,
        /// The limit's name.
        limit_name: &'static str,
        /// The suggested fix.
        help: &'static str,
        /// Whether lower slices may need less.
        shrinks_with_rows: bool,
    },
    /// A frame needs more memory than the budget.
    OverBudget(MemoryNeed),
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
            Error::BadValue { name, expected } => write!(f, "{name} must be {expected}"),
            Error::Host { function, message } => write!(f, "the host function `{function}`: {message}"),
        }
    }
}

impl std::error::Error for Error {}

/// The memory that a frame needs in slices of some height, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryNeed {
    /// The width and the height of the frame.
    pub size: (u32, u32),
    /// The rows of a slice.
    pub rows: u32,
    /// The image.
    pub image: u64,
    /// The plan's textures, which have the size of the frame.
    pub textures: u64,
    /// The plan's buffers, which have the size of a slice, and all else that a slice needs.
    pub buffers: u64,
    /// The budget, which is less than the sum.
    pub budget: u64,
}

impl MemoryNeed {
    /// Returns the sum.
    pub fn total(&self) -> u64 {
        self.image.saturating_add(self.textures).saturating_add(self.buffers)
    }
}

impl fmt::Display for MemoryNeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let MemoryNeed { size: (width, height), rows, image, textures, buffers, budget } = self;
        write!(
            f,
            "a frame of {width} x {height} pixels in slices of {width} x {rows} pixels needs {} bytes (image {image}, textures {textures}, \
             buffers of a slice {buffers}), and the memory budget for it is {budget} bytes: use a smaller frame, keep fewer fragments, or \
             raise the budget (`--memory`, `Settings::memory`)",
            self.total()
        )
    }
}
