//! Axis `sort`: how the kept fragments are put in the order of depth before they are resolved.

use crate::vocabulary::{Edit, Fact, Parameter, Role, Row, Split};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("sort/none")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::StableSort, Fact::OneResolve],
            ..Row::new("sort", "none", "not at all: as the storage gives them", "")
        },
        Row {
            template: Some(template!("sort/insertion")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted, Fact::StableSort, Fact::OneResolve],
            ..Row::new("sort", "insertion", "each into its place as it is read", "K15 §3.3")
        },
        Row {
            template: Some(template!("sort/shell")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted, Fact::OneResolve],
            ..Row::new("sort", "shell", "all at once, over ever shorter distances", "Shell 1959; Knuth 1973; K15 §3.3")
        },
        Row {
            template: Some(template!("sort/hybrid")),
            calls: vec!["counters"],
            parameters: vec![layers(), insertion_most()],
            offers: vec![Fact::Sorted, Fact::OneResolve],
            ..Row::new("sort", "hybrid", "by insertion for few, by Shell sort for many", "K15 §3.3")
        },
        Row {
            template: Some(template!("sort/bitonic")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted, Fact::OneResolve],
            ..Row::new("sort", "bitonic", "all at once, by a network that depends on the count alone", "Batcher 1968")
        },
        Row {
            template: Some(template!("sort/lplus")),
            parameters: vec![Parameter::number(
                "batch",
                "LPLUS_BATCH",
                "32",
                (1, 4096),
                "fragments that are ordered each time that the pixel is read",
            )],
            offers: vec![Fact::Sorted, Fact::OneResolve],
            ..Row::new(
                "sort",
                "lplus",
                "in batches, the pixel read again for each: no array for all, and none is left out",
                "K15 §4.4, Alg. 4, mended",
            )
        },
        Row {
            template: Some(template!("sort/backwards_memory")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted],
            edits: vec![Edit::Split(Split {
                anchor: "resolve".to_owned(),
                // Arrays of 8, of twice that, and so on below the parameter's own length, and of that at last.
                copies: "log2_ceil(ceil_div(LAYERS, 8)) + 1".into(),
                constants: vec![
                    ("LAYERS".to_owned(), "min(8 * pow2(copy), LAYERS)".into()),
                    // Each serves the pixels of more fragments than the array before holds, the last all others.
                    ("CLASS_ABOVE".to_owned(), "(copy > 0) * 4 * pow2(copy)".into()),
                    ("CLASS_MOST".to_owned(), "max(8 * pow2(copy), (copy + 1 == copies) * 4294967295)".into()),
                ],
                // Every pass reads every pixel: what is lost there is counted by the last alone.
                before_last: vec![Role::of("counters", "none")],
            })],
            ..Row::new(
                "sort",
                "backwards_memory",
                "by insertion, in one resolve pass for each of few lengths of its array",
                "Knowles et al. 2013; K15 §3.3",
            )
        },
        Row {
            template: Some(template!("sort/block")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted, Fact::OneResolve],
            ..Row::new(
                "sort",
                "block",
                "in blocks of eight that registers hold, merged as they are asked for",
                "Knowles et al. 2014",
            )
        },
        Row {
            template: Some(template!("sort/odd_even")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted, Fact::OneResolve],
            ..Row::new(
                "sort",
                "odd_even",
                "all at once, by a network of fewer comparisons than `bitonic`",
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
        "the most fragments of a pixel that are sorted by insertion",
    )
}

fn layers() -> Parameter {
    Parameter::number(
        "layers",
        "LAYERS",
        "capacity",
        (1, 4096),
        "fragments that the resolve pass can hold; the farthest beyond are left out, and counted",
    )
}
