//! C15, Fig. 1: the k⁺-buffer with and without occupancy culling, k = 4 … 64, on the hairball and the needle tree. The paper measures 1024²
//! pixels on a GTX 780 Ti: the time falls by 20 to 50 %, although the scene is drawn more often. Its models are not public; the generated
//! scenes have their depth complexity.

use crate::cli::figure::claim::{Check, Claim};
use crate::cli::figure::experiment::{Axis, Chart, Experiment, Kind, Measure, Panel, Passes, Series, Side, Sweep};

pub(super) const ROW: Experiment = Experiment {
    name: "c15-fig-1",
    paper: "C15, Fig. 1",
    title: "K⁺B with and without occupancy culling",
    kind: Kind::Sweep(Sweep { panels: &[HAIRBALL, NEEDLES], charts: &CHARTS, claims: &CLAIMS }),
};

const K: Axis = Axis { symbol: "k", label: "k", values: &[4, 8, 16, 32, 64], quick: &[4, 8] };

const HAIRBALL: Panel = Panel {
    name: "hairball",
    scene: ["builtin:hairball", "builtin:hairball,strands=20"],
    camera: "auto",
    axis: K,
    side: Side::Fixed(256),
    series: &SERIES,
};

const NEEDLES: Panel = Panel { name: "needles", scene: ["builtin:needles", "builtin:needles,n=40"], ..HAIRBALL };

/// 32 words are the paper's d = 32: 1024 buckets per pixel.
const SERIES: [Series; 3] = [
    Series { label: "K⁺B-Array", technique: "kplus_array", set: &[("k", "{x}"), ("sort", "hybrid")] },
    Series {
        label: "occupancy, early z",
        technique: "kplus_array",
        set: &[("k", "{x}"), ("sort", "hybrid"), ("cull", "occupancy_early"), ("cull.words", "32")],
    },
    Series {
        label: "occupancy, in shader",
        technique: "kplus_array",
        set: &[("k", "{x}"), ("sort", "hybrid"), ("cull", "occupancy"), ("cull.words", "32")],
    },
];

const CHARTS: [Chart; 4] = [
    Chart { panel: "hairball", title: "hairball: frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "hairball", title: "hairball: store pass", measure: Measure::Time(Passes::Only(&["store"])) },
    Chart { panel: "needles", title: "needles: frame", measure: Measure::Time(Passes::All) },
    Chart { panel: "needles", title: "needles: store pass", measure: Measure::Time(Passes::Only(&["store"])) },
];

const fn faster(panel: &'static str, passes: Passes) -> Check {
    Check::Faster { panel, series: "occupancy, early z", than: "K⁺B-Array", passes, at: &[] }
}

const CLAIMS: [Claim; 4] = [
    Claim {
        statement: "occupancy culling makes frames of the hairball faster for every k (by 20 to 50 % in the paper)",
        check: faster("hairball", Passes::All),
    },
    Claim {
        statement: "occupancy culling makes frames of the needles faster for every k (by 20 to 50 % in the paper)",
        check: faster("needles", Passes::All),
    },
    Claim {
        statement: "occupancy culling makes the store pass of the hairball faster for every k",
        check: faster("hairball", Passes::Only(&["store"])),
    },
    Claim {
        statement: "occupancy culling makes the store pass of the needles faster for every k",
        check: faster("needles", Passes::Only(&["store"])),
    },
];
