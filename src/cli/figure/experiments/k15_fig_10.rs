//! K15, Fig. 10: differences of k-buffer variants from the image of K⁺B-Array. The paper renders the hairball with k = 16. Here k is 8, because
//! KB-SR has at most 8 samples. KB-AB_Array with too few slots is left out, because the command enlarges its array. Fragments are interleaved by a seed on the CPU device; a GPU has races of its own.

use fragbuf_cpu::FragmentOrder;

use crate::cli::figure::experiment::{
    Expected, Experiment, ImageClaim, Images, Kind, Series, Shown, Triangles, Variant,
};

pub(super) const ROW: Experiment = Experiment {
    name: "k15-fig-10",
    paper: "K15, Fig. 10",
    title: "differences of k-buffer variants from K⁺B-Array, k = 8",
    kind: Kind::Images(Images {
        scene: ["builtin:hairball,strands=600", "builtin:hairball,strands=8"],
        camera: "auto",
        side: 220,
        order: FragmentOrder::Shuffled(1),
        variants: &VARIANTS,
        shown: Shown::Differences,
        claims: &CLAIMS,
    }),
};

const VARIANTS: [Variant; 7] = [
    variant("K⁺B-Array", "kplus_array", &[("k", "8")]),
    variant("KB-AB_LL", "kb_ab_ll", &[("k", "8")]),
    variant("KB", "kb", &[("k", "8")]),
    variant("KB-SR", "kb_sr", &[("k", "8")]),
    variant("KB-MDT₃₂", "kb_mdt32", &[("k", "8")]),
    variant("KB-LL, few tries", "kb_ll", &[("k", "8"), ("storage.retries", "1")]),
    variant("KB-MHA", "kb_mha", &[("k", "8")]),
];

const fn variant(
    label: &'static str,
    technique: &'static str,
    set: &'static [(&'static str, &'static str)],
) -> Variant {
    Variant { series: Series::new(label, technique, set), triangles: Triangles::AsModelled }
}

const CLAIMS: [ImageClaim; 5] = [
    ImageClaim {
        statement: "K⁺B-Array keeps what an A-buffer selects",
        variant: "KB-AB_LL",
        expected: Expected::Equal,
    },
    ImageClaim { statement: "KB shows hazards", variant: "KB", expected: Expected::Different },
    ImageClaim { statement: "KB-SR differs visibly", variant: "KB-SR", expected: Expected::Different },
    ImageClaim {
        statement: "KB-MDT₃₂ shows artefacts of its conversion of depths",
        variant: "KB-MDT₃₂",
        expected: Expected::Different,
    },
    ImageClaim {
        statement: "KB-LL with a limit of tries loses fragments",
        variant: "KB-LL, few tries",
        expected: Expected::Different,
    },
];
