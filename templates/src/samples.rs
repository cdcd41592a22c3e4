//! Axis `samples`: how many samples a pixel has, and whether fragments store coverage.

use crate::vocabulary::{
    Capability, Coverage, Edit, Feature, ImplicitAttribute, Parameter, ParameterType, Row, Samples,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("samples/one")),
            calls: vec!["sort", "peeling", "resolve"],
            provides: vec![Capability::OneSample],
            ..Row::new("samples", "one", "one: a fragment covers the whole pixel", "")
        },
        Row {
            template: Some(template!("samples/coverage")),
            calls: vec!["sort", "resolve"],
            extra_words: vec![ImplicitAttribute { name: "coverage".into(), built_in: "sample_mask".into() }],
            parameters: vec![Parameter {
                name: "count".into(),
                constant: "SAMPLES".into(),
                kind: ParameterType::PowerOfTwo,
                default: "4".into(),
                range: (2, 8),
                is_retry_limit: false,
                summary: "samples per pixel; every device supports 4, some 2 and 8, the CPU device all".into(),
            }],
            needs: vec![Feature::Coverage],
            needs_if: vec![("SAMPLES != 4".into(), Feature::SampleCounts)],
            edits: vec![Edit::Samples(Samples {
                count: "SAMPLES".into(),
                mask: "pow2(SAMPLES) - 1".into(),
                coverage: Coverage::PerSample,
            })],
            ..Row::new(
                "samples",
                "coverage",
                "several: every fragment stores a coverage mask, and the effect runs once per sample",
                "K15 §5.3; Myers & Bavoil 2007",
            )
        },
    ]
}
