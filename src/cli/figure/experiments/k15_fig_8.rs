//! K15, Fig. 8: time over memory of k-buffer variants, on pixels of up to n = 10 k fragments. p_d per cent of the pixels are covered, and a
//! fragment is drawn there with a probability of f_p per cent. The paper measures 1024² pixels on a GTX 780 Ti.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-8",
    paper: "K15, Fig. 8",
    title: "time over memory of k-buffer variants, n = 10 k",
    kind: Kind::Sweep(Sweep { panels: &PANELS, charts: &CHARTS, claims: &CLAIMS }),
};

const SPARSE: &str = "25 %";
const HALF: &str = "50 %";
const DENSE: &str = "75 %";

const PANELS: [Panel; 3] = [
    panel(SPARSE, "builtin:layers,n={x}0,pixels=25,fragments=25"),
    panel(HALF, "builtin:layers,n={x}0,pixels=50,fragments=50"),
    panel(DENSE, "builtin:layers,n={x}0,pixels=75,fragments=75"),
];

const fn panel(name: &'static str, scene: &'static str) -> Panel {
    let axis = Axis { symbol: "k", label: "k (n = 10 k)", values: &[4, 8, 16, 32], quick: &[2, 4] };
    Panel { name, scene: [scene; 2], camera: "clip", axis, side: Side::Fixed(128), series: &SERIES }
}

const SERIES: [Series; 8] = [
    Series::new("K⁺B-Array", "kplus_array", &HYBRID),
    Series::new("K⁺B-Heap", "kplus_heap", &HYBRID),
    Series::new("K⁺B-AB_SB", "kplus_ab_sb", &HYBRID),
    Series::new("KB-PS", "kb_ps", &K),
    Series::new("KB-MDT₃₂", "kb_mdt32", &K),
    Series::new("KB-AB_Array", "kb_ab_array", &HYBRID),
    Series::new("KB-AB_SB", "kb_ab_sb", &HYBRID),
    Series::new("KB-LL", "kb_ll", &K),
];

const K: [(&str, &str); 1] = [("k", "{x}")];
/// The paper's sort in the resolve pass.
const HYBRID: [(&str, &str); 2] = [("k", "{x}"), ("sort", "hybrid")];

const CHARTS: [Chart; 6] = [
    Chart { panel: SPARSE, title: "25 %: frame over memory", measure: Measure::TimePerMebibyte },
    Chart { panel: HALF, title: "50 %: frame over memory", measure: Measure::TimePerMebibyte },
    Chart { panel: DENSE, title: "75 %: frame over memory", measure: Measure::TimePerMebibyte },
    Chart { panel: SPARSE, title: "25 %: memory", measure: Measure::Mebibytes },
    Chart { panel: HALF, title: "50 %: memory", measure: Measure::Mebibytes },
    Chart { panel: DENSE, title: "75 %: memory", measure: Measure::Mebibytes },
];

const fn smaller(panel: &'static str, series: &'static str, than: &'static str) -> Check {
    Check::Smaller { panel, series, than, at: &[] }
}

const fn faster(panel: &'static str, series: &'static str, than: &'static str) -> Check {
    Check::Faster { panel, series, than, passes: Passes::All, at: &[] }
}

const CLAIMS: [Claim; 7] = [
    Claim {
        statement: "K⁺B-AB_SB needs less memory than K⁺B-Array where 25 % of the pixels are covered",
        check: smaller(SPARSE, "K⁺B-AB_SB", "K⁺B-Array"),
    },
    Claim {
        statement: "K⁺B-AB_SB needs less memory than KB-AB_SB at 25 %",
        check: smaller(SPARSE, "K⁺B-AB_SB", "KB-AB_SB"),
    },
    Claim {
        statement: "K⁺B-AB_SB needs less memory than KB-AB_SB at 75 %",
        check: smaller(DENSE, "K⁺B-AB_SB", "KB-AB_SB"),
    },
    Claim {
        statement: "KB-AB_SB needs less memory than KB-AB_Array at 75 %",
        check: smaller(DENSE, "KB-AB_SB", "KB-AB_Array"),
    },
    Claim {
        statement: "K⁺B-Array needs less memory than KB-AB_SB at 75 %",
        check: smaller(DENSE, "K⁺B-Array", "KB-AB_SB"),
    },
    Claim { statement: "K⁺B-AB_SB is faster than KB-AB_SB at 75 %", check: faster(DENSE, "K⁺B-AB_SB", "KB-AB_SB") },
    Claim {
        statement: "K⁺B-Array is faster than K⁺B-AB_SB at 75 %", check: faster(DENSE, "K⁺B-Array", "K⁺B-AB_SB")
    },
];
