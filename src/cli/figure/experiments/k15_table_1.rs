//! K15, Table 1: properties of the k-buffer variants, with those of the plans, and the techniques that the table does not have.

use fragbuf_templates::TABLE_1;

use crate::cli::figure::experiment::{Experiment, Kind, Properties};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-table-1",
    paper: "K15, Table 1",
    title: "properties of k-buffer variants",
    kind: Kind::Properties(Properties {
        table: &TABLE_1,
        has_others: true,
        widths: &[110, 110, 110, 90, 480, 110, 50],
        compared: &COMPARED,
        measured: None,
    }),
};

const COMPARED: [(&str, &str); 4] = [
    ("geometry passes", "each technique draws the scene as often as the table states"),
    ("primitives in order", "each needs primitives in order where the table states it"),
    ("fragments sorted", "each sorts fragments in the stage of the table"),
    ("words per pixel", "each needs the words per pixel of the table"),
];
