//! B06, Fig. 3: hazards of the k-buffer with the layout of the mesh, and with triangles sorted by the depth of their centroids. The order of the
//! CPU device begins fragments in submission order, and those of 256 consecutive triangles overlap.

use fragbuf_cpu::FragmentOrder;

use crate::cli::figure::experiment::{
    Expected, Experiment, ImageClaim, Images, Kind, Series, Shown, Triangles, Variant,
};

pub(super) const ROW: Experiment = Experiment {
    name: "b06-fig-3",
    paper: "B06, Fig. 3",
    title: "hazards of KB by the order of triangles, k = 8",
    kind: Kind::Images(Images {
        scene: ["builtin:hairball,strands=600", "builtin:hairball,strands=8"],
        camera: "auto",
        side: 220,
        order: FragmentOrder::Window { seed: 1, triangles: 256 },
        variants: &VARIANTS,
        shown: Shown::Differences,
        claims: &CLAIMS,
    }),
};

const K: [(&str, &str); 1] = [("k", "8")];

const VARIANTS: [Variant; 4] = [
    Variant {
        series: Series { label: "K⁺B-Array", technique: "kplus_array", set: &K },
        triangles: Triangles::AsModelled,
    },
    Variant { series: Series { label: "(a) KB", technique: "kb", set: &K }, triangles: Triangles::AsModelled },
    Variant {
        series: Series { label: "(b) KB, sorted triangles", technique: "kb", set: &K },
        triangles: Triangles::ByCentroid,
    },
    Variant {
        series: Series { label: "K⁺B-Array, sorted", technique: "kplus_array", set: &K },
        triangles: Triangles::ByCentroid,
    },
];

const CLAIMS: [ImageClaim; 3] = [
    ImageClaim {
        statement: "KB shows hazards with the layout of the mesh",
        variant: "(a) KB",
        expected: Expected::Different,
    },
    ImageClaim {
        statement: "triangles sorted by their centroids reduce them",
        variant: "(b) KB, sorted triangles",
        expected: Expected::FewerThan("(a) KB"),
    },
    ImageClaim {
        statement: "sorting does not change the image of a technique without hazards",
        variant: "K⁺B-Array, sorted",
        expected: Expected::Equal,
    },
];
