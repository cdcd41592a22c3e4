//! The techniques of the papers as points on the axes. A choice that is not named is the default of the storage, or of
//! the axis.

use crate::vocabulary::{KeepDefault, Technique};

pub(crate) fn techniques() -> Vec<Technique> {
    vec![
        Technique {
            key: "kb".to_owned(),
            title: "KB",
            paper: "B06 §3; Bavoil et al. 2007",
            summary: "the k nearest by unsynchronised read-modify-write of a sorted array; hazards kept",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "sorted_array"), ("sync", "none"), ("sort", "none")],
        },
        Technique {
            key: "kplus_array".to_owned(),
            title: "K⁺B-Array",
            paper: "K15 §3.2",
            summary: "the k best by a criterion, in an array whose worst entry stands at slot 0",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "max_array"), ("sync", "spin_lock"), ("cull", "early"), ("sort", "insertion")],
        },
        Technique {
            key: "ab_ll".to_owned(),
            title: "AB_LL",
            paper: "Yang et al. 2010; K15 §2",
            summary: "every fragment, in a linked list per pixel",
            keep: KeepDefault::All,
            choices: vec![("storage", "linked_list"), ("sync", "slot_counter"), ("sort", "insertion")],
        },
        Technique {
            key: "ab_sb".to_owned(),
            title: "AB_SB (S-buffer)",
            paper: "Vasilakis & Fudos 2012; K15 §4.2",
            summary: "every fragment, in regions of exactly the size that each pixel needs",
            keep: KeepDefault::All,
            choices: vec![("storage", "exact_regions"), ("sync", "slot_counter"), ("sort", "insertion")],
        },
    ]
}
