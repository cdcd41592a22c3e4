//! The experiments: one file per row. A row names techniques and scenes as data; nothing here is code.

mod b06_fig_3;
mod b06_table_1;
mod b06_table_2;
mod c15_fig_1;
mod d13_fig_10;
mod d13_fig_11;
mod d13_fig_13;
mod d13_fig_4;
mod d13_fig_7;
mod d13_fig_8;
mod d13_fig_9;
mod d13_table_1;
mod growth;
mod k15_fig_1;
mod k15_fig_10;
mod k15_fig_3;
mod k15_fig_4;
mod k15_fig_6;
mod k15_fig_7;
mod k15_fig_8;
mod k15_fig_9_left;
mod k15_fig_9_right;
mod k15_sec_5_1_2;
mod k15_table_1;
mod peers;

use super::experiment::Experiment;

/// All experiments, in the order of `figure --list`.
pub(super) const EXPERIMENTS: [Experiment; 25] = [
    k15_table_1::ROW,
    k15_fig_1::ROW,
    k15_fig_3::ROW,
    k15_fig_4::ROW,
    k15_fig_6::ROW,
    k15_fig_7::ROW,
    k15_fig_8::ROW,
    k15_fig_9_left::ROW,
    k15_fig_9_right::ROW,
    k15_fig_10::ROW,
    k15_sec_5_1_2::ROW,
    c15_fig_1::ROW,
    d13_table_1::ROW,
    d13_fig_4::ROW,
    d13_fig_7::ROW,
    d13_fig_8::ROW,
    d13_fig_9::ROW,
    d13_fig_10::ROW,
    d13_fig_11::ROW,
    d13_fig_13::ROW,
    b06_fig_3::ROW,
    b06_table_1::ROW,
    b06_table_2::ROW,
    growth::ROW,
    peers::ROW,
];
