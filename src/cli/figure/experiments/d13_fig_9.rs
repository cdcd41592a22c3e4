//! D13, Fig. 9: A-buffers over the depth complexity, in scenes whose fragments are uniform in depth. The paper draws sponza, an engine and a hairball;
//! here random planes over the whole frame.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-9",
    paper: "D13, Fig. 9",
    title: "A-buffers by the depth complexity",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:layers,n={x}", "builtin:layers,n={x}"],
    camera: "clip",
    axis: Axis { symbol: "n", label: "n, fragments per pixel", values: &[16, 32, 64, 128, 256], quick: &[4, 8] },
    side: Side::Fixed(128),
    series: &[
        Series::new("BUN-LL", "ab_ll_bun", &[("sort.layers", "{x}")]),
        Series::new("LL", "ab_ll", &[("sort.layers", "{x}")]),
        Series::new("SB", "ab_sb", &[("sort.layers", "{x}")]),
        Series::new("FAB", "ab_array", &[("sort.layers", "{x}")]),
    ],
};

const CHARTS: [Chart; 2] = [
    Chart { panel: "all", title: "frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "all", title: "resolve pass", measure: Measure::Time(Passes::Only(&["resolve"])) },
];

const fn faster(series: &'static str, than: &'static str, at: &'static [u32]) -> Check {
    Check::Faster { panel: "all", series, than, passes: Passes::All, at }
}

const CLAIMS: [Claim; 3] = [
    Claim { statement: "BUN-LL is faster than LL for every n", check: faster("BUN-LL", "LL", &[]) },
    Claim { statement: "BUN-LL is faster than SB for every n", check: faster("BUN-LL", "SB", &[]) },
    Claim { statement: "FAB is faster than BUN-LL for the greatest n", check: faster("FAB", "BUN-LL", &[256]) },
];
