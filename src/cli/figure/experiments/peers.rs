//! Other projects' own shaders beside ours, on OpenGL: 64 fragments in every pixel in random order, and spheres that cover few pixels.

use crate::cli::figure::experiment::{Experiment, Kind, PeerScene, Peers};

pub(super) const ROW: Experiment = Experiment {
    name: "peers",
    paper: "MFR",
    title: "frame time of ours divided by that of other projects, k = 8",
    kind: Kind::Peers(Peers { scenes: &SCENES, side: 256 }),
};

const SCENES: [PeerScene; 2] = [
    PeerScene { name: "layers", scene: ["builtin:layers,n=64", "builtin:layers,n=4"], camera: "clip" },
    PeerScene { name: "marbles", scene: ["builtin:marbles,n=30", "builtin:marbles,n=2"], camera: "auto" },
];
