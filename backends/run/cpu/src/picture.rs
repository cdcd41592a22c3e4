//! The result of a frame, and its progress.

use fragbuf_frame::{Counters, LoopReport, PassTime};

/// The progress of a frame.
#[derive(Clone, Copy, Debug)]
pub struct PassProgress<'a> {
    /// The current pass.
    pub pass: &'a str,
    /// The finished share of the pass, from 0 to 1.
    pub share: f64,
}

/// A rendered frame.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Premultiplied red, green, blue and alpha, row after row from the top.
    pub pixels: Vec<[f32; 4]>,
    /// The time of each pass, in the order of the plan.
    pub times: Vec<PassTime>,
    /// The counters, summed over all slices; `None` if the plan has none.
    pub counters: Option<Counters>,
    /// The counters of each slice. Empty if the plan has none.
    pub slice_counters: Vec<Counters>,
    /// The passes that accessed memory out of bounds: they read 0 there and wrote nothing.
    pub out_of_bounds: Vec<String>,
    /// The samples that passed all tests in the last run of each pass, in the order of the plan, summed over all slices; 0 for a
    /// pass that draws nothing.
    pub samples: Vec<u64>,
    /// The loops with a condition, in the order of the plan.
    pub loops: Vec<LoopReport>,
}
