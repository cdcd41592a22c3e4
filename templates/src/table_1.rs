//! Table 1 of the k⁺-buffer paper (Vasilakis, Papaioannou & Fudos 2015), as far as the available copy is legible: the
//! paper's properties of each technique, for comparison with those of the plans.

use crate::paper_table::{Column, PaperRow, PaperTable, Property};

/// The table. The column `fixed` has no legible value.
pub const TABLE_1: PaperTable = PaperTable { columns: &COLUMNS, rows: &ROWS };

const fn column(heading: &'static str, property: Property) -> Column {
    Column { heading, property }
}

const COLUMNS: [Column; 7] = [
    column("geometry passes", Property::GeometryPasses),
    column("primitives in order", Property::PrimitivesInOrder),
    column("fragments sorted", Property::FragmentsSorted),
    column("k up to", Property::MostK),
    column("artifacts", Property::Artifacts),
    column("words per pixel", Property::Words),
    column("fixed", Property::FixedMemory),
];

const fn row(key: &'static str, name: &'static str, cells: &'static [&'static str]) -> PaperRow {
    PaperRow { key, name, cells, iterations: "", reasons: &[] }
}

const ROWS: [PaperRow; 14] = [
    row("kb", "KB", &["1", "yes", "store", "?", "hazards, geometry interpenetration", "2k; 4k"]),
    row("kb_multi", "KB-Multi", &["1 to k", "yes", "resolve", "?", "geometry interpenetration", "2k; 4k"]),
    row("kb_sr", "KB-SR", &["1", "yes", "resolve", "?", "geometry interpenetration", "3k"]),
    row("kb_ps", "KB-PS", &["1", "no", "store", "–", "?", "2k"]),
    row("kplus_array", "K⁺B-Array", &["1", "no", "resolve", "–", "", "2k+2"]),
    row("kplus_heap", "K⁺B-Heap", &["1", "no", "resolve", "–", "", "2k+2"]),
    row("kb_mdt32", "KB-MDT₃₂", &["2", "no", "store", "–", "", "2k"]),
    row("kb_mdt64", "KB-MDT₆₄", &["1", "no", "store", "–", "", "2k"]),
    row("kb_mha", "KB-MHA", &["1", "yes", "store", "8; 16", "?", "2k; 4k"]),
    row("kb_ab_array", "KB-AB_Array", &["1", "no", "resolve", "–", "memory overflow", "2n+1"]),
    row("kb_ab_ll", "KB-AB_LL", &["1", "no", "resolve", "–", "memory overflow", "3f+1"]),
    row("kb_ll", "KB-LL", &["1", "no", "store", "–", "memory overflow", "3f+6"]),
    row("kb_ab_sb", "KB-AB_SB", &["2", "no", "resolve", "–", "", "2f+2"]),
    row("kplus_ab_sb", "K⁺B-AB_SB", &["2", "no", "resolve", "–", "", "2f_k+3"]),
];
