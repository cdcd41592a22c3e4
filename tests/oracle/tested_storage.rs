//! The registry with a storage that only tests have. The tests of hosts share this file.

use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, KeepDefault, Resource, Row, Step, Technique, Template};

/// Returns the registry with the storage and the technique `tested`: a storage with these resources and steps that keeps all
/// fragments in order. `passes`: the key and the source of each skeleton that the steps name.
pub fn registry(resources: Vec<Resource>, steps: Vec<Step>, passes: &[(&str, &str)]) -> Registry {
    let choices = vec![("storage", "tested"), ("sync", "as_it_comes")];
    let keep = KeepDefault::All;
    let technique = Technique { key: "tested".to_owned(), title: "", paper: "", summary: "", keep, choices };
    let provides = vec![Capability::KeepsAll, Capability::FixedFunction, Capability::Sorted];
    let storage = Row { resources, steps, provides, ..Row::new("storage", "tested", "", "") };
    let skeleton = |(key, source): &(&str, &str)| Row {
        template: Some(Template::new(format!("pass/{key}.wgsl"), (*source).to_owned())),
        calls: vec!["addressing"],
        ..Row::new("pass", key, "", "")
    };
    let registry = Registry::builtin().with(storage).with(Row::new("sync", "as_it_comes", "", ""));
    passes.iter().map(skeleton).fold(registry.with_technique(technique), Registry::with)
}

/// Returns the technique `tested`.
pub fn tested(registry: &Registry) -> Variant {
    let draft = Draft::from_technique("tested", &SourceSpan::new("tested", 1, 1));
    check(&draft, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}
