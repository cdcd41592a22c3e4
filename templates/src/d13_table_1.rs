//! Table 1 of the paper on depth fighting (Vasilakis & Fudos 2013, D13), as far as the available copy is legible: a
//! merged cell counts for each of its rows.
//!
//! In the notation of the plans: f is the number of fragments of a pixel, in the paper C(Z_all); k the paper's K. Where
//! an iteration stores the fragments of one depth, f (of lists) and n (slots per pixel) are those of that depth, in the
//! paper C(Z) and K. BUN has K = 4 buckets, and k of BAD is the paper's 4K. D is the number of depths, c that of the
//! fragments of each.

use crate::paper_table::{Column, PaperRow, PaperTable, Property};

/// The table.
pub const D13_TABLE_1: PaperTable = PaperTable { columns: &COLUMNS, rows: &ROWS };

const fn column(heading: &'static str, property: Property) -> Column {
    Column { heading, property }
}

const COLUMNS: [Column; 8] = [
    column("fragments per iteration", Property::FragmentsPerIteration),
    column("passes per iteration", Property::PassesPerIteration),
    column("total passes", Property::TotalPasses),
    column("words per pixel", Property::Words),
    column("handles coplanar", Property::KeepsEqualDepths),
    column("R_h", Property::HitRatio),
    column("sort primitives", Property::PrimitivesByDepth),
    column("sort fragments", Property::ResolveSorts),
];

type Reason = (Property, &'static str);

const LAST_EMPTY: Reason = (Property::TotalPasses, "the loop ends with an iteration that keeps nothing");
const COLOUR: Reason = (Property::Words, "the colour so far, which the paper has in the target, is four floats");
const STORED_KEYS: Reason = (
    Property::Words,
    "the storage also has the key of each fragment, and the colour so far, which the paper has in the target, is four floats",
);
const BY_IDS: Reason = (
    Property::Words,
    "the window of ids and what is found are words of their own, and the colour so far is four floats for each end",
);
const NEXT_WHILE_STORING: Reason = (
    Property::PassesPerIteration,
    "the pass that stores a layer finds the next one, and one pass before the loop the first",
);
const NEXT_TOTAL: Reason = (Property::TotalPasses, "the pass that stores a layer finds the next one");
const UNEQUAL_IDS: Reason = (
    Property::KeepsEqualDepths,
    "ids must differ where depths are equal: of equal ids one is kept, and the others are counted",
);
const WHOLE_DEPTHS: Reason = (
    Property::TotalPasses,
    "an iteration takes ids of one depth, so an odd id costs a whole iteration; a first pass finds the nearest depth",
);
const WHOLE_DEPTHS_TESTED: Reason = (
    Property::TotalPasses,
    "an iteration takes ids of one depth, so an odd id costs a whole iteration; the last one finds nothing",
);
const TIES_SORTED: Reason = (
    Property::ResolveSorts,
    "fragments of one depth are sorted by their words, so that the image does not depend on their arrival",
);
const GROWS: Reason =
    (Property::HitRatio, "slots grow to the greatest number of fragments of one depth, and the frame is drawn again");
const POOL_GROWS: Reason =
    (Property::HitRatio, "memory grows to the fragments of the frame, and the frame is drawn again");
const COUNTED_IMAGE: Reason = (Property::Words, "K15's Table 1 has the words of the plan for this buffer");
const ONE_FRAME: Reason = (
    Property::TotalPasses,
    "a frame keeps k fragments and draws once; `k_peeling` repeats k-buffers that keep their k best",
);

const fn row(
    (key, name): (&'static str, &'static str),
    cells: &'static [&'static str],
    iterations: &'static str,
    reasons: &'static [Reason],
) -> PaperRow {
    PaperRow { key, name, cells, iterations, reasons }
}

const BY_LAYERS: &[Reason] = &[NEXT_WHILE_STORING, NEXT_TOTAL, STORED_KEYS, TIES_SORTED];
const BY_BUFFERS: &[Reason] = &[NEXT_WHILE_STORING, NEXT_TOTAL, STORED_KEYS, GROWS, TIES_SORTED];

