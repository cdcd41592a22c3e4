//! K15, Fig. 4: k for a fixed budget and hit ratio from several views. The paper shows a motor engine (k = 8, 19, 13) and an animation;
//! here a scene of needles is seen from two sides and along them. The paper's 200 MB are 266 bytes per pixel at 1024 × 768 pixels.

use crate::cli::figure::experiment::{Experiment, Goal, Kind, PredictionCheck, PredictionClaim, Predictions};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-4",
    paper: "K15, Fig. 4",
    title: "depth complexity from three views, and k for 266 bytes per pixel and a hit ratio of 95 %",
    kind: Kind::Predictions(Predictions {
        scene: ["builtin:needles,n=1500", "builtin:needles,n=30"],
        technique: "kplus_array",
        views: &[("in front", "orbit:0,0"), ("from the side", "orbit:90,0"), ("along the needles", "orbit:30,5")],
        side: 256,
        goals: &[Goal { bytes_per_pixel: 266, percent: 95 }],
        claims: &CLAIMS,
    }),
};

const CLAIMS: [PredictionClaim; 2] = [
    PredictionClaim { statement: "k adapts to the view", check: PredictionCheck::Adapts },
    PredictionClaim {
        statement: "95 % of the fragments are kept within the budget",
        check: PredictionCheck::KeepsWithinBudget,
    },
];
