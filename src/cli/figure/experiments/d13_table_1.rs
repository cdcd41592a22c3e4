//! D13, Table 1: properties of peeling and of buffers, with those of the plans, and the draws and hit ratios of small
//! frames: in the paper's Fig. 8 the number of fragments of a depth varies, here it is 1, 2, 5 and 9.

use fragbuf_templates::D13_TABLE_1;

use crate::cli::figure::experiment::{Experiment, Kind, MeasuredScenes, Properties};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-table-1",
    paper: "D13, Table 1",
    title: "properties of peeling and of buffers",
    kind: Kind::Properties(Properties {
        table: &D13_TABLE_1,
        has_others: false,
        widths: &[140, 130, 380, 190, 110, 210, 100, 100],
        compared: &COMPARED,
        measured: Some(MeasuredScenes { depths: 9, coplanar: &[1, 2, 5, 9], camera: "clip", side: 8 }),
    }),
};

const COMPARED: [(&str, &str); 8] = [
    ("fragments per iteration", "an iteration stores as many fragments of a pixel as the table states"),
    ("passes per iteration", "an iteration draws the scene as often as the table states"),
    ("total passes", "a frame draws it as often as the table states"),
    ("words per pixel", "each technique needs the words per pixel of the table"),
    ("handles coplanar", "each keeps fragments of equal depths where the table states it"),
    ("R_h", "each has the hit ratio of the table"),
    ("sort primitives", "each needs primitives in order of depth where the table states it"),
    ("sort fragments", "each sorts fragments where the table states it"),
];
