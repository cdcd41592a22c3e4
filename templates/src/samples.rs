//! Axis `samples`: how many samples a pixel has, and what is kept of a fragment that covers some of them.

use crate::vocabulary::{Capability, Carried, Coverage, Edit, Fact, Parameter, Row, Samples, Takes};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("samples/one")),
            calls: vec!["sort", "resolve"],
            offers: vec![Fact::OneSample],
            ..Row::new("samples", "one", "one: a fragment is the whole pixel", "")
        },
        Row {
            template: Some(template!("samples/coverage")),
            calls: vec!["sort", "resolve"],
            carries: vec![Carried { name: "coverage".into(), built_in: "sample_mask".into() }],
            parameters: vec![Parameter {
                name: "count".into(),
                constant: "SAMPLES".into(),
                takes: Takes::PowerOfTwo,
                default: "4".into(),
                range: (2, 8),
                summary: "samples of a pixel; every device has 4, some 2 and 8, the CPU device all".into(),
            }],
            needs: vec![Capability::Coverage],
            edits: vec![Edit::Samples(Samples {
                count: "SAMPLES".into(),
                mask: "pow2(SAMPLES) - 1".into(),
                coverage: Coverage::PerSample,
            })],
            ..Row::new(
                "samples",
                "coverage",
                "several: every fragment carries which it covers, and the effect runs once for each",
                "K15 §5.3; Myers & Bavoil 2007",
            )
        },
    ]
}
