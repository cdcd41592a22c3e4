//! K15, Table 1: properties of the k-buffer variants, with those of the plans, and the techniques that the table does not have.

use fragbuf_templates::TABLE_1;

use crate::cli::figure::experiment::{Experiment, Kind, Properties};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-table-1",
    paper: "K15, Table 1",
    title: "properties of k-buffer variants",
    kind: Kind::Properties(Properties { rows: &TABLE_1, compared: &COMPARED }),
};

const COMPARED: [(&str, &str); 4] = [
    ("geometry passes", "the techniques draw the scene as often"),
    ("primitives in order", "the same techniques need primitives in order"),
    ("fragments sorted", "they sort fragments in the same stage"),
    ("words per pixel", "they need as many words per pixel"),
];
