//! B06, Table 2: the maximum disorder of sorted triangles by the budget of a subdivision. The paper draws a tetrahedral mesh of a heart with many
//! badly formed primitives; its caption and its text state different k (12 and 6), and its triangle counts are not the budgets times that of the mesh, so only
//! the trend is compared. Here oblique layers of strips, of which a quarter are two slivers each.

use crate::cli::figure::experiment::{Disorder, Experiment, Kind};

pub(super) const ROW: Experiment = Experiment {
    name: "b06-table-2",
    paper: "B06, Table 2",
    title: "disorder of sorted triangles by the budget of a subdivision",
    kind: Kind::Disorder(Disorder {
        scene: ["builtin:slivers,n=16,long=25", "builtin:slivers,n=6,rows=6,long=25"],
        camera: "orbit:0,0",
        side: 256,
        budgets: &[
            (100, Some(17)),
            (150, Some(6)),
            (200, None),
            (300, None),
            (400, None),
            (600, Some(3)),
            (1200, Some(0)),
        ],
    }),
};
