//! D13, Fig. 11: memory of peeling and A-buffers over the depth complexity, with two coplanar fragments in every layer and half of the pixels covered.
//! Pools and slots have the size that the frame needs, which is doubled where slots per pixel are too few.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-11",
    paper: "D13, Fig. 11",
    title: "memory of peeling and A-buffers by the depth complexity",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:layers,n={x},coplanar=2,pixels=50", "builtin:layers,n={x},coplanar=2,pixels=50"],
    camera: "clip",
    axis: Axis { symbol: "D", label: "layers of two fragments", values: &[4, 8, 16, 32, 64], quick: &[2, 4] },
    side: Side::Fixed(128),
    series: &[
        Series::new("F2B-FAB", "f2b_fab", &[]),
        Series::new("F2B-LL", "f2b_ll", &[]),
        Series::new("DUAL-FAB", "dual_fab", &[]),
        Series::new("8 layers at a time", "k_peeling", &[("k", "8")]),
        Series::new("FAB", "ab_array", &[]),
        Series::new("LL", "ab_ll", &[]),
        Series::new("SB", "ab_sb", &[]),
        Series::new("BUN-LL", "ab_ll_bun", &[]),
    ],
};

const CHARTS: [Chart; 1] = [Chart { panel: "all", title: "memory", measure: Measure::Mebibytes }];

const fn smaller(series: &'static str, than: &'static str, at: &'static [u32]) -> Check {
    Check::Smaller { panel: "all", series, than, at }
}

const CLAIMS: [Claim; 5] = [
    Claim { statement: "SB needs less memory than FAB", check: smaller("SB", "FAB", &[]) },
    Claim { statement: "LL needs less memory than FAB in deep scenes", check: smaller("LL", "FAB", &[16, 32, 64]) },
    Claim { statement: "peeling needs less memory than FAB", check: smaller("F2B-FAB", "FAB", &[8, 16, 32, 64]) },
    Claim { statement: "peeling needs less memory than SB in deep scenes", check: smaller("F2B-FAB", "SB", &[32, 64]) },
    Claim { statement: "F2B-FAB needs less memory than DUAL-FAB", check: smaller("F2B-FAB", "DUAL-FAB", &[]) },
];
