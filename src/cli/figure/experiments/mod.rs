//! The experiments: one file per row. A row names techniques and scenes as data; nothing here is code.

mod c15_fig_1;
mod growth;
mod k15_fig_6;
mod k15_fig_7;
mod k15_fig_9_left;

use super::experiment::Experiment;

/// All experiments, in the order of `figure --list`.
pub(super) const EXPERIMENTS: [Experiment; 5] =
    [k15_fig_6::ROW, k15_fig_7::ROW, k15_fig_9_left::ROW, c15_fig_1::ROW, growth::ROW];
