//! D13, Fig. 10: peeling with and without culling of objects that are peeled completely. The paper draws three dragons behind each other;
//! here marbles, each an object, more and more of them.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-10",
    paper: "D13, Fig. 10",
    title: "peeling with and without culling of objects",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:marbles,n={x}", "builtin:marbles,n={x}"],
    camera: "auto",
    axis: Axis { symbol: "objects", label: "objects", values: &[25, 50, 100, 200, 400], quick: &[5, 10] },
    side: Side::Fixed(128),
    series: &[
        Series::new("F2B-FAB", "f2b_fab", &[]),
        Series::new("F2B-FAB, culled", "f2b_fab", CULLED),
        Series::new("F2B-2P", "f2b_2p", &[]),
        Series::new("F2B-2P, culled", "f2b_2p", CULLED),
        Series::new("DUAL-FAB", "dual_fab", &[]),
        Series::new("DUAL-FAB, culled", "dual_fab", CULLED),
    ],
};

const CULLED: &[(&str, &str)] = &[("objects", "unpeeled")];

const CHARTS: [Chart; 2] = [
    Chart { panel: "all", title: "frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "all", title: "store pass", measure: Measure::Time(Passes::Only(&["store"])) },
];

const fn faster(series: &'static str, than: &'static str) -> Check {
    Check::Faster { panel: "all", series, than, passes: Passes::All, at: &[100, 200, 400] }
}

const CLAIMS: [Claim; 3] = [
    Claim {
        statement: "culling makes F2B-FAB faster from 100 objects on",
        check: faster("F2B-FAB, culled", "F2B-FAB"),
    },
    Claim { statement: "culling makes F2B-2P faster from 100 objects on", check: faster("F2B-2P, culled", "F2B-2P") },
    Claim {
        statement: "culling makes DUAL-FAB faster from 100 objects on",
        check: faster("DUAL-FAB, culled", "DUAL-FAB"),
    },
];
