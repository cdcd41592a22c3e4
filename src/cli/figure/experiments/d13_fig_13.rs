//! D13, Fig. 13: the coplanarity of scenes as heat maps, with C_p and the hit ratio R_h of F2B. The paper shows a power plant (R_h = 0.98,
//! C_p = 0.285), rungholt (0.9, 0.48) and a castle (0.88, 0.81), which are not public or too large. Here planes of 2, 5 and 9 coplanar quads,
//! and planes of which every pixel has a random part. There are 8 by 8 cells, so pixels of a cell are alike.

use crate::cli::figure::experiment::{CoplanarCheck, CoplanarClaim, CoplanarScene, CoplanarScenes, Experiment, Kind};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-13",
    paper: "D13, Fig. 13",
    title: "fragments of equal depths, C_p and the hit ratio of F2B",
    kind: Kind::Coplanarity(CoplanarScenes {
        scenes: &SCENES,
        camera: "clip",
        side: 192,
        technique: "f2b",
        claims: &CLAIMS,
    }),
};

const SCENES: [CoplanarScene; 6] = [
    scene("2 coplanar", "builtin:layers,n=1,coplanar=2"),
    scene("5 coplanar", "builtin:layers,n=1,coplanar=5"),
    scene("9 coplanar", "builtin:layers,n=1,coplanar=9"),
    scene("mixed, few", "builtin:layers,n=6,coplanar=3,pixels=90,fragments=8"),
    scene("mixed, more", "builtin:layers,n=6,coplanar=3,pixels=90,fragments=20"),
    scene("mixed, many", "builtin:layers,n=6,coplanar=3,pixels=90,fragments=35"),
];

/// The scenes are small enough for `--quick`.
const fn scene(label: &'static str, scene: &'static str) -> CoplanarScene {
    CoplanarScene { label, scene: [scene, scene] }
}

const CLAIMS: [CoplanarClaim; 5] = [
    CoplanarClaim { statement: "F2B keeps one fragment of each depth", check: CoplanarCheck::KeepsOnePerDepth },
    CoplanarClaim {
        statement: "R_h of F2B falls as C_p rises over the mixed scenes",
        check: CoplanarCheck::FallsWithCoplanarity(&["mixed, few", "mixed, more", "mixed, many"]),
    },
    CoplanarClaim {
        statement: "red pixels have 2 coplanar fragments",
        check: CoplanarCheck::EveryPixelHas("2 coplanar", 2),
    },
    CoplanarClaim { statement: "cyan pixels have 5", check: CoplanarCheck::EveryPixelHas("5 coplanar", 5) },
    CoplanarClaim { statement: "brown pixels have 9", check: CoplanarCheck::EveryPixelHas("9 coplanar", 9) },
];
