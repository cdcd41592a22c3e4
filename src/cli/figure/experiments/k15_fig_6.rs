//! K15, Fig. 6: time per pass of k-buffer variants for k = 4 … 64, on pixels of 128 fragments in random order.
//!
//! The paper measures 1024² pixels on a GTX 480 to 970; its scene has n random fragments in every pixel.

use crate::cli::figure::claim::{Change, Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-6",
    paper: "K15, Fig. 6",
    title: "time per pass of k-buffer variants, n = 128",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "n128",
    scene: ["builtin:layers,n=128", "builtin:layers,n=12"],
    camera: "clip",
    axis: Axis { symbol: "k", label: "k", values: &[4, 8, 16, 32, 64], quick: &[4, 8] },
    side: Side::Fixed(128),
    series: &SERIES,
};

const SERIES: [Series; 10] = [
    Series::new("K⁺B-Array", "kplus_array", &HYBRID),
    Series::new("K⁺B-Heap", "kplus_heap", &HYBRID),
    Series::new("KB-PS", "kb_ps", &K),
    Series::new("KB-MDT₃₂", "kb_mdt32", &K),
    Series::new("KB-MDT₆₄", "kb_mdt64", &K),
    Series::new("K⁺B-AB_SB", "kplus_ab_sb", &HYBRID),
    Series::new("KB-AB_Array", "kb_ab_array", &HYBRID),
    Series::new("KB-AB_LL", "kb_ab_ll", &HYBRID),
    Series::new("KB-AB_SB", "kb_ab_sb", &HYBRID),
    Series::new("KB-LL", "kb_ll", &K),
];

const K: [(&str, &str); 1] = [("k", "{x}")];
/// The paper's sort in the resolve pass: insertion sort up to 16 fragments, shell sort beyond.
const HYBRID: [(&str, &str); 2] = [("k", "{x}"), ("sort", "hybrid")];

const CHARTS: [Chart; 3] = [
    Chart { panel: "n128", title: "frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "n128", title: "store pass", measure: Measure::Time(Passes::Only(&["store"])) },
    Chart { panel: "n128", title: "resolve pass", measure: Measure::Time(Passes::Only(&["resolve"])) },
];

const CLAIMS: [Claim; 8] = [
    Claim {
        statement: "K⁺B-Array is faster than KB-PS for every k",
        check: Check::Faster { panel: "n128", series: "K⁺B-Array", than: "KB-PS", passes: Passes::All, at: &[] },
    },
    Claim {
        statement: "K⁺B-Array is faster than KB-MDT₃₂ for every k",
        check: Check::Faster {
            panel: "n128", series: "K⁺B-Array", than: "KB-MDT₃₂", passes: Passes::All, at: &[]
        },
    },
    Claim {
        statement: "K⁺B-Heap gains on K⁺B-Array as k grows",
        check: Check::Changes { panel: "n128", series: "K⁺B-Heap", over: "K⁺B-Array", change: Change::Falls },
    },
    Claim {
        statement: "K⁺B-Heap is faster than K⁺B-Array for k = 64",
        check: Check::Faster {
            panel: "n128", series: "K⁺B-Heap", than: "K⁺B-Array", passes: Passes::All, at: &[64]
        },
    },
    Claim {
        statement: "K⁺B-Heap is faster than KB-PS for k = 64 (in the paper 3.5 times)",
        check: Check::Faster { panel: "n128", series: "K⁺B-Heap", than: "KB-PS", passes: Passes::All, at: &[64] },
    },
    Claim {
        statement: "KB-MDT₆₄ is faster than KB-MDT₃₂ for k = 4",
        check: Check::Faster {
            panel: "n128", series: "KB-MDT₆₄", than: "KB-MDT₃₂", passes: Passes::All, at: &[4]
        },
    },
    Claim {
        statement: "the lead of KB-MDT₆₄ over KB-MDT₃₂ shrinks as k grows",
        check: Check::Changes { panel: "n128", series: "KB-MDT₆₄", over: "KB-MDT₃₂", change: Change::Rises },
    },
    Claim {
        statement: "the store pass of KB-AB_LL is faster than that of K⁺B-Array for every k",
        check: Check::Faster {
            panel: "n128",
            series: "KB-AB_LL",
            than: "K⁺B-Array",
            passes: Passes::Only(&["store"]),
            at: &[],
        },
    },
];
