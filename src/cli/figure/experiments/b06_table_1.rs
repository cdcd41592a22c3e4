//! B06, Table 1: peeling of k layers by k draws of the scene (MP) against k-buffers in one draw (SP), for 4 and 16 layers. The paper draws a dragon, a
//! power plant and Lucy at 512 × 512 pixels; here the hairball. F2B needs one draw more to find that nothing, or something, is left. The paper's third
//! mode, sorted batches with a flush after each (SPwH), is missing, because a flush of the pipeline is not an operation of these interfaces.

use crate::cli::figure::claim::{Change, Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "b06-table-1",
    paper: "B06, Table 1",
    title: "peeling in many draws of the scene against k-buffers in one",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const MP: &str = "MP (F2B)";
const SP: &str = "SP (KB)";
const SP_PS: &str = "SP (KB-PS)";

const PANEL: Panel = Panel {
    name: "hairball",
    scene: ["builtin:hairball,strands=2000", "builtin:hairball,strands=8"],
    camera: "auto",
    axis: Axis { symbol: "k", label: "k, layers", values: &[4, 8, 16], quick: &[2, 4] },
    side: Side::Fixed(512),
    series: &[
        Series::new(MP, "f2b", &[("peeling.iterations", "{x+1}")]),
        Series::new(SP, "kb", &[("k", "{x}")]),
        Series::new(SP_PS, "kb_ps", &[("k", "{x}")]),
    ],
};

const CHARTS: [Chart; 1] = [Chart { panel: "hairball", title: "frame", measure: Measure::Time(Passes::All) }];

const fn faster(series: &'static str) -> Check {
    Check::Faster { panel: "hairball", series, than: MP, passes: Passes::All, at: &[4, 16] }
}

const CLAIMS: [Claim; 5] = [
    Claim {
        statement: "MP grows linearly with k",
        check: Check::Exponent { panel: "hairball", series: MP, range: [0.8, 1.2] },
    },
    Claim {
        statement: "SP with KB does not grow with k",
        check: Check::Exponent { panel: "hairball", series: SP, range: [-0.1, 0.1] },
    },
    Claim { statement: "SP with KB is faster than MP", check: faster(SP) },
    Claim { statement: "SP with KB-PS is faster than MP", check: faster(SP_PS) },
    Claim {
        statement: "the gain of SP with KB grows with k",
        check: Check::Changes { panel: "hairball", series: SP, over: MP, change: Change::Falls },
    },
];
