//! An effect that can be interrupted between two fragments of a pixel and continued later, as peeling requires.

use crate::{SourceSpan, UserFunction};

/// The parts of an effect `{ let mut a = …; for f in fragments { … } value }`, lowered to WGSL. They share the variable [`RESUMED`].
#[derive(Clone, Debug)]
pub struct Resumable {
    /// The members of [`RESUMED`] that are kept from one call of `advance` to the next: names and WGSL types, scalars of 32 bits, `bool` or
    /// vectors of `f32`. The first is [`PROGRESS`].
    pub members: Vec<(String, String)>,
    /// What is before the loop: a function without parameters and result.
    pub begin: UserFunction,
    /// The loop, over the fragments that `layer` returns: likewise.
    pub advance: UserFunction,
    /// What is after the loop: returns the premultiplied colour, a `vec4<f32>`.
    pub end: UserFunction,
}

/// Why an effect needs all fragments of a pixel at once.
#[derive(Clone, Debug)]
pub struct Uninterruptible {
    /// What needs them.
    pub span: SourceSpan,
    /// The reason, a clause about the closure and the fragments, "them".
    pub reason: &'static str,
    /// What to change, beginning with a verb.
    pub help: &'static str,
}

/// The WGSL variable with what is kept, a struct.
pub const RESUMED: &str = "resumed";

/// The member with the progress of the effect, one of [`Progress`].
pub const PROGRESS: &str = "progress";

/// The member with the number of fragments of earlier calls of `advance`; only in effects that read indices.
pub const COUNT: &str = "count";

/// The member with the result of an effect that returns in its loop; only in such effects.
pub const RESULT: &str = "result";

/// How far an effect is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Memory is cleared to this value.
    NotBegun = 0,
    /// `advance` may be called.
    InLoop = 1,
    /// The loop has ended by `break`.
    AfterLoop = 2,
    /// The effect has returned [`RESULT`].
    Returned = 3,
}

impl Progress {
    /// Returns the number in WGSL.
    pub fn wgsl(self) -> String {
        format!("{}u", self as u32)
    }
}

impl Resumable {
    /// Returns the parts in the order of their calls.
    pub fn parts(&self) -> [&UserFunction; 3] {
        [&self.begin, &self.advance, &self.end]
    }

    /// Returns the 32-bit words of all members.
    pub fn words(&self) -> u32 {
        self.members.iter().map(|(_, ty)| components(ty)).sum()
    }
}

impl UserFunction {
    /// Returns the parts of an effect that can be interrupted between two fragments.
    pub fn resumable(&self) -> Option<&Resumable> {
        self.resumable.as_ref()?.as_deref().ok()
    }
}

/// Returns the number of components of a member's type.
pub fn components(ty: &str) -> u32 {
    let size = ty.strip_prefix("vec").and_then(|rest| rest.chars().next()).and_then(|digit| digit.to_digit(10));
    size.unwrap_or(1)
}
