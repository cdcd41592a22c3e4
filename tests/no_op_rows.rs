//! A row that does nothing changes no source: a new axis, or a new call in the skeletons, changes no snapshot but its own.

use fragbuf::vocabulary::{Axis, Row, Template};
use fragbuf::{Form, Registry, Request, TARGETS, Target, check, generate};
use fragbuf_model::{Draft, SourceSpan};

/// Generates every technique for every target. Returns key, path and bytes of each file.
fn files(registry: &Registry) -> Vec<(String, String, Vec<u8>)> {
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let mut files = Vec::new();
    for technique in registry.techniques() {
        let draft = Draft::from_technique(&technique.key, &SourceSpan::new(technique.key.as_str(), 1, 1));
        let variant = check(&draft, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let generation = generate(&variant, &request, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        files.extend(generation.files.into_iter().map(|file| (technique.key.clone(), file.path, file.bytes)));
    }
    files
}

fn assert_same_files(registry: &Registry) {
    let (ours, theirs) = (files(&Registry::builtin()), files(registry));
    assert!(ours.len() > 100 && ours.len() == theirs.len());
    for (ours, theirs) in ours.iter().zip(&theirs) {
        let text = |file: &(String, String, Vec<u8>)| String::from_utf8_lossy(&file.2).into_owned();
        assert!(ours == theirs, "{} {}:\n{}\n----\n{}", ours.0, ours.1, text(ours), text(theirs));
    }
}

fn with_axis(row: Row) -> Registry {
    let axis = Axis { key: "hook", summary: "an axis of a test", default: Some("none"), chosen: true };
    Registry::builtin().with_axis(axis, "overflow").with(row)
}

#[test]
fn an_axis_whose_default_does_nothing_changes_no_source() {
    assert_same_files(&with_axis(Row::new("hook", "none", "", "")));
}

#[test]
fn a_call_of_an_empty_function_changes_no_source() {
    let template = Template::new("hook/none.wgsl", "// Nothing.\n\nfn hook_fragment(fragment: Fragment) {}\n");
    let mut registry = with_axis(Row { template: Some(template), ..Row::new("hook", "none", "", "") });
    let mut called = 0;
    for row in Registry::builtin().rows_of("pass") {
        let Some(template) = &row.template else { continue };
        let asks = "if !fragment_enters_counted(";
        if template.source.contains(asks) {
            let lines = template.source.lines().map(|line| match line.split_once(asks) {
                Some((indentation, _)) => format!("{indentation}hook_fragment(fragment);\n{line}\n"),
                None => format!("{line}\n"),
            });
            let text: String = lines.collect();
            let calls = row.calls.iter().copied().chain(["hook"]).collect();
            let template = Some(Template::new(template.path.to_string(), text));
            registry = registry.with(Row { template, calls, ..row.clone() });
            called += 1;
        }
    }
    assert!(called > 3);
    assert_same_files(&registry);
}
