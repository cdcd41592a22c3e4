//! How the loops of a frame ended whose end is found out while it runs.

/// A loop that waits for something, over a whole frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Looped {
    /// What it waits for, as a condition: "`left` is zero".
    pub until: String,
    /// Its iterations.
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

impl Looped {
    /// Adds a loop to what is reported: one inside of another, or of several slices, is reported once, cut if it ever was.
    pub fn note(self, loops: &mut Vec<Looped>) {
        match loops.iter_mut().find(|known| known.until == self.until) {
            Some(known) => {
                known.rounds += self.rounds;
                known.end = if self.end == LoopEnd::Cut { LoopEnd::Cut } else { known.end };
            }
            None => loops.push(self),
        }
    }
}
