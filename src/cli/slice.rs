//! The rows of a picture that were drawn at once, and their figures.

use fragbuf_runtime::{Counters, Error, PassTime};

use super::output::Failure;

/// Rows of a picture, from the top, or all of them.
pub(crate) struct Slice {
    /// Premultiplied linear colours.
    pub(crate) pixels: Vec<[f32; 4]>,
    pub(crate) counters: Option<Counters>,
    pub(crate) times: Option<Vec<PassTime>>,
    /// Bytes held at one time.
    pub(crate) bytes: u64,
    /// Fragments that room was reserved for, where it had to be.
    pub(crate) room: Option<u32>,
}

impl Slice {
    /// This slice with the one below it. Times and counts add up, bytes do not: one slice is drawn after the other.
    pub(crate) fn with(mut self, below: Slice) -> Self {
        self.pixels.extend(below.pixels);
        for (counter, more) in
            self.counters.iter_mut().flat_map(|all| &mut all.0).zip(below.counters.iter().flat_map(|all| &all.0))
        {
            counter.count = counter.count.saturating_add(more.count);
        }
        for (time, more) in self.times.iter_mut().flatten().zip(below.times.iter().flatten()) {
            time.milliseconds += more.milliseconds;
        }
        Slice { bytes: self.bytes.max(below.bytes), room: None, ..self }
    }
}

/// Why there is no slice.
pub(crate) enum SliceFailure {
    /// A smaller one may do.
    TooLarge(Failure),
    Other(Failure),
}

impl From<Error> for SliceFailure {
    fn from(error: Error) -> Self {
        match error {
            Error::TooLarge { .. } | Error::OutOfMemory { .. } => SliceFailure::TooLarge(error.into()),
            other => SliceFailure::Other(other.into()),
        }
    }
}
