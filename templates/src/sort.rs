//! Axis `sort`: how the kept fragments are sorted by depth before they are resolved.

use crate::vocabulary::{Capability, Edit, Implementation, Parameter, Row, Split};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("sort/none")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::StableSort, Capability::OneResolve],
            ..Row::new("sort", "none", "not at all: in the order of the storage", "")
        },
        Row {
            template: Some(template!("sort/walk")),
            provides: vec![Capability::StableSort, Capability::OneResolve],
            ..Row::new(
                "sort",
                "walk",
                "not at all: each fragment is read from the storage when the effect asks for it, without a copy",
                "",
            )
        },
        Row {
            template: Some(template!("sort/insertion")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::Sorted, Capability::StableSort, Capability::OneResolve],
            ..Row::new("sort", "insertion", "by insertion while the fragments are read", "K15 §3.3")
        },
        Row {
            template: Some(template!("sort/shell")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::Sorted, Capability::OneResolve],
            ..Row::new("sort", "shell", "at the end, over decreasing distances", "Shell 1959; Knuth 1973; K15 §3.3")
        },
        Row {
            template: Some(template!("sort/hybrid")),
            calls: vec!["counters"],
            parameters: vec![layers(), insertion_most()],
            provides: vec![Capability::Sorted, Capability::OneResolve],
            ..Row::new("sort", "hybrid", "by insertion for few fragments, by Shell sort for many", "K15 §3.3")
        },
        Row {
            template: Some(template!("sort/bitonic")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::Sorted, Capability::OneResolve],
            ..Row::new("sort", "bitonic", "at the end, by a network that depends only on the count", "Batcher 1968")
        },
        Row {
            template: Some(template!("sort/lplus")),
            parameters: vec![Parameter::number(
                "batch",
                "LPLUS_BATCH",
                "32",
                (1, 4096),
                "fragments that are sorted each time the pixel is read",
            )],
            provides: vec![Capability::Sorted, Capability::OneResolve],
            ..Row::new(
                "sort",
                "lplus",
                "in batches, reading the pixel again for each: no array for all fragments, and none is dropped",
                "K15 §4.4, Alg. 4, corrected",
            )
        },
        Row {
            template: Some(template!("sort/backwards_memory")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::Sorted],
            edits: vec![Edit::Split(Split {
                name: "resolve".to_owned(),
                // Arrays of 8, 16, 32, … below the length of the parameter, and last one of that length.
                copies: "log2_ceil(ceil_div(LAYERS, 8)) + 1".into(),
                constants: vec![
                    ("LAYERS".to_owned(), "min(8 * pow2(copy), LAYERS)".into()),
                    // Each copy serves the pixels that overflow the previous array; the last serves all others.
                    ("CLASS_ABOVE".to_owned(), "(copy > 0) * 4 * pow2(copy)".into()),
                    ("CLASS_MOST".to_owned(), "max(8 * pow2(copy), (copy + 1 == copies) * 4294967295)".into()),
                ],
                // Every pass reads every pixel, so only the last counts losses.
                before_last: vec![Implementation::of("counters", "none")],
            })],
            ..Row::new(
                "sort",
                "backwards_memory",
                "by insertion, in one resolve pass per class of array lengths",
                "Knowles et al. 2013; K15 §3.3",
            )
        },
        Row {
            template: Some(template!("sort/block")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::Sorted, Capability::OneResolve],
            ..Row::new(
                "sort",
                "block",
                "in blocks of eight in registers, merged as they are read",
                "Knowles et al. 2014",
            )
        },
        Row {
            template: Some(template!("sort/odd_even")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            provides: vec![Capability::Sorted, Capability::OneResolve],
            ..Row::new(
                "sort",
                "odd_even",
                "at the end, by a network with fewer comparisons than `bitonic`",
                "Batcher 1968; Knuth 1973, Algorithm M",
            )
        },
    ]
}

fn insertion_most() -> Parameter {
    Parameter::number(
        "insertion",
        "INSERTION_MOST",
        "16",
        (0, 4096),
        "the greatest number of fragments that is sorted by insertion",
    )
}

fn layers() -> Parameter {
    Parameter::number(
        "layers",
        "LAYERS",
        "capacity",
        (1, 4096),
        "the limit of fragments in the resolve pass; the farthest beyond it are dropped and counted",
    )
}
