//! K15, Fig. 3: the histogram of the hairball from one view, and k for several budgets and hit ratios. A budget is in bytes per pixel here, so that
//! `--size` does not change k: 200 MiB at 1024 × 768 pixels are 266.

use crate::cli::figure::experiment::{Experiment, Goal, Kind, PredictionCheck, PredictionClaim, Predictions};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-3",
    paper: "K15, Fig. 3",
    title: "depth complexity of the hairball, and k by memory and hit ratio",
    kind: Kind::Predictions(Predictions {
        scene: ["builtin:hairball,strands=1500", "builtin:hairball,strands=60"],
        technique: "kplus_array",
        views: &[("hairball", "auto")],
        side: 256,
        goals: &GOALS,
        claims: &CLAIMS,
    }),
};

const GOALS: [Goal; 4] = [
    Goal { bytes_per_pixel: 266, percent: 50 },
    Goal { bytes_per_pixel: 266, percent: 75 },
    Goal { bytes_per_pixel: 133, percent: 95 },
    Goal { bytes_per_pixel: 533, percent: 95 },
];

const CLAIMS: [PredictionClaim; 1] =
    [PredictionClaim { statement: "k follows the memory and the hit ratio", check: PredictionCheck::GrowsWithGoals }];
