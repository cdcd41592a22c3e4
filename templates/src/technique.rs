//! The techniques of the papers as points on the axes. A choice that is not named is the default of the storage, or of
//! the axis; `a else b` takes `b` on targets that cannot express `a`.

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
            key: "kb_ps".to_owned(),
            title: "KB-PS",
            paper: "Salvi 2013 (pixel synchronization); K15 §2",
            summary: "the k nearest by sorted insertion inside an interlock, or a lock",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "sorted_array"),
                ("sync", "interlock else spin_lock"),
                ("cull", "early"),
                ("sort", "none"),
            ],
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
            key: "kplus_heap".to_owned(),
            title: "K⁺B-Heap",
            paper: "K15 §3.2",
            summary: "the k best by a criterion, in a heap whose worst entry stands at slot 0",
            keep: KeepDefault::Best(32),
            choices: vec![("storage", "max_heap"), ("sync", "spin_lock"), ("cull", "early"), ("sort", "insertion")],
        },
        Technique {
            key: "mdt32_coplanar".to_owned(),
            title: "MDT with equal depths",
            paper: "after Liu et al. 2010; K15 §2",
            summary: "the k best without a lock, equal depths included: the same on every target, browsers too",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "cascade"), ("sync", "slot_counter"), ("cull", "early"), ("sort", "none")],
        },
        Technique {
            key: "ab_array".to_owned(),
            title: "AB_Array (FreePipe, FAB)",
            paper: "Liu et al. 2010; K15 §2",
            summary: "every fragment, in an array per pixel until it is full",
            keep: KeepDefault::All,
            choices: vec![("storage", "fixed_array"), ("sync", "slot_counter"), ("sort", "insertion")],
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
        Technique {
            key: "kb_ab_array".to_owned(),
            title: "KB-AB_Array",
            paper: "K15 §2",
            summary: "the k best of all fragments in an array per pixel, chosen on resolve",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "fixed_array"),
                ("sync", "slot_counter"),
                ("select", "on_resolve"),
                ("sort", "insertion"),
            ],
        },
        Technique {
            key: "kb_ab_ll".to_owned(),
            title: "KB-AB_LL",
            paper: "K15 §2; Yu et al. 2012",
            summary: "the k best of all fragments in a linked list per pixel, chosen on resolve",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "linked_list"),
                ("sync", "slot_counter"),
                ("select", "on_resolve"),
                ("sort", "insertion"),
            ],
        },
        Technique {
            key: "kb_ab_sb".to_owned(),
            title: "KB-AB_SB",
            paper: "K15 §2",
            summary: "the k best of all fragments in exact regions, chosen on resolve",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "exact_regions"),
                ("sync", "slot_counter"),
                ("select", "on_resolve"),
                ("sort", "insertion"),
            ],
        },
    ]
}
