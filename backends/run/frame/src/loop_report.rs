//! Reports on the loops of a frame whose iteration count is determined while the frame runs.

/// A loop with an end condition, over a whole frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopReport {
    /// The end condition: "`left` is zero".
    pub until: String,
    /// The number of iterations.
    pub iterations: u32,
    /// How the loop ended.
    pub end: LoopEnd,
}

/// How a loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopEnd {
    /// The end condition was met.
    ConditionMet,
    /// The iteration limit was reached first: the work is incomplete.
    LimitReached,
}

impl LoopReport {
    /// Adds this report to `loops`. A loop inside another loop, or of several slices, has one report. It says `LimitReached` if
    /// the loop ever reached its limit.
    pub fn merge_into(self, loops: &mut Vec<LoopReport>) {
        match loops.iter_mut().find(|known| known.until == self.until) {
            Some(known) => {
                known.iterations += self.iterations;
                known.end = if self.end == LoopEnd::LimitReached { LoopEnd::LimitReached } else { known.end };
            }
            None => loops.push(self),
        }
    }
}
