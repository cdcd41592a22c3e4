//! D13, Fig. 4: what each kind of peeling extracts, as images: F2B the next depth, DUAL the front and the back, BUN the front of each bucket.
//! The paper's model is a duck.

use fragbuf_cpu::FragmentOrder;

use crate::cli::figure::experiment::{
    Expected, Experiment, ImageClaim, Images, Kind, Series, Shown, Triangles, Variant,
};

pub(super) const ROW: Experiment = Experiment {
    name: "d13-fig-4",
    paper: "D13, Fig. 4",
    title: "the layers that peeling extracts",
    kind: Kind::Images(Images {
        scene: ["builtin:marbles", "builtin:marbles,n=6"],
        camera: "auto",
        side: 220,
        order: FragmentOrder::Submission,
        variants: &VARIANTS,
        shown: Shown::Images,
        claims: &CLAIMS,
    }),
};

const fn layer(label: &'static str, technique: &'static str, set: &'static [(&'static str, &'static str)]) -> Variant {
    Variant { series: Series { label, technique, set }, triangles: Triangles::AsModelled }
}

const fn number(number: &'static str) -> [(&'static str, &'static str); 2] {
    [("resolve", "layer"), ("resolve.number", number)]
}

const N0: [(&str, &str); 2] = number("0");
const N1: [(&str, &str); 2] = number("1");
const N2: [(&str, &str); 2] = number("2");
/// The fronts of four buckets: the first iteration finds the layers, and the second stores eight slots.
const N8: [(&str, &str); 2] = number("8");
const N10: [(&str, &str); 2] = number("10");
const N12: [(&str, &str); 2] = number("12");
const N14: [(&str, &str); 2] = number("14");

const VARIANTS: [Variant; 12] = [
    layer("A-buffer", "ab_sb", &[]),
    layer("F2B, iteration 1", "f2b", &N0),
    layer("F2B, iteration 2", "f2b", &N1),
    layer("F2B, iteration 3", "f2b", &N2),
    layer("A-buffer, fragment 3", "ab_sb", &N2),
    layer("DUAL, iteration 1, front", "dual", &N0),
    layer("DUAL, iteration 1, back", "dual", &N1),
    layer("DUAL, iteration 2, front", "dual", &N2),
    layer("BUN, bucket 1", "bun", &N8),
    layer("BUN, bucket 2", "bun", &N10),
    layer("BUN, bucket 3", "bun", &N12),
    layer("BUN, bucket 4", "bun", &N14),
];

const CLAIMS: [ImageClaim; 3] = [
    ImageClaim {
        statement: "an iteration of F2B extracts the next depth",
        variant: "F2B, iteration 3",
        expected: Expected::Same("A-buffer, fragment 3"),
    },
    ImageClaim {
        statement: "DUAL peels from the front as F2B does",
        variant: "DUAL, iteration 1, front",
        expected: Expected::Same("F2B, iteration 1"),
    },
    ImageClaim {
        statement: "the first bucket of BUN begins at the nearest fragment",
        variant: "BUN, bucket 1",
        expected: Expected::Same("F2B, iteration 1"),
    },
];
