//! K15, Fig. 7: k-buffer variants with and without the culling of fragments that are farther than all kept ones, for k = 4, 16, 64 and
//! n = 128.

use crate::cli::figure::claim::{Change, Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-7",
    paper: "K15, Fig. 7",
    title: "k-buffer variants with and without fragment culling, n = 128",
    kind: Kind::Sweep(Sweep { panels: &[PANEL], charts: &CHARTS, claims: &CLAIMS }),
};

const PANEL: Panel = Panel {
    name: "n128",
    scene: ["builtin:layers,n=128", "builtin:layers,n=12"],
    camera: "clip",
    axis: Axis { symbol: "k", label: "k", values: &[4, 16, 64], quick: &[4, 8] },
    side: Side::Fixed(128),
    series: &[
        Series::new("K⁺B-Array", "kplus_array", &[("k", "{x}"), ("sort", "hybrid")]),
        Series::new("K⁺B-Array, no cull", "kplus_array", &[("k", "{x}"), ("sort", "hybrid"), ("cull", "none")]),
        Series::new("KB-PS", "kb_ps", &[("k", "{x}")]),
        Series::new("KB-PS, no cull", "kb_ps", &[("k", "{x}"), ("cull", "none")]),
        Series::new("KB-MDT₃₂", "kb_mdt32", &[("k", "{x}")]),
        Series::new("KB-MDT₃₂, no cull", "kb_mdt32", &[("k", "{x}"), ("cull", "none")]),
    ],
};

const CHARTS: [Chart; 2] = [
    Chart { panel: "n128", title: "frame", measure: Measure::Time(Passes::All) },
    Chart {
        panel: "n128",
        title: "all passes but reset and resolve",
        measure: Measure::Time(Passes::Except(&["reset", "resolve"])),
    },
];

const fn faster(series: &'static str, than: &'static str) -> Check {
    Check::Faster { panel: "n128", series, than, passes: Passes::All, at: &[] }
}

const CLAIMS: [Claim; 5] = [
    Claim {
        statement: "K⁺B-Array is faster with culling for every k",
        check: faster("K⁺B-Array", "K⁺B-Array, no cull"),
    },
    Claim { statement: "KB-PS is faster with culling for every k", check: faster("KB-PS", "KB-PS, no cull") },
    Claim {
        statement: "KB-MDT₃₂ is faster with culling for every k", check: faster("KB-MDT₃₂", "KB-MDT₃₂, no cull")
    },
    Claim {
        statement: "KB-PS with culling is slower than K⁺B-Array with culling for every k",
        check: faster("K⁺B-Array", "KB-PS"),
    },
    Claim {
        statement: "the gain of culling in K⁺B-Array shrinks as k grows",
        check: Check::Changes {
            panel: "n128", series: "K⁺B-Array", over: "K⁺B-Array, no cull", change: Change::Rises
        },
    },
];
