//! Axis `sort`: how the kept fragments are put in the order of depth before they are resolved.

use crate::vocabulary::{Fact, Parameter, Row, Takes};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("sort/none")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::StableSort],
            ..Row::new("sort", "none", "not at all: as the storage gives them", "")
        },
        Row {
            template: Some(template!("sort/insertion")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted, Fact::StableSort],
            ..Row::new("sort", "insertion", "each into its place as it is read", "K15 §3.3")
        },
        Row {
            template: Some(template!("sort/shell")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted],
            ..Row::new("sort", "shell", "all at once, over ever shorter distances", "Shell 1959; Knuth 1973; K15 §3.3")
        },
        Row {
            template: Some(template!("sort/hybrid")),
            calls: vec!["counters"],
            parameters: vec![layers(), insertion_most()],
            offers: vec![Fact::Sorted],
            ..Row::new("sort", "hybrid", "by insertion for few, by Shell sort for many", "K15 §3.3")
        },
        Row {
            template: Some(template!("sort/bitonic")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted],
            ..Row::new("sort", "bitonic", "all at once, by a network that depends on the count alone", "Batcher 1968")
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
