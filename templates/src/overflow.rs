//! Axis `overflow`: what becomes of a fragment that finds no place.

use crate::vocabulary::Row;

pub(crate) fn rows() -> Vec<Row> {
    vec![Row {
        template: Some(template!("overflow/drop")),
        calls: vec!["counters"],
        ..Row::new("overflow", "drop", "it is dropped, and counted", "")
    }]
}
