//! Templates that any template may call. Functions that no template calls are not linked.

use crate::vocabulary::Template;

pub(crate) const TEMPLATES: [Template; 18] = [
    template!("shared/markers"),
    template!("shared/prologue"),
    template!("shared/edges"),
    template!("shared/neighbours"),
    template!("shared/bounded_walk"),
    template!("shared/sentinels"),
    template!("shared/counter_names"),
    template!("shared/encoding"),
    template!("shared/halves"),
    template!("shared/layers"),
    template!("shared/accumulated"),
    template!("shared/no_copies"),
    template!("shared/depth_buckets"),
    template!("shared/id_pairs"),
    template!("shared/gap_sort"),
    template!("shared/stream"),
    template!("shared/merging"),
    template!("shared/workgroup_scan"),
];
