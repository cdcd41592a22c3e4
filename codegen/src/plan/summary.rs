//! What a plan comes to, for whoever compares plans: bytes, passes, and what a picture depends on.
//!
//! In: a plan. Out: formulas in the papers' notation, and words. Everything follows from facts, the rows' reference model and
//! steps; nothing here names a technique.

use fragbuf_templates::vocabulary::{Fact, Formula, FormulaError, Kind, Order, Pass, Polynomial, Side, Soundness};

use super::{Plan, Planned};
use crate::frame::Lowered;
use crate::{Action, LoweredFrame, PlannedPass, Quantity, SymbolTable};

/// What a picture depends on beside the fragments themselves, as long as the counters say that nothing was lost for want of
/// room or time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Arrival {
    /// On nothing: fragments may come in any order.
    Any,
    /// On the order in which they were submitted: every frame is the same.
    Submission,
    /// On which of several fragments is faster: frames may differ.
    Race,
}

impl Plan {
    /// What a picture depends on.
    pub fn arrival(&self) -> Arrival {
        let offers = self.selection.offers();
        let has = |fact| offers.contains(&fact);
        let order = self.selection.rows.iter().find_map(|selected| selected.row.order);
        let decides = matches!(order, None | Some(Order::Payload | Order::Attribute));
        // What leaves a pixel meanwhile is shown in the order in which it leaves.
        let is_promised = self.selection.kept().is_some_and(|kept| kept.side == Side::Best);
        let is_kept = !self.hazards.iter().any(|hazard| hazard.permits.shows()) && self.selection.merges().is_none();
        if is_promised && is_kept && decides && self.soundness != Soundness::Racy {
            Arrival::Any
        } else if has(Fact::FixedFunction) || has(Fact::OrderedCritical) {
            Arrival::Submission
        } else {
            Arrival::Race
        }
    }

    /// Draws and dispatches of a frame, as a formula over the bounds of loops.
    pub fn pass_count(&self) -> Polynomial {
        runs(&self.frame, &self.passes, &self.symbols, &|_| true)
    }

    /// Draws of a frame: the scene's, and triangles over the whole frame.
    pub fn draw_count(&self) -> Polynomial {
        runs(&self.frame, &self.passes, &self.symbols, &|pass| !matches!(pass.kind, Kind::Compute { .. }))
    }

    /// Bytes per pixel, in the notation of [`Plan::words_per_pixel`].
    pub fn bytes_per_pixel(&self) -> Polynomial {
        words_per_pixel(&self.resources, &self.symbols).times(&Polynomial::number(4))
    }
}

/// What grows with the pixels, per pixel: pools grow with the fragments of all pixels, so they count f words per word of a
/// node, and f/4 per word of a page of four. Sizes that grow with neither, or with a fraction of the pixels, are left to the
/// list of resources, and so is what the caller brings.
pub(super) fn words_per_pixel(resources: &[Planned], symbols: &SymbolTable) -> Polynomial {
    let own = resources.iter().filter(|planned| !planned.is_brought());
    let total = own.fold(Polynomial::default(), |total, planned| total.plus(&polynomial(&planned.words, symbols), 1));
    total
        .coefficient("pixels")
        .plus(&total.coefficient("fragments").times(&Polynomial::symbol("f")), 1)
        .plus(&total.coefficient("kept").times(&Polynomial::symbol("f_k")), 1)
        .plus(&total.fractions("fragments", "f"), 1)
}

/// Runs of the passes that are `meant`, as a formula over the bounds of loops.
pub(super) fn passes(lowered: &Lowered, symbols: &SymbolTable, meant: &dyn Fn(&Pass) -> bool) -> Polynomial {
    runs(&lowered.frame, &lowered.passes, symbols, meant)
}

fn runs(
    frame: &LoweredFrame,
    passes: &[PlannedPass],
    symbols: &SymbolTable,
    meant: &dyn Fn(&Pass) -> bool,
) -> Polynomial {
    let mut sum = Polynomial::default();
    // The product of the bounds of all loops around a command.
    let mut times = vec![Polynomial::number(1)];
    for command in &frame.commands {
        let now = times.last().cloned().unwrap_or_default();
        match command.action {
            Action::Pass(id) if meant(&passes[id.0]) => sum = sum.plus(&now, 1),
            Action::Loop(id) => times.push(now.times(&polynomial(&frame.loops[id.0].at_most, symbols))),
            Action::LoopEnd(_) => drop(times.pop()),
            _ => {}
        }
    }
    sum
}

/// A formula in normal form. What has none has been refused when the plan was made.
fn polynomial(quantity: &Quantity, symbols: &SymbolTable) -> Polynomial {
    normal_form(quantity.formula(), symbols).unwrap_or_default()
}

/// A formula as a sum of products of symbols.
pub(super) fn normal_form(formula: &Formula, symbols: &SymbolTable) -> Result<Polynomial, FormulaError> {
    formula.read()?.polynomial(&|name| symbols.number_of(name))
}