const ROWS: [PaperRow; 21] = [
    row(("f2b", "F2B"), &["1", "1", "D", "3", "no", "D / f", "no", "no"], "D + 1", &[LAST_EMPTY, COLOUR]),
    row(("f2b2", "F2B2"), &["1", "2", "2 * D", "3", "no", "D / f", "no", "no"], "D + 1", &[LAST_EMPTY, COLOUR]),
    row(
        ("f2b_2p", "F2B-2P"),
        &["2", "2", "f", "12; 10", "yes", "1", "no", "no"],
        "D * ceil_div(c, 2)",
        &[WHOLE_DEPTHS, BY_IDS, UNEQUAL_IDS],
    ),
    row(
        ("f2b_3p", "F2B-3P"),
        &["2", "3", "ceil_div(3 * f, 2)", "12; 10", "yes", "1", "no", "no"],
        "D * ceil_div(c, 2) + 1",
        &[WHOLE_DEPTHS_TESTED, BY_IDS, UNEQUAL_IDS],
    ),
    row(("f2b_ll", "F2B-LL"), &["f", "2", "2 * D", "2f+4", "yes", "1", "no", "no"], "D", BY_LAYERS),
    row(
        ("f2b_kb", "F2B-KB"),
        &["n; 4n", "2", "2 * D", "n+3; 4n+3", "yes", "Σ n/c; Σ 4n/c", "no", "no"],
        "D",
        BY_BUFFERS,
    ),
    row(
        ("f2b_fab", "F2B-FAB"),
        &["n; 4n", "2", "2 * D", "n+4; 4n+4", "yes", "Σ n/c; Σ 4n/c", "no", "no"],
        "D",
        BY_BUFFERS,
    ),
    row(
        ("dual", "DUAL"),
        &["2", "1", "ceil_div(D, 2) + 1", "6", "no", "D / f", "no", "no"],
        "ceil_div(D, 2)",
        &[STORED_KEYS],
    ),
    row(
        ("dual_2p", "DUAL-2P"),
        &["4", "2", "ceil_div(f, 2) + 1", "24; 20", "yes", "1", "no", "no"],
        "ceil_div(D, 2) * ceil_div(c, 2)",
        &[WHOLE_DEPTHS, BY_IDS, UNEQUAL_IDS],
    ),
    row(("dual_ll", "DUAL-LL"), &["f", "2", "D", "2f+6", "yes", "1", "no", "no"], "ceil_div(D, 2)", BY_LAYERS),
    row(
        ("dual_kb", "DUAL-KB"),
        &["n; 4n", "2", "D", "n+4; 4n+4", "yes", "Σ n/c; Σ 4n/c", "no", "no"],
        "ceil_div(D, 2)",
        BY_BUFFERS,
    ),
    row(
        ("dual_fab", "DUAL-FAB"),
        &["n; 4n", "2", "D", "n+6; 4n+6", "yes", "Σ n/c; Σ 4n/c", "no", "no"],
        "ceil_div(D, 2)",
        BY_BUFFERS,
    ),
    row(
        ("kb", "KB"),
        &["k; 2k", "1", "1 to D / k", "2k+2; 4k+2", "no", "k / f to 1", "yes", "yes"],
        "",
        &[
            ONE_FRAME,
            COUNTED_IMAGE,
            (Property::KeepsEqualDepths, "fragments of equal depths are entries of their own; only races lose them"),
            (Property::ResolveSorts, "the store pass inserts in order of depth, as K15 states"),
        ],
    ),
    row(
        ("kb_multi", "MultiKB"),
        &["k; 2k", "?", "1 to k; 1 to 2k", "2k+2; 4k+2", "no", "2k / f to 1", "yes", "yes"],
        "",
        &[
            (
                Property::TotalPasses,
                "rounds until no fragment changes a slot, at most k + 1: a late depth test does not hold stores back",
            ),
            COUNTED_IMAGE,
            (Property::HitRatio, "of fragments with equal depths one is kept, and k fragments in all, without packing"),
        ],
    ),
    row(
        ("kb_sr", "SRAB"),
        &["k", "1", "1 to D / k", "3k+2", "yes", "k / f to 1", "yes", "yes"],
        "",
        &[ONE_FRAME, COUNTED_IMAGE],
    ),
    row(
        ("bun", "BUN"),
        &["8; 16", "1", "ceil_div(D, 8) to ceil_div(D, 2)", "18", "no", "D / f", "no", "no"],
        "ceil_div(d, 2) + 1",
        &[
            (
                Property::TotalPasses,
                "d is the number of depths in the fullest bucket; a pass finds the range, which the paper has from the bounding box",
            ),
            (Property::Words, "as DUAL, for each of four buckets, and the range"),
        ],
    ),
    row(
        ("ab_ll_bun", "BUN-LL"),
        &["f", "1", "1", "3f+8 to 15f+8", "yes", "overflow to 1", "no", "yes"],
        "",
        &[
            (Property::PassesPerIteration, "a pre-pass finds the range, which the paper has from the bounding box"),
            (Property::TotalPasses, "a pre-pass finds the range, which the paper has from the bounding box"),
            (Property::Words, "two words of range and one pool, where the paper has five counters"),
            POOL_GROWS,
        ],
    ),
    row(
        ("bad", "BAD"),
        &["k", "4", "4", "3k/2+3", "no", "k / f", "no", "no"],
        "",
        &[
            (Property::Words, "keys are whole words, and a bit per part orders fragments of equal depth"),
            (Property::HitRatio, "a part of the range keeps one fragment, so at most one of each depth"),
        ],
    ),
    row(
        ("ab_array", "FAB"),
        &["n", "1", "1", "2n+2", "yes", "overflow to 1", "no", "yes"],
        "",
        &[COUNTED_IMAGE, POOL_GROWS],
    ),
    row(
        ("ab_ll", "LL"),
        &["f", "1", "1", "3f+3", "yes", "overflow to 1", "no", "yes"],
        "",
        &[COUNTED_IMAGE, POOL_GROWS],
    ),
    row(
        ("ab_sb", "SB"),
        &["?", "2", "2", "2f+3", "yes", "overflow to 1", "no", "yes"],
        "",
        &[COUNTED_IMAGE, POOL_GROWS],
    ),
];
