//! Axis `addressing`: where a pixel's words lie in memory.

use crate::vocabulary::Row;

pub(crate) fn rows() -> Vec<Row> {
    vec![Row {
        template: Some(template!("addressing/linear")),
        ..Row::new("addressing", "linear", "row after row", "")
    }]
}
