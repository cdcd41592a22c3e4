//! The techniques of the papers as points on the axes. An axis that is not listed has the default of the storage, or
//! of the axis; `a else b` uses `b` on targets that do not support `a`.

mod peeling;

use crate::vocabulary::{KeepDefault, Technique};

pub(crate) fn techniques() -> Vec<Technique> {
    [first(), peeling::techniques(), further()].concat()
}

/// Buffers that most programs start from.
fn first() -> Vec<Technique> {
    vec![
        Technique {
            key: "kb".to_owned(),
            title: "KB",
            paper: "B06 §3; Bavoil et al. 2007",
            summary: "the k nearest by unsynchronised read-modify-write of a sorted array, with its hazards",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "sorted_array"), ("sync", "none"), ("sort", "walk")],
        },
        Technique {
            key: "kb_ps".to_owned(),
            title: "KB-PS",
            paper: "Salvi 2013 (pixel synchronization); K15 §2",
            summary: "the k nearest by sorted insertion inside an interlock or a lock",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "sorted_array"),
                ("sync", "interlock else spin_lock"),
                ("cull", "early"),
                ("sort", "walk"),
            ],
        },
        Technique {
            key: "kplus_array".to_owned(),
            title: "K⁺B-Array",
            paper: "K15 §3.2",
            summary: "the k best by a criterion, in an array with the worst entry at slot 0",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "max_array"), ("sync", "spin_lock"), ("cull", "early"), ("sort", "insertion")],
        },
        Technique {
            key: "kplus_heap".to_owned(),
            title: "K⁺B-Heap",
            paper: "K15 §3.2",
            summary: "the k best by a criterion, in a heap with the worst entry at slot 0",
            keep: KeepDefault::Best(32),
            choices: vec![("storage", "max_heap"), ("sync", "spin_lock"), ("cull", "early"), ("sort", "insertion")],
        },
        Technique {
            key: "mdt32_coplanar".to_owned(),
            title: "MDT with equal depths",
            paper: "after Liu et al. 2010; K15 §2",
            summary: "the k best without a lock, equal depths included; the same on every target, including browsers",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "cascade"), ("sync", "slot_counter"), ("cull", "early"), ("sort", "walk")],
        },
        Technique {
            key: "ab_array".to_owned(),
            title: "AB_Array (FreePipe, FAB)",
            paper: "Liu et al. 2010; K15 §2",
            summary: "every fragment, in an array per pixel, until the array is full",
            keep: KeepDefault::All,
            choices: vec![("storage", "fixed_array"), ("sync", "slot_counter"), ("sort", "hybrid")],
        },
        Technique {
            key: "ab_ll".to_owned(),
            title: "AB_LL",
            paper: "Yang et al. 2010; K15 §2",
            summary: "every fragment, in a linked list per pixel",
            keep: KeepDefault::All,
            choices: vec![("storage", "linked_list"), ("sync", "slot_counter"), ("sort", "hybrid")],
        },
        Technique {
            key: "ab_sb".to_owned(),
            title: "AB_SB (S-buffer)",
            paper: "Vasilakis & Fudos 2012; K15 §4.2",
            summary: "every fragment, in a region of exactly the required size per pixel",
            keep: KeepDefault::All,
            choices: vec![("storage", "exact_regions"), ("sync", "slot_counter"), ("sort", "hybrid")],
        },
        Technique {
            key: "kb_ab_array".to_owned(),
            title: "KB-AB_Array",
            paper: "K15 §2",
            summary: "the k best of all fragments in an array per pixel, selected in the resolve pass",
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
            summary: "the k best of all fragments in a linked list per pixel, selected in the resolve pass",
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
            summary: "the k best of all fragments in exact regions, selected in the resolve pass",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "exact_regions"),
                ("sync", "slot_counter"),
                ("select", "on_resolve"),
                ("sort", "insertion"),
            ],
        },
        Technique {
            key: "kb_mdt32".to_owned(),
            title: "KB-MDT₃₂",
            paper: "Liu et al. 2010; K15 §2",
            summary: "the k nearest distinct depths by atomic minima, payloads in a second pass; drops equal depths",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "distinct_cascade"),
                ("sync", "slot_counter"),
                ("cull", "early"),
                ("ties", "unordered"),
                ("sort", "walk"),
            ],
        },
        Technique {
            key: "kb_mdt64".to_owned(),
            title: "KB-MDT₆₄",
            paper: "K15 §2; Liu et al. 2010",
            summary: "the k nearest by 64-bit atomic minima of depth and colour, equal depths included, in one pass",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "wide_cascade"), ("sync", "slot_counter"), ("cull", "early"), ("sort", "walk")],
        },
        Technique {
            key: "kplus_array_revised".to_owned(),
            title: "K⁺B-Array-R",
            paper: "K15 §3.2.1, Alg. 2, corrected",
            summary: "the k best by a criterion, the worst at slot 0; the first k-1 are stored without the lock",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "revised_array"),
                ("sync", "spin_lock"),
                ("cull", "early"),
                ("sort", "insertion"),
            ],
        },
        Technique {
            key: "kb_ll".to_owned(),
            title: "KB-LL",
            paper: "Yu et al. 2012; K15 §2",
            summary: "the k nearest in a list that compare-exchange keeps sorted",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "ordered_list"), ("sync", "slot_counter"), ("sort", "walk")],
        },
        Technique {
            key: "depth_partition".to_owned(),
            title: "Depth partitioning",
            paper: "B06 §4.2",
            summary: "the nearest fragment in each of k equal ranges of depth",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "depth_ranges"),
                ("sync", "interlock else spin_lock"),
                ("cull", "none"),
                ("sort", "none"),
            ],
        },
        Technique {
            key: "kplus_ab_sb".to_owned(),
            title: "K⁺B-AB_SB",
            paper: "K15 §4.1, Alg. 3, corrected",
            summary: "the k best by a criterion in exact regions of min(f, k) slots; a lock only if f > k",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "bounded_regions"),
                ("sync", "spin_lock"),
                ("cull", "early"),
                ("sort", "insertion"),
            ],
        },
        Technique {
            key: "unified".to_owned(),
            title: "unified framework",
            paper: "K15 §4.3",
            summary: "a Z-buffer, a k-buffer or an A-buffer: every frame takes the k that a memory budget and a hit ratio give",
            keep: KeepDefault::Best(64),
            choices: vec![
                ("storage", "bounded_regions"),
                ("sync", "spin_lock"),
                ("cull", "early"),
                ("allocation", "predicted_exact"),
                ("sort", "hybrid"),
            ],
        },
    ]
}

