//! K15, Fig. 1: the construction of a row of a 4-buffer. The paper ray casts the dragon; here the objects of a generated scene arrive one
//! after the other.

use crate::cli::figure::experiment::{Experiment, Kind, Series, Steps};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-1",
    paper: "K15, Fig. 1",
    title: "construction of a row of a 4-buffer (K⁺B-Array), object by object",
    kind: Kind::Steps(Steps {
        scene: "builtin:slabs,n=16,seed=3",
        camera: "clip",
        series: Series { label: "K⁺B-Array", technique: "kplus_array", set: &[("k", "{x}")] },
        k: 4,
        side: 10,
        row: 4,
    }),
};
