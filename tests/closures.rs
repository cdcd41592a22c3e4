//! The closures of the language in every target language.

use fragbuf::load::Description;
use fragbuf::{Form, Registry, Request, TARGETS, Target, generate};

use crate::cases::{checked, text};
use crate::validators::validate;

const GOOD: [&str; 3] = [
    include_str!("../dsl/syntax/tests/good/inclusive_ranges.fragbuf"),
    include_str!("../dsl/syntax/tests/good/powers.fragbuf"),
    include_str!("../dsl/syntax/tests/good/methods_f32.fragbuf"),
];

/// Inserts a constraint that calls the helpers, which are removed otherwise.
fn with_calls(source: &str) -> Description {
    let calls = [
        ("fn unsigned(", "(unsigned(u, 3, 9) + signed(u, -1) as u32) as f32"),
        ("fn numbers(", "numbers(f.depth, 2.0) + vectors(vec3(f.depth, 0.5, 1.0), f.depth).x"),
        ("fn sizes(", "sizes(f.depth, 0.5) + powers(f.depth, 0.5) + parts(f.depth, 0.5) + hyperbolic(f.depth)"),
    ];
    let (_, call) = calls.into_iter().find(|(helper, _)| source.contains(helper)).unwrap();
    let body = source.trim_end().strip_suffix('}').unwrap();
    let body = body.replacen(" {\n", " from ab_ll {\n", 1);
    text(&format!("{body}    where |f, u| {call} > f.depth;\n}}\n"))
}

/// Loops over inclusive ranges and methods with edge cases are valid in every target language.
#[test]
fn closures_are_valid_in_every_language() {
    for source in GOOD {
        let variant = checked(&with_calls(source), &[]).unwrap_or_else(|errors| panic!("{errors}"));
        let targets: Vec<&'static Target> = TARGETS.iter().collect();
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"));
        assert!(generation.unsupported.len() < TARGETS.len());
        validate(generation.files.iter());
    }
}
