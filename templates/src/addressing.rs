//! Axis `addressing`: how pixels map to memory. Rows that pad the frame define the symbol `pixels` of formulas; it
//! equals the template's `pixel_count()`.

use crate::vocabulary::{Definition, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row { template: Some(template!("addressing/linear")), ..Row::new("addressing", "linear", "row-major", "") },
        Row {
            template: Some(template!("addressing/tiled")),
            defines: pixels("ceil_div(width, 2) * ceil_div(height, 8) * 16"),
            ..Row::new(
                "addressing",
                "tiled",
                "in tiles of 2 × 8 pixels; columns and rows are padded to whole tiles",
                "",
            )
        },
        Row {
            template: Some(template!("addressing/morton")),
            defines: pixels("ceil_div(width, 8) * ceil_div(height, 8) * 64"),
            ..Row::new(
                "addressing",
                "morton",
                "along a Morton curve in blocks of 8 × 8 pixels; columns and rows are padded to whole blocks",
                "Morton 1966",
            )
        },
    ]
}

fn pixels(value: &'static str) -> Vec<Definition> {
    vec![Definition { symbol: "pixels".into(), value: value.into() }]
}
