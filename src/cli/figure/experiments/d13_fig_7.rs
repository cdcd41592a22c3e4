//! D13, Fig. 7: peeling and A-buffers over the resolution, in a scene without coplanar fragments. The paper draws a crank of 2 to 17 layers on a GTX
//! 480, at up to 1920 × 1080; here random quads of as many layers. F2B-2P, F2B-3P, DUAL and DUAL-2P are missing.

use crate::cli::figure::claim::{Change, Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-7",
    paper: "D13, Fig. 7",
    title: "peeling and A-buffers by the side of the image",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:slabs,n=24", "builtin:slabs,n=6"],
    camera: "clip",
    axis: Axis { symbol: "side", label: "side in pixels", values: &[128, 256, 512], quick: &[16, 32] },
    side: Side::Swept,
    series: &[
        Series::new("F2B", "f2b", &[]),
        Series::new("F2B2", "f2b2", &[]),
        Series::new("F2B-LL", "f2b_ll", &[]),
        Series::new("F2B-FAB", "f2b_fab", &[]),
        Series::new("F2B-KB", "f2b_kb", &[]),
        Series::new("DUAL-LL", "dual_ll", &[]),
        Series::new("DUAL-FAB", "dual_fab", &[]),
        Series::new("DUAL-KB", "dual_kb", &[]),
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

const CLAIMS: [Claim; 6] = [
    Claim { statement: "F2B is faster than F2B-FAB", check: faster("F2B", "F2B-FAB", &[]) },
    Claim {
        statement: "DUAL-FAB is faster than F2B-FAB at a low resolution",
        check: faster("DUAL-FAB", "F2B-FAB", &[128]),
    },
    Claim { statement: "DUAL-FAB is faster than DUAL-LL", check: faster("DUAL-FAB", "DUAL-LL", &[]) },
    Claim { statement: "FAB is faster than DUAL-FAB", check: faster("FAB", "DUAL-FAB", &[]) },
    Claim { statement: "SB is faster than DUAL-FAB", check: faster("SB", "DUAL-FAB", &[]) },
    Claim {
        statement: "lists fall behind arrays as the resolution grows",
        check: Check::Changes { panel: "all", series: "F2B-LL", over: "F2B-FAB", change: Change::Rises },
    },
];
