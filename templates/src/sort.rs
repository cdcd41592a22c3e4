//! Axis `sort`: how the kept fragments are put in the order of depth before they are resolved.

use crate::vocabulary::{Fact, Parameter, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("sort/none")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            ..Row::new("sort", "none", "not at all: as the storage gives them", "")
        },
        Row {
            template: Some(template!("sort/insertion")),
            calls: vec!["counters"],
            parameters: vec![layers()],
            offers: vec![Fact::Sorted],
            ..Row::new("sort", "insertion", "each into its place as it is read", "K15 §3.3")
        },
    ]
}

fn layers() -> Parameter {
    Parameter {
        name: "layers",
        constant: "LAYERS",
        default: "capacity".into(),
        range: (1, 4096),
        summary: "fragments that the resolve pass can hold; the farthest beyond are left out, and counted",
    }
}
