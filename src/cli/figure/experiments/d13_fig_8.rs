//! D13, Fig. 8: peeling and A-buffers over the number of coplanar fragments per layer. The paper draws overlapping instances of a fandisk; here four
//! planes over the whole frame, each drawn so many times. F2B-2P, F2B-3P and DUAL-2P are missing.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-8",
    paper: "D13, Fig. 8",
    title: "peeling and A-buffers by the number of coplanar fragments",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:layers,n=4,coplanar={x}", "builtin:layers,n=2,coplanar={x}"],
    camera: "clip",
    axis: Axis {
        symbol: "C",
        label: "coplanar fragments in each of 4 layers",
        values: &[1, 2, 4, 8, 16],
        quick: &[1, 2],
    },
    side: Side::Fixed(256),
    series: &[
        Series::new("F2B-LL", "f2b_ll", &[]),
        Series::new("F2B-FAB", "f2b_fab", &[]),
        Series::new("F2B-KB", "f2b_kb", &[]),
        Series::new("DUAL-LL", "dual_ll", &[]),
        Series::new("DUAL-FAB", "dual_fab", &[]),
        Series::new("DUAL-KB", "dual_kb", &[]),
        Series::new("8 layers at a time", "k_peeling", &[("k", "8")]),
        Series::new("FAB", "ab_array", &[]),
        Series::new("LL", "ab_ll", &[]),
        Series::new("SB", "ab_sb", &[]),
        Series::new("BUN-LL", "ab_ll_bun", &[]),
    ],
};

const CHARTS: [Chart; 1] = [Chart { panel: "all", title: "frame", measure: Measure::Time(Passes::All) }];

const fn faster(series: &'static str, than: &'static str, at: &'static [u32]) -> Check {
    Check::Faster { panel: "all", series, than, passes: Passes::All, at }
}

const CLAIMS: [Claim; 4] = [
    Claim { statement: "F2B-FAB is faster than F2B-LL", check: faster("F2B-FAB", "F2B-LL", &[]) },
    Claim { statement: "DUAL-LL is faster than F2B-LL", check: faster("DUAL-LL", "F2B-LL", &[]) },
    Claim { statement: "BUN-LL is faster than LL", check: faster("BUN-LL", "LL", &[]) },
    Claim { statement: "BUN-LL is faster than SB", check: faster("BUN-LL", "SB", &[]) },
];
