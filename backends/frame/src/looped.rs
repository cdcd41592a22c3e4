//! How the loops of a frame ended whose end is found out while it runs.

/// A loop that waits for something, over a whole frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Looped {
    /// What it waits for, as a condition: "`left` is zero".
    pub until: String,
    /// Its rounds.
    pub rounds: u32,
    /// How it ended.
    pub end: LoopEnd,
}

/// How a loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopEnd {
    /// What it waits for came true.
    Reached,
    /// Its bound came first: work was left undone.
    Cut,
}
