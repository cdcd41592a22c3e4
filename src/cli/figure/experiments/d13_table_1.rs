//! D13, Table 1: properties of peeling and of buffers, with those of the plans.

use fragbuf_templates::D13_TABLE_1;

use crate::cli::figure::experiment::{Experiment, Kind, Properties};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-table-1",
    paper: "D13, Table 1",
    title: "properties of peeling and of buffers",
    kind: Kind::Properties(Properties {
        table: &D13_TABLE_1,
        has_others: false,
        widths: &[140, 130, 340, 190, 110, 200, 100, 100],
        compared: &COMPARED,
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
