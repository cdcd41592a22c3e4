//! Summarises a plan, so that plans can be compared: bytes, passes, and the orders that the image depends on.
//!
//! Input: a plan. Output: formulas in the notation of the papers. All results follow from capabilities, the reference model of rows
//! and steps; this file names no technique.

use fragbuf_templates::vocabulary::{Capability, Kind, Polynomial, Side, Soundness, TieBreak};

use super::Plan;
use super::notation::{runs, words_per_pixel};

/// The order of fragments that the image depends on, if the counters report no loss by overflow or time-out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Arrival {
    /// No order: fragments may arrive in any order.
    Any,
    /// The submission order: every frame is the same.
    Submission,
    /// The arrival order of concurrent fragments: frames may differ.
    Race,
}

impl Plan {
    /// Returns the order that the image depends on.
    pub fn arrival(&self) -> Arrival {
        let provides = self.selection.provides();
        let has = |capability| provides.contains(&capability);
        let order = self.selection.rows.iter().find_map(|selected| selected.row.order);
        let is_total = matches!(order, None | Some(TieBreak::Payload | TieBreak::Attribute));
        // Fragments that leave a pixel during the frame are shown in the order in which they leave.
        let keeps_best = self.selection.kept().is_some_and(|kept| kept.side == Side::Best);
        let value_words = self.layout.value_words();
        let shows_kept_only = self.selection.merges().is_none()
            && !self.hazards.iter().any(|hazard| hazard.permits.depends_on_arrival(value_words));
        if keeps_best && shows_kept_only && is_total && self.soundness != Soundness::Racy {
            Arrival::Any
        } else if has(Capability::FixedFunction) || has(Capability::OrderedMutualExclusion) {
            Arrival::Submission
        } else {
            Arrival::Race
        }
    }

    /// Returns the number of draws and dispatches of a frame, as a formula over the limits of loops.
    pub fn pass_count(&self) -> Polynomial {
        runs(&self.frame, &self.passes, &self.symbols, &|_| true)
    }

    /// Returns the number of draws of a frame: of the scene and of full-screen triangles.
    pub fn draw_count(&self) -> Polynomial {
        runs(&self.frame, &self.passes, &self.symbols, &|pass| !matches!(pass.kind, Kind::Compute { .. }))
    }

    /// Returns the bytes per pixel, in the notation of [`Plan::words_per_pixel`].
    pub fn bytes_per_pixel(&self) -> Polynomial {
        words_per_pixel(&self.resources, &self.symbols).times(&Polynomial::number(4))
    }
}