/// Buffers of other structure or for other hardware.
fn further() -> Vec<Technique> {
    vec![
        Technique {
            key: "ab_ll_paged".to_owned(),
            title: "AB_LL-Paged",
            paper: "after Crassin 2010",
            summary: "every fragment, in a list of pages per pixel",
            keep: KeepDefault::All,
            choices: vec![("storage", "paged_list"), ("sync", "slot_counter"), ("sort", "hybrid")],
        },
        Technique {
            key: "ab_ll_bun".to_owned(),
            title: "AB_LL-BUN (BUN-LL)",
            paper: "D13 §3.1.4; K15 §2",
            summary: "every fragment, in a linked list per depth bucket of its pixel",
            keep: KeepDefault::All,
            choices: vec![("storage", "bucket_lists"), ("sync", "slot_counter"), ("sort", "insertion")],
        },
        Technique {
            key: "kb_stream".to_owned(),
            title: "KB as a stream",
            paper: "B06 §3, §4.3; Callahan et al. 2005",
            summary: "every fragment composited in order through k entries, if none arrives more than k positions late",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "stream_array"),
                ("sync", "interlock else spin_lock"),
                ("sort", "none"),
                ("resolve", "stream"),
            ],
        },
        Technique {
            key: "kb_mha".to_owned(),
            title: "KB-MHA",
            paper: "after Zhang 2014, internals ours; K15 §2",
            summary: "the k nearest by unsynchronised fragments that detect and repair most races",
            keep: KeepDefault::Best(8),
            choices: vec![("storage", "checksummed_array"), ("sync", "none"), ("sort", "insertion")],
        },
        Technique {
            key: "z_buffer".to_owned(),
            title: "Z-buffer",
            paper: "Catmull 1974; K15 §4.3",
            summary: "the nearest by the depth test, with its words in render targets: one draw, no atomic operation",
            keep: KeepDefault::Best(1),
            choices: vec![
                ("storage", "depth_tested"),
                ("sync", "fixed_function"),
                ("ties", "unordered"),
                ("sort", "none"),
            ],
        },
        Technique {
            key: "kb_sr".to_owned(),
            title: "KB-SR (stencil routing)",
            paper: "Myers & Bavoil 2007; K15 §2",
            summary: "the first k, each in a sample of a multisampled pixel: one draw, no lock; not exact at edges",
            keep: KeepDefault::Best(4),
            choices: vec![
                ("storage", "stencil_routed"),
                ("sync", "fixed_function"),
                ("ties", "unordered"),
                ("sort", "insertion"),
            ],
        },
        Technique {
            key: "kb_multi".to_owned(),
            title: "KB-Multi",
            paper: "Liu et al. 2009; K15 §2",
            summary: "the k nearest distinct depths without a lock: drawn again until a pass changes nothing",
            keep: KeepDefault::Best(8),
            choices: vec![
                ("storage", "multipass_array"),
                ("sync", "none"),
                ("ties", "unordered"),
                ("sort", "insertion"),
            ],
        },
    ]
}
