//! Decisions of host steps that take effect in a later frame, so that no frame waits for them.
//!
//! Input: the values that the host steps of a frame decide from its words. Output: the values of the next frame. A symbol grows at once,
//! because a frame with too small a value loses fragments; it shrinks only after it could have been smaller for some frames in a row, and
//! then to the greatest value that one of them needed. So it does not change from frame to frame where the scene changes back and forth.

use fragbuf_codegen::{Plan, SymbolId};

use crate::{Error, Readbacks, Values, unsupported};

/// When the decisions of host steps take effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decisions {
    /// In the frame that they decide, which waits for the words that they read.
    #[default]
    Immediate,
    /// In the next frame whose words have been read back, for host steps that allow it
    /// ([`Decision::may_lag`](fragbuf_codegen::Decision::may_lag)). The first frame waits, and so does the first one after a change of the
    /// frame's size. Other host steps wait in every frame.
    Lagged {
        /// The frames in a row that must need a smaller value before the value shrinks; 1 at least.
        shrink_after: u32,
    },
}

impl Decisions {
    /// Lagged decisions that shrink after eight frames.
    pub const LAGGED: Decisions = Decisions::Lagged { shrink_after: 8 };
}

/// The values that lagged decisions have set so far, and what they may become.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaggedValues {
    shrink_after: u32,
    symbols: Vec<LaggedSymbol>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct LaggedSymbol {
    id: SymbolId,
    /// The value of the next frame; `None` before the first decision.
    current: Option<u64>,
    /// The greatest value that a slice of the present frame decides; `None` before a slice has decided.
    decided: Option<u64>,
    /// The frames in a row that needed less than `current`, and the greatest value that one of them needed.
    smaller: (u32, u64),
}

impl LaggedValues {
    /// Returns the values before the first frame. With [`Decisions::Immediate`], and for a plan without host steps that may lag, none lag.
    pub fn new(plan: &Plan, decisions: Decisions) -> Self {
        let Decisions::Lagged { shrink_after } = decisions else {
            return LaggedValues { shrink_after: 1, symbols: Vec::new() };
        };
        let mut symbols: Vec<LaggedSymbol> = Vec::new();
        for id in plan.frame.decisions().filter(|decision| decision.may_lag).flat_map(|decision| &decision.sets) {
            if !symbols.iter().any(|symbol| symbol.id == *id) {
                symbols.push(LaggedSymbol { id: *id, current: None, decided: None, smaller: (0, 0) });
            }
        }
        LaggedValues { shrink_after: shrink_after.max(1), symbols }
    }

    /// Returns how the next frame reads words back, if others than lagged host steps do so as `readbacks`.
    pub fn readbacks(&self, readbacks: Readbacks) -> Readbacks {
        let is_decided = !self.symbols.is_empty() && self.symbols.iter().all(|symbol| symbol.current.is_some());
        if is_decided && readbacks == Readbacks::Enabled { Readbacks::Lagged } else { readbacks }
    }

    /// Records the values that host steps have decided in a slice of the present frame.
    pub fn record(&mut self, values: &Values) {
        for symbol in &mut self.symbols {
            symbol.decided = symbol.decided.max(values.get(symbol.id));
        }
    }

    /// Ends the present frame, and sets the values of the next one.
    pub fn advance(&mut self, values: &mut Values) {
        for symbol in &mut self.symbols {
            symbol.advance(self.shrink_after);
            if let Some(value) = symbol.current {
                values.set(symbol.id, value);
            }
        }
    }

    /// Forgets all values: the next frame waits for its decisions.
    pub fn reset(&mut self) {
        for symbol in &mut self.symbols {
            (symbol.current, symbol.decided, symbol.smaller) = (None, None, (0, 0));
        }
    }

    /// Continues with the values of another device that has run the same plan.
    pub fn resume(&mut self, plan: &Plan, others: &LaggedValues, values: &mut Values) -> Result<(), Error> {
        let ids = |lagged: &LaggedValues| lagged.symbols.iter().map(|symbol| symbol.id).collect::<Vec<_>>();
        let fits = |symbol: &LaggedSymbol| {
            let (least, most) = plan.symbols.get(symbol.id).range;
            symbol.current.is_none_or(|value| (least..=most).contains(&value))
        };
        if ids(self) != ids(others) || !others.symbols.iter().all(fits) {
            return Err(unsupported("lagged values of another plan".to_owned()));
        }
        self.symbols.clone_from(&others.symbols);
        for (id, value) in self.symbols.iter().filter_map(|symbol| Some((symbol.id, symbol.current?))) {
            values.set(id, value);
        }
        Ok(())
    }
}

impl LaggedSymbol {
    fn advance(&mut self, shrink_after: u32) {
        let Some(decided) = self.decided.take() else { return };
        let Some(current) = self.current.filter(|current| decided < *current) else {
            (self.current, self.smaller) = (Some(decided), (0, 0));
            return;
        };
        let (frames, greatest) = (self.smaller.0 + 1, self.smaller.1.max(decided));
        (self.current, self.smaller) = match frames >= shrink_after {
            true => (Some(greatest), (0, 0)),
            false => (Some(current), (frames, greatest)),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values_of(shrink_after: u32, decided: &[u64]) -> Vec<u64> {
        let mut symbol = LaggedSymbol { id: SymbolId::K, current: None, decided: None, smaller: (0, 0) };
        let advance = |value: &u64| {
            symbol.decided = Some(*value);
            symbol.advance(shrink_after);
            symbol.current.unwrap_or(0)
        };
        decided.iter().map(advance).collect()
    }

    #[test]
    fn values_grow_at_once_and_shrink_after_some_frames() {
        assert_eq!(values_of(3, &[2, 5, 3, 4, 1, 1, 1]), [2, 5, 5, 5, 4, 4, 4]);
        assert_eq!(values_of(3, &[5, 3, 5, 3, 3, 6, 1, 1, 1, 1, 1]), [5, 5, 5, 5, 5, 6, 6, 6, 1, 1, 1]);
        assert_eq!(values_of(1, &[5, 3, 4, 2]), [5, 3, 4, 2]);
    }
}
