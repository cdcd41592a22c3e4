//! K15, Fig. 9 right: peeling k layers at a time beside A-buffers and k-buffers with a k of the deepest pixel, n = 8 … 128. The paper measures on
//! a GTX 780 Ti, and beside them front-to-back and dual depth peeling; one layer at a time stands for the first here, with a lock in place of its
//! depth test.

use crate::cli::figure::claim::{Change, Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-9-right",
    paper: "K15, Fig. 9 right",
    title: "k-depth peeling beside A-buffers, k-buffers with k = n",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:layers,n={x}", "builtin:layers,n={x}"],
    camera: "clip",
    axis: Axis { symbol: "n", label: "n, fragments per pixel", values: &[8, 16, 32, 64, 128], quick: &[8, 16] },
    side: Side::Fixed(128),
    series: &[
        Series::new("one layer at a time", "k_peeling", &[("k", "1"), ("storage", "single")]),
        Series::new("8 layers at a time", "k_peeling", &[("k", "8"), ("sort", "hybrid")]),
        Series::new("32 layers at a time", "k_peeling", &[("k", "32"), ("sort", "hybrid")]),
        Series::new("K⁺B-Array-R, k = n", "kplus_array_revised", &K_IS_N),
        Series::new("K⁺B-AB_SB, k = n", "kplus_ab_sb", &K_IS_N),
        Series::new("AB_Array", "ab_array", &ALL),
        Series::new("AB_LL", "ab_ll", &ALL),
        Series::new("AB_SB", "ab_sb", &ALL),
    ],
};

const K_IS_N: [(&str, &str); 2] = [("k", "{x}"), ("sort", "hybrid")];
const ALL: [(&str, &str); 2] = [("sort", "hybrid"), ("sort.layers", "{x}")];

const CHARTS: [Chart; 2] = [
    Chart { panel: "all", title: "frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "all", title: "store pass", measure: Measure::Time(Passes::Only(&["store"])) },
];

const fn faster(series: &'static str, than: &'static str, at: &'static [u32]) -> Check {
    Check::Faster { panel: "all", series, than, passes: Passes::All, at }
}

const CLAIMS: [Claim; 5] = [
    Claim {
        statement: "8 layers at a time are faster than one for every n",
        check: faster("8 layers at a time", "one layer at a time", &[]),
    },
    Claim {
        statement: "32 layers at a time are faster than 8 for n = 128",
        check: faster("32 layers at a time", "8 layers at a time", &[128]),
    },
    Claim {
        statement: "peeling 8 layers at a time falls behind AB_Array as n grows",
        check: Check::Changes { panel: "all", series: "8 layers at a time", over: "AB_Array", change: Change::Rises },
    },
    Claim {
        statement: "AB_Array is faster than K⁺B-Array-R for every n",
        check: faster("AB_Array", "K⁺B-Array-R, k = n", &[]),
    },
    Claim {
        statement: "AB_SB is faster than K⁺B-AB_SB for every n", check: faster("AB_SB", "K⁺B-AB_SB, k = n", &[])
    },
];
