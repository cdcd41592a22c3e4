//! K15, section 5.1.2: A-buffers whose resolve pass sorts by l⁺ or in one array, n = 64 and 128. The paper measures l⁺ as 3.1 times faster for
//! n = 64 and 4.64 times for n = 128 on a GTX 780. The unified framework is K⁺B-AB_SB with a k of the deepest pixel.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-sec-5-1-2",
    paper: "K15, section 5.1.2",
    title: "A-buffers with l⁺ sorting and with one array, and the unified framework",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "all",
    scene: ["builtin:layers,n={x}", "builtin:layers,n={x}"],
    camera: "clip",
    axis: Axis { symbol: "n", label: "n, fragments per pixel", values: &[64, 128], quick: &[8, 16] },
    side: Side::Fixed(128),
    series: &[
        Series::new("AB_Array", "ab_array", &[("sort", "hybrid"), ("sort.layers", "{x}")]),
        Series::new("AB_Array, l⁺", "ab_array", &[("sort", "lplus")]),
        Series::new("AB_SB", "ab_sb", &[("sort", "hybrid"), ("sort.layers", "{x}")]),
        Series::new("AB_SB, l⁺", "ab_sb", &[("sort", "lplus")]),
        Series::new("unified", "unified", &[("k", "{x}"), ("sort", "hybrid")]),
        Series::new("unified, l⁺", "unified", &[("k", "{x}"), ("sort", "lplus")]),
    ],
};

const RESOLVE: Passes = Passes::Only(&["resolve"]);

const CHARTS: [Chart; 2] = [
    Chart { panel: "all", title: "frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "all", title: "resolve pass", measure: Measure::Time(RESOLVE) },
];

const fn faster(series: &'static str, than: &'static str, passes: Passes) -> Check {
    Check::Faster { panel: "all", series, than, passes, at: &[] }
}

const CLAIMS: [Claim; 3] = [
    Claim {
        statement: "l⁺ sorts AB_Array faster for every n (in the paper 3.1 and 4.64 times)",
        check: faster("AB_Array, l⁺", "AB_Array", RESOLVE),
    },
    Claim {
        statement: "AB_Array is faster than the other A-buffers for every n",
        check: faster("AB_Array", "AB_SB", Passes::All),
    },
    Claim {
        statement: "K⁺B-AB_SB takes longer than AB_SB for every n",
        check: faster("AB_SB", "unified", Passes::All),
    },
];
