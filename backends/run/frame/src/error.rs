//! What can be wrong with a plan's numbers, as values: each says what is wrong and what the way out is.

use std::fmt;

use fragbuf_templates::vocabulary::FormulaError;

/// Why a frame has no numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The plan has a step or a resource that is not run here.
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
    /// A number is beyond a limit.
    TooLarge {
        /// The resource, or the dimension of the frame.
        what: String,
        /// What is needed, in the limit's unit.
        needed: u64,
        /// What there may be.
        limit: u64,
        /// The limit's name.
        limit_name: &'static str,
        /// The way out.
        hint: &'static str,
    },
    /// A value that the plan does not take.
    BadValue {
        /// The value's name.
        name: String,
        /// What it must be.
        wanted: String,
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
            Error::BadValue { name, wanted } => write!(f, "{name} must be {wanted}"),
        }
    }
}

impl std::error::Error for Error {}
