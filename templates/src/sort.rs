//! Axis `sort`: how the kept fragments are put in the order of depth before they are resolved.

use crate::vocabulary::{Classes, Edit, Fact, Parameter, Role, Row, Takes};

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
            parameters: vec![Parameter {
                name: "batch".into(),
                constant: "LPLUS_BATCH".into(),
                takes: Takes::Number,
                default: "32".into(),
                range: (1, 4096),
                summary: "fragments that are ordered each time that the pixel is read".into(),
            }],
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
            edits: vec![Edit::Classes(Classes {
                anchor: "resolve".to_owned(),
                constant: "LAYERS".to_owned(),
                least: 8,
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
    ]
}

fn insertion_most() -> Parameter {
    Parameter {
        name: "insertion".into(),
        constant: "INSERTION_MOST".into(),
        takes: Takes::Number,
        default: "16".into(),
        range: (0, 4096),
        summary: "the most fragments of a pixel that are sorted by insertion".into(),
    }
}

fn layers() -> Parameter {
    Parameter {
        name: "layers".into(),
        constant: "LAYERS".into(),
        takes: Takes::Number,
        default: "capacity".into(),
        range: (1, 4096),
        summary: "fragments that the resolve pass can hold; the farthest beyond are left out, and counted".into(),
    }
}
