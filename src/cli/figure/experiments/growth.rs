//! Growth: how the time of a frame grows with k, with the number of fragments per pixel and with the side of the image. The papers
//! state the complexity of the techniques: an insertion costs O(1) where it is rejected, O(k) in a max-array that accepts it, O(log k) in a heap,
//! and at most k atomic minima in MDT; every fragment is processed once, and every pixel alone.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "growth",
    paper: "Growth (K15, section 3.2)",
    title: "time of a frame by k, by fragments per pixel and by the side of the image",
    kind: Kind::Sweep(Sweep { panels: &[BY_K, BY_N, BY_SIDE], charts: &CHARTS, claims: &CLAIMS }),
};

const BY_K: Panel = Panel {
    name: "k",
    scene: ["builtin:layers,n=128", "builtin:layers,n=12"],
    camera: "clip",
    axis: Axis { symbol: "k", label: "k (n = 128)", values: &[4, 8, 16, 32, 64], quick: &[4, 8] },
    side: Side::Fixed(128),
    series: &[
        Series { label: "K⁺B-Array", technique: "kplus_array", set: &[("k", "{x}"), ("sort", "hybrid")] },
        Series { label: "K⁺B-Heap", technique: "kplus_heap", set: &[("k", "{x}"), ("sort", "hybrid")] },
        Series { label: "MDT, equal depths", technique: "mdt32_coplanar", set: &[("k", "{x}")] },
        Series { label: "KB-AB_LL", technique: "kb_ab_ll", set: &[("k", "{x}"), ("sort", "hybrid")] },
    ],
};

const BY_N: Panel = Panel {
    name: "n",
    scene: ["builtin:layers,n={x}", "builtin:layers,n={x}"],
    camera: "clip",
    axis: Axis { symbol: "n", label: "fragments per pixel (k = 8)", values: &[16, 64, 256, 1024], quick: &[4, 16] },
    side: Side::Fixed(64),
    series: &[
        Series { label: "K⁺B-Array", technique: "kplus_array", set: &[("k", "8")] },
        Series { label: "K⁺B-Heap", technique: "kplus_heap", set: &[("k", "8")] },
        Series { label: "MDT, equal depths", technique: "mdt32_coplanar", set: &[("k", "8")] },
        Series { label: "KB-AB_LL", technique: "kb_ab_ll", set: &[("k", "8")] },
    ],
};

const BY_SIDE: Panel = Panel {
    name: "side",
    scene: ["builtin:layers,n=4", "builtin:layers,n=4"],
    camera: "clip",
    axis: Axis {
        symbol: "side",
        label: "side in pixels (k = 4, n = 4)",
        values: &[512, 1024, 2048, 4096],
        quick: &[16, 32],
    },
    side: Side::Swept,
    series: &[
        Series { label: "K⁺B-Array", technique: "kplus_array", set: &[("k", "4")] },
        Series { label: "KB-AB_LL", technique: "kb_ab_ll", set: &[("k", "4")] },
    ],
};

const CHARTS: [Chart; 3] = [
    Chart { panel: "k", title: "growth with k", measure: Measure::Time(Passes::All) },
    Chart { panel: "n", title: "growth with n", measure: Measure::Time(Passes::All) },
    Chart { panel: "side", title: "growth with the side", measure: Measure::Time(Passes::All) },
];

const fn claim(statement: &'static str, panel: &'static str, series: &'static str, range: [f64; 2]) -> Claim {
    Claim { statement, check: Check::Exponent { panel, series, range } }
}

const CLAIMS: [Claim; 10] = [
    claim("K⁺B-Array grows at most linearly with k", "k", "K⁺B-Array", [0.0, 1.1]),
    claim("K⁺B-Heap grows less than linearly with k", "k", "K⁺B-Heap", [0.0, 0.9]),
    claim("MDT grows at most linearly with k", "k", "MDT, equal depths", [0.0, 1.1]),
    claim("KB-AB_LL grows at most linearly with k", "k", "KB-AB_LL", [0.0, 1.1]),
    claim("K⁺B-Array grows at most linearly with n", "n", "K⁺B-Array", [0.0, 1.1]),
    claim("K⁺B-Heap grows at most linearly with n", "n", "K⁺B-Heap", [0.0, 1.1]),
    claim("MDT grows at most linearly with n", "n", "MDT, equal depths", [0.0, 1.1]),
    claim("KB-AB_LL grows linearly with n", "n", "KB-AB_LL", [0.85, 1.15]),
    claim("K⁺B-Array grows with the square of the side", "side", "K⁺B-Array", [1.8, 2.2]),
    claim("KB-AB_LL grows with the square of the side", "side", "KB-AB_LL", [1.8, 2.2]),
];
