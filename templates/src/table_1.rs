//! Table 1 of the k⁺-buffer paper (Vasilakis, Papaioannou & Fudos 2015), as far as the available copy is legible: the
//! paper's properties of each technique, for comparison with those of the plans.

/// One row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaperRow {
    /// The key of the technique.
    pub key: &'static str,
    /// The paper's name for it.
    pub name: &'static str,
    /// The number of geometry passes.
    pub geometry_passes: &'static str,
    /// Whether primitives should be sorted.
    pub sorted_primitives: &'static str,
    /// When fragments are sorted: `store` or `resolve`.
    pub sorted_fragments: &'static str,
    /// The greatest k, without and with attributes packed; `?`: illegible.
    pub most: &'static str,
    /// Possible artefacts of the image.
    pub artifacts: &'static str,
    /// Words per pixel, without and with attributes packed.
    pub words: &'static str,
}

const fn row(key: &'static str, name: &'static str, cells: [&'static str; 6]) -> PaperRow {
    let [geometry_passes, sorted_primitives, sorted_fragments, most, artifacts, words] = cells;
    PaperRow { key, name, geometry_passes, sorted_primitives, sorted_fragments, most, artifacts, words }
}

/// The rows, in the paper's order.
pub const TABLE_1: [PaperRow; 14] = [
    row("kb", "KB", ["1", "yes", "store", "?", "hazards, geometry interpenetration", "2k; 4k"]),
    row("kb_multi", "KB-Multi", ["1 to k", "yes", "resolve", "?", "geometry interpenetration", "2k; 4k"]),
    row("kb_sr", "KB-SR", ["1", "yes", "resolve", "?", "geometry interpenetration", "3k"]),
    row("kb_ps", "KB-PS", ["1", "no", "store", "–", "?", "2k"]),
    row("kplus_array", "K⁺B-Array", ["1", "no", "resolve", "–", "", "2k+2"]),
    row("kplus_heap", "K⁺B-Heap", ["1", "no", "resolve", "–", "", "2k+2"]),
    row("kb_mdt32", "KB-MDT₃₂", ["2", "no", "store", "–", "", "2k"]),
    row("kb_mdt64", "KB-MDT₆₄", ["1", "no", "store", "–", "", "2k"]),
    row("kb_mha", "KB-MHA", ["1", "yes", "store", "8; 16", "?", "2k; 4k"]),
    row("kb_ab_array", "KB-AB_Array", ["1", "no", "resolve", "–", "memory overflow", "2n+1"]),
    row("kb_ab_ll", "KB-AB_LL", ["1", "no", "resolve", "–", "memory overflow", "3f+1"]),
    row("kb_ll", "KB-LL", ["1", "no", "store", "–", "memory overflow", "3f+6"]),
    row("kb_ab_sb", "KB-AB_SB", ["2", "no", "resolve", "–", "", "2f+2"]),
    row("kplus_ab_sb", "K⁺B-AB_SB", ["2", "no", "resolve", "–", "", "2f_k+3"]),
];
