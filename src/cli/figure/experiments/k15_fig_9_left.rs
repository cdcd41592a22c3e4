//! K15, Fig. 9 left: the interlock of the hardware against the spin lock, k = 8 and n = 8, 16, 32. The paper measures both on a GTX 970 and
//! on Intel Iris Pro 5200.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-9-left",
    paper: "K15, Fig. 9 left",
    title: "interlock against spin lock, k = 8",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "k8",
    scene: ["builtin:layers,n={x}", "builtin:layers,n={x}"],
    camera: "clip",
    axis: Axis { symbol: "n", label: "n, fragments per pixel", values: &[8, 16, 32], quick: &[8, 16] },
    side: Side::Fixed(256),
    series: &[
        Series::new("K⁺B-Array, spin lock", "kplus_array", &[("k", "8"), ("sync", "spin_lock")]),
        Series::new("K⁺B-Array, interlock", "kplus_array", &[("k", "8"), ("sync", "interlock")]),
        Series::new("KB-PS, spin lock", "kb_ps", &[("k", "8"), ("sync", "spin_lock")]),
        Series::new("KB-PS, interlock", "kb_ps", &[("k", "8"), ("sync", "interlock")]),
        Series::new("KB-MDT₃₂", "kb_mdt32", &[("k", "8")]),
        Series::new("KB-AB_Array", "kb_ab_array", &[("k", "8")]),
    ],
};

const CHARTS: [Chart; 2] = [
    Chart { panel: "k8", title: "frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "k8", title: "store pass", measure: Measure::Time(Passes::Only(&["store"])) },
];

const fn faster(series: &'static str, than: &'static str) -> Check {
    Check::Faster { panel: "k8", series, than, passes: Passes::All, at: &[] }
}

const CLAIMS: [Claim; 5] = [
    Claim {
        statement: "K⁺B-Array is faster with the interlock than with the spin lock",
        check: faster("K⁺B-Array, interlock", "K⁺B-Array, spin lock"),
    },
    Claim {
        statement: "KB-PS is faster with the interlock than with the spin lock",
        check: faster("KB-PS, interlock", "KB-PS, spin lock"),
    },
    Claim {
        statement: "K⁺B-Array is faster than KB-PS where both use the interlock",
        check: faster("K⁺B-Array, interlock", "KB-PS, interlock"),
    },
    Claim {
        statement: "K⁺B-Array is faster than KB-PS where both use the spin lock",
        check: faster("K⁺B-Array, spin lock", "KB-PS, spin lock"),
    },
    Claim {
        statement: "K⁺B-Array with the spin lock grows linearly with n",
        check: Check::Exponent { panel: "k8", series: "K⁺B-Array, spin lock", range: [0.7, 1.2] },
    },
];
