//! The three front ends agree: file, builder and macro give equal drafts and the same errors for the same description, for
//! every preset and for seeded random descriptions, some of them with errors.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod description;

use std::collections::BTreeSet;

use description::{Description, Random};
use fragbuf_dsl::builder::{Buffer, Closure, Format, KeepCount, UniformType, value};
use fragbuf_dsl::{CapturedTokens, Diagnostics, Draft, Parsed, Registry, SourceSpan, closure, function, parse};
use proc_macro2::{TokenStream, TokenTree};

/// Returns code, message and help of each diagnostic; the spans differ between the front ends.
fn without_spans(diagnostics: &Diagnostics) -> BTreeSet<(String, String, String)> {
    diagnostics.iter().map(|found| (found.code.name.to_owned(), found.message.clone(), found.help.clone())).collect()
}

/// Returns the description that a program with this macro call parses at run time, and the compiler errors.
fn expand(source: &str) -> (Parsed, BTreeSet<String>) {
    let call: TokenStream = format!("[fragbuf_dsl]\n{source}").parse().unwrap();
    let expansion = fragbuf_expansion::fragment_buffer(call);
    let mut errors = BTreeSet::new();
    let mut captured = None;
    visit(&expansion, &mut |name, arguments| match name {
        "compile_error" => drop(errors.insert(strings(arguments).remove(0))),
        "new" if captured.is_none() && strings(arguments).len() == 3 => captured = Some(strings(arguments)),
        _ => {}
    });
    let parts: [&'static str; 3] =
        captured.unwrap().into_iter().map(|part| &*part.leak()).collect::<Vec<_>>().try_into().unwrap();
    (CapturedTokens::new(parts[0], parts[1], parts[2]).parse(), errors)
}

/// Visits every group with the identifier before it.
fn visit(tokens: &TokenStream, visitor: &mut impl FnMut(&str, &TokenStream)) {
    let mut before = String::new();
    for token in tokens.clone() {
        match token {
            TokenTree::Ident(name) => before = name.to_string(),
            TokenTree::Group(group) => {
                visitor(&before, &group.stream());
                visit(&group.stream(), visitor);
                before.clear();
            }
            _ => {}
        }
    }
}

fn strings(tokens: &TokenStream) -> Vec<String> {
    let literal = |token: TokenTree| syn::parse2::<syn::LitStr>(token.into()).ok().map(|literal| literal.value());
    tokens.clone().into_iter().filter_map(literal).collect()
}

/// Returns line and column of every part of a draft and of every line of its functions.
fn positions(draft: &Draft) -> Vec<(u32, u32)> {
    let functions = draft.helpers.iter().chain(&draft.constraints).chain(&draft.resolve);
    let functions = functions.chain(draft.keep.iter().filter_map(|keep| keep.criterion.as_ref()));
    let lines = functions.flat_map(|function| function.lines.iter().chain([&function.span]));
    let attributes = draft.attributes.iter().flat_map(|row| [&row.name.span, &row.format.span]);
    let choices = draft.choices.iter().flat_map(|choice| {
        choice.alternatives.iter().map(|alternative| &alternative.value.span).chain([&choice.axis.span])
    });
    let all = lines.chain(attributes).chain(choices).chain([&draft.name.span]);
    all.map(|span: &SourceSpan| (span.line, span.column)).collect()
}

fn agree(description: &Description) -> bool {
    let source = description.source();
    let file = parse(&source, "file");
    let built = description.builder().parse();
    assert_eq!(file.draft, built.draft, "{source}");
    assert_eq!(without_spans(&file.diagnostics), without_spans(&built.diagnostics), "{source}");

    let (expanded, errors) = expand(&source);
    assert_eq!(file.draft, expanded.draft, "{source}");
    assert_eq!(without_spans(&file.diagnostics), without_spans(&expanded.diagnostics), "{source}");
    // The description begins on the second line of the call.
    let below: Vec<_> =
        positions(&file.draft.clone().unwrap()).iter().map(|(line, column)| (line + 1, *column)).collect();
    assert_eq!(below, positions(&expanded.draft.unwrap()), "{source}");

    let registry = Registry::builtin();
    let diagnostics = file.check(&registry).err().unwrap_or_default();
    let first_line = |text: &str| text.lines().next().unwrap_or_default().to_owned();
    let found: BTreeSet<String> = errors.iter().map(|error| first_line(error)).collect();
    let expected: BTreeSet<String> = diagnostics
        .iter()
        .map(|diagnostic| first_line(&format!("[{}] {}", diagnostic.code.name, diagnostic.message)))
        .collect();
    assert_eq!(found, expected, "{source}");
    assert_eq!(
        without_spans(&diagnostics),
        without_spans(&description.builder().variant(&registry).err().unwrap_or_default()),
        "{source}"
    );
    diagnostics.is_empty()
}

#[test]
fn every_preset_is_the_same_in_every_front_end() {
    let registry = Registry::builtin();
    for technique in registry.techniques() {
        let mut description = Description::from(&technique.key);
        assert!(agree(&description), "{}", technique.key);
        // A preset does not change if its choices are written out.
        for (axis, value) in &technique.choices {
            description.choose(axis, value);
        }
        assert!(agree(&description), "{}", technique.key);
    }
}

#[test]
fn random_descriptions_are_the_same_in_every_front_end() {
    let registry = Registry::builtin();
    let (mut accepted, mut parsed, count) = (0, 0, 500);
    for seed in 0..count {
        let description = Description::random(&mut Random(seed), &registry);
        accepted += usize::from(agree(&description));
        parsed += usize::from(parse(&description.source(), "file").diagnostics.is_empty());
    }
    // The test must see descriptions with and without errors.
    assert!(accepted >= 25, "only {accepted} of {count} are variants");
    assert!((100..450).contains(&parsed), "{parsed} of {count} parse without an error");
}

/// Slips in closures and in the payload have the same message and help in every front end.
#[test]
fn slips_are_the_same_in_every_front_end() {
    let registry = Registry::builtin();
    for closure in [
        "|f| f.depth = 0.5",
        "|f| not (f.depth < 0.5)",
        "|f| not f.depth < 0.5",
        "|f| f.depth =< 0.5",
        "|f| f.id == -1",
        "|u, f| f.depth < u.cut",
        "|f| { let mut c = f.color; c.xyz += f.color.xyz(); c.x < 0.5 }",
        "|f| { const NEAR: f32 = 0.5; f.depth < NEAR }",
        "|f| { let mut sum = 0.0; for i in range(4) { sum += f.depth; } sum < 0.5 }",
    ] {
        let source = format!(
            "buffer B from kplus_array {{ fragment {{ color: rgba8, depth: f32, id: u32 }} uniform {{ cut: f32 }} where {closure}; }}"
        );
        let built = Buffer::named("B")
            .from("kplus_array")
            .attribute("color", Format::Rgba8)
            .attribute("depth", Format::F32)
            .attribute("id", Format::U32)
            .uniform("cut", UniformType::F32)
            .constraint(Closure::text(closure));
        let file = parse(&source, "file").diagnostics;
        assert_eq!(file.iter().count(), 1, "{closure}: {file}");
        assert_eq!(without_spans(&file), without_spans(&built.parse().diagnostics), "{closure}");
        assert_eq!(without_spans(&file), without_spans(&expand(&source).0.diagnostics), "{closure}");
    }
    for (source, built) in [
        (
            "buffer B from ab_ll { fragment { colour: rgba8, depth: f32 } }",
            Buffer::named("B").from("ab_ll").attribute("colour", Format::Rgba8).attribute("depth", Format::F32),
        ),
        ("buffer B from kb_sr { keep 32; }", Buffer::named("B").from("kb_sr").keep(32)),
        ("buffer B from z_buffer { keep 4; }", Buffer::named("B").from("z_buffer").keep(4)),
    ] {
        let file = parse(source, "file").check(&registry).unwrap_err();
        let built = built.variant(&registry).unwrap_err();
        assert_eq!(without_spans(&file), without_spans(&built), "{source}");
        assert_eq!(without_spans(&file), without_spans(&expand(source).0.check(&registry).unwrap_err()), "{source}");
        // The error of a builder is at the call that causes it, not at the technique.
        assert!(built.iter().all(|error| error.labels.iter().any(|label| label.span != error.span)), "{built}");
    }
    let several = Buffer::named("B").from("kplus_array").choose("sync", "interlock, spin_lock").draft().unwrap_err();
    assert!(several.to_string().contains("`value(\"interlock\").or_else(\"spin_lock\")`"), "{several}");
}

#[test]
fn a_mistake_in_a_captured_closure_has_the_span_of_the_token() {
    let diagnostics = Buffer::named("Glass")
        .from("kplus_array")
        .attribute("depth", Format::F32)
        .keep_least(4, closure!(|f| f.depth - f.deph))
        .constraint(closure!(|f| {
            let near = f.depth + 1;
            near > 0.5
        }))
        .helper(function!(
            fn half(x: f32) -> f32 {
                y
            }
        ))
        .draft()
        .unwrap_err();
    let source = include_str!("front_ends.rs");
    let found: Vec<_> = diagnostics
        .iter()
        .map(|diagnostic| {
            let span = &diagnostic.span;
            assert!(span.file.ends_with("tests/front_ends.rs"), "{span}");
            let line = source.lines().nth(span.line as usize - 1).unwrap();
            let at: String = line.chars().skip(span.column as usize - 1).take(span.length as usize).collect();
            (diagnostic.code.name, at)
        })
        .collect();
    let expected = [("unknown-field", "deph"), ("type-mismatch", "1"), ("unknown-name", "y")];
    assert_eq!(found, expected.map(|(code, at)| (code, at.to_owned())), "{diagnostics}");
}

#[test]
fn a_mistake_in_a_name_has_the_span_of_the_call() {
    let diagnostics = Buffer::named("Glass")
        .from("kplus_array")
        .attribute("color", Format::Rgba8)
        .attribute("depth", Format::F32)
        .attribute("two words", Format::F32)
        .choose("sort", value("insertoin"))
        .choose("keep", "eight")
        .variant(&Registry::builtin())
        .unwrap_err();
    let source: Vec<&str> = include_str!("front_ends.rs").lines().collect();
    for (diagnostic, written) in diagnostics.iter().zip(["two words", "insertoin", "keep"]) {
        let line = source[diagnostic.span.line as usize - 1];
        assert!(line.contains(written), "{diagnostic}: {line}");
    }
    let codes: Vec<&str> = diagnostics.iter().map(|diagnostic| diagnostic.code.name).collect();
    assert_eq!(codes.iter().filter(|code| **code == "unexpected-token").count(), 2, "{diagnostics}");
    assert!(codes.contains(&"unknown-value"), "{diagnostics}");
}

fragbuf_dsl::fragment_buffer! {
    buffer Described from kplus_array {
        fragment { color: rgba8, depth: f32, normal: octahedral, uv: vec2, id: u32 }
        uniform { first: f32, eye: vec3, steps: u32, offset: i32, scale: vec2, tint: vec4 }
        keep 3 least |f, u| f.depth * u.first;
        where |f, u| f.id < u.steps;
        resolve |fragments, u| {
            let mut sum = u.tint;
            for f in fragments { sum += f.color * (1.0 - sum.w); }
            if fragments.is_empty() { Vec4::ZERO } else { sum + fragments[0].color * 0.0 }
        }
    }
}

/// The expected offsets were computed by hand from WGSL's rules: 0, 16, 28, 32, 40, 48.
#[test]
fn uniforms_are_laid_out_as_on_the_gpu() {
    use fragbuf_dsl::glam::{vec2, vec3, vec4};
    let uniforms = described::Uniforms {
        first: 1.0,
        eye: vec3(2.0, 3.0, 4.0),
        steps: 5,
        offset: -6,
        scale: vec2(7.0, 8.0),
        tint: vec4(9.0, 10.0, 11.0, 12.0),
        ..Default::default()
    };
    let words: Vec<u32> =
        uniforms.bytes().chunks(4).map(|bytes| u32::from_ne_bytes(bytes.try_into().unwrap())).collect();
    let f = f32::to_bits;
    let negative = (-6_i32).cast_unsigned();
    let expected = [
        [f(1.0), 0, 0, 0],
        [f(2.0), f(3.0), f(4.0), 5],
        [negative, 0, f(7.0), f(8.0)],
        [f(9.0), f(10.0), f(11.0), f(12.0)],
    ];
    assert_eq!(words, expected.concat());
    assert_eq!(described::Uniforms::SIZE, 64);
}

#[test]
fn closures_are_rust_functions() {
    use fragbuf_dsl::glam::Vec4;
    let uniforms = described::Uniforms { first: 2.0, steps: 3, ..Default::default() };
    let opaque = described::Fragment { color: Vec4::ONE, depth: 0.25, id: 2, ..Default::default() };
    let hidden = described::Fragment { color: Vec4::splat(0.5), id: 3, ..opaque };
    assert_eq!(described::criterion(&opaque, &uniforms), 0.5);
    assert!(described::constraint_0(&opaque, &uniforms) && !described::constraint_0(&hidden, &uniforms));
    assert_eq!(described::resolve(&[opaque, hidden], &uniforms), Vec4::ONE);
    assert_eq!(described::resolve(&[], &uniforms), Vec4::ZERO);
    assert!(described::variant().is_ok_and(|variant| variant.keep == Some(3)));
    assert_eq!(described::draft().keep.unwrap().count.value, KeepCount::AtMost(3));
    assert_eq!(UniformType::ALL.len(), 6);
}
