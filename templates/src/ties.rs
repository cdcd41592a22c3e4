//! Axis `ties`: which of two fragments with equal keys is better.

use crate::vocabulary::{Order, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            order: Some(Order::Payload),
            ..Row::new(
                "ties",
                "payload",
                "the one with lesser packed words: the result does not depend on any order",
                "",
            )
        },
        Row { order: Some(Order::Unordered), ..Row::new("ties", "unordered", "whichever came first", "") },
    ]
}
