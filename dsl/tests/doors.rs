//! Three doors, one language: the same description as a file, through the builder and through the macro's expansion makes
//! equal drafts and has the same mistakes, over every preset and seeded random descriptions, broken ones among them.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod description;

use std::collections::BTreeSet;

use description::{Description, Random};
use fragbuf_dsl::builder::{Buffer, Format, KeepCount, UniformType, value};
use fragbuf_dsl::{Captured, Diagnostics, Draft, Origin, Parsed, Registry, closure, function, parse};
use proc_macro2::{TokenStream, TokenTree};

/// Code, message and way out of each mistake; where it stands differs between the doors.
fn said(faults: &Diagnostics) -> BTreeSet<(String, String, String)> {
    faults.iter().map(|fault| (fault.code.name.to_owned(), fault.message.clone(), fault.hint.clone())).collect()
}

/// What a program with this macro call in it reads at run time, and the compiler's errors.
fn through_the_macro(text: &str) -> (Parsed, BTreeSet<String>) {
    let call: TokenStream = format!("[fragbuf_dsl]\n{text}").parse().unwrap();
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
    (Captured::new(parts[0], parts[1], parts[2]).parse(), errors)
}

/// Every word with the brackets behind it.
fn visit(tokens: &TokenStream, seen: &mut impl FnMut(&str, &TokenStream)) {
    let mut word = String::new();
    for token in tokens.clone() {
        match token {
            TokenTree::Ident(name) => word = name.to_string(),
            TokenTree::Group(group) => {
                seen(&word, &group.stream());
                visit(&group.stream(), seen);
                word.clear();
            }
            _ => {}
        }
    }
}

fn strings(tokens: &TokenStream) -> Vec<String> {
    let literal = |token: TokenTree| syn::parse2::<syn::LitStr>(token.into()).ok().map(|literal| literal.value());
    tokens.clone().into_iter().filter_map(literal).collect()
}

/// Every place of a draft: where its parts and the lines of its functions stand.
fn places(draft: &Draft) -> Vec<(u32, u32)> {
    let functions = draft.helpers.iter().chain(&draft.constraints).chain(&draft.resolve);
    let functions = functions.chain(draft.keep.iter().filter_map(|keep| keep.criterion.as_ref()));
    let lines = functions.flat_map(|function| function.lines.iter().chain([&function.origin]));
    let attributes = draft.attributes.iter().flat_map(|row| [&row.name.origin, &row.format.origin]);
    let choices = draft.choices.iter().flat_map(|choice| {
        choice.alternatives.iter().map(|alternative| &alternative.value.origin).chain([&choice.axis.origin])
    });
    let all = lines.chain(attributes).chain(choices).chain([&draft.name.origin]);
    all.map(|origin: &Origin| (origin.line, origin.column)).collect()
}

fn agree(description: &Description) -> bool {
    let text = description.text();
    let file = parse(&text, "file");
    let built = description.built().parse();
    assert_eq!(file.draft, built.draft, "{text}");
    assert_eq!(said(&file.diagnostics), said(&built.diagnostics), "{text}");

    let (expanded, errors) = through_the_macro(&text);
    assert_eq!(file.draft, expanded.draft, "{text}");
    assert_eq!(said(&file.diagnostics), said(&expanded.diagnostics), "{text}");
    // The description begins on the second line of the call.
    let below: Vec<_> = places(&file.draft.clone().unwrap()).iter().map(|(line, column)| (line + 1, *column)).collect();
    assert_eq!(below, places(&expanded.draft.unwrap()), "{text}");

    let registry = Registry::builtin();
    let faults = file.check(&registry).err().unwrap_or_default();
    let heads = |text: &str| text.lines().next().unwrap_or_default().to_owned();
    let shown: BTreeSet<String> = errors.iter().map(|error| heads(error)).collect();
    let wanted: BTreeSet<String> =
        faults.iter().map(|fault| heads(&format!("[{}] {}", fault.code.name, fault.message))).collect();
    assert_eq!(shown, wanted, "{text}");
    assert_eq!(said(&faults), said(&description.built().variant(&registry).err().unwrap_or_default()), "{text}");
    faults.is_empty()
}

fragbuf_dsl::fragment_buffer! {
    buffer Bound from kplus_array {
        uniform { far: f32 }
        where |f, u| f.depth < u.far;
    }
}

/// A plan's buffers are numbered from 3 on, in the order of its rows: keys, entries and counts of the array, then the lock.
#[test]
fn bindings_are_those_of_the_plan() {
    use bound::bindings::{CAMERA, COUNTERS, ENTRIES, FILLED, FRAME, KEYS, LOCKS, UNIFORMS};
    assert_eq!([FRAME, UNIFORMS, CAMERA], [0, 1, 2]);
    assert_eq!([KEYS, ENTRIES, FILLED, LOCKS, COUNTERS], [3, 4, 5, 6, 7]);
}

#[test]
fn every_preset_is_the_same_through_every_door() {
    let registry = Registry::builtin();
    for technique in registry.techniques() {
        let mut description = Description::from(&technique.key);
        assert!(agree(&description), "{}", technique.key);
        // Said in full, a preset is itself.
        for (axis, value) in &technique.choices {
            description.choose(axis, value);
        }
        assert!(agree(&description), "{}", technique.key);
    }
}

#[test]
fn random_descriptions_are_the_same_through_every_door() {
    let registry = Registry::builtin();
    let (mut accepted, mut whole, count) = (0, 0, 500);
    for seed in 0..count {
        let description = Description::random(&mut Random(seed), &registry);
        accepted += usize::from(agree(&description));
        whole += usize::from(parse(&description.text(), "file").diagnostics.is_empty());
    }
    // Both kinds must be there for the test to mean anything.
    assert!(accepted >= 25, "only {accepted} of {count} are variants");
    assert!((100..450).contains(&whole), "{whole} of {count} read without a mistake");
}

#[test]
fn a_mistake_in_a_captured_closure_stands_where_it_was_written() {
    let faults = Buffer::named("Glass")
        .from("kplus_array")
        .attribute("depth", Format::F32)
        .keep_least(4, closure!(|f| f.depth - f.deph))
        .admit(closure!(|f| {
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
    let source = include_str!("doors.rs");
    let found: Vec<_> = faults
        .iter()
        .map(|fault| {
            let origin = &fault.origin;
            assert!(origin.file.ends_with("tests/doors.rs"), "{origin}");
            let line = source.lines().nth(origin.line as usize - 1).unwrap();
            let at: String = line.chars().skip(origin.column as usize - 1).take(origin.length as usize).collect();
            (fault.code.name, at)
        })
        .collect();
    let wanted = [("unknown-field", "deph"), ("wrong-type", "1"), ("unknown-name", "y")];
    assert_eq!(found, wanted.map(|(code, at)| (code, at.to_owned())), "{faults}");
}

#[test]
fn a_mistake_in_a_word_stands_at_the_call() {
    let faults = Buffer::named("Glass")
        .from("kplus_array")
        .attribute("color", Format::Rgba8)
        .attribute("depth", Format::F32)
        .attribute("two words", Format::F32)
        .choose("sort", value("insertoin"))
        .choose("keep", "eight")
        .variant(&Registry::builtin())
        .unwrap_err();
    let source: Vec<&str> = include_str!("doors.rs").lines().collect();
    for (fault, written) in faults.iter().zip(["two words", "insertoin", "keep"]) {
        let line = source[fault.origin.line as usize - 1];
        assert!(line.contains(written), "{fault}: {line}");
    }
    let codes: Vec<&str> = faults.iter().map(|fault| fault.code.name).collect();
    assert_eq!(codes.iter().filter(|code| **code == "unexpected").count(), 2, "{faults}");
    assert!(codes.contains(&"unknown-value"), "{faults}");
}

fragbuf_dsl::fragment_buffer! {
    buffer Laid from kplus_array {
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

/// The offsets are those that WGSL's rules give by hand: 0, 16, 28, 32, 40, 48.
#[test]
fn uniforms_lie_as_on_the_gpu() {
    use fragbuf_dsl::glam::{vec2, vec3, vec4};
    let uniforms = laid::Uniforms {
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
    let wanted = [
        [f(1.0), 0, 0, 0],
        [f(2.0), f(3.0), f(4.0), 5],
        [negative, 0, f(7.0), f(8.0)],
        [f(9.0), f(10.0), f(11.0), f(12.0)],
    ];
    assert_eq!(words, wanted.concat());
    assert_eq!(laid::Uniforms::SIZE, 64);
}

#[test]
fn closures_are_rust_functions() {
    use fragbuf_dsl::glam::Vec4;
    let uniforms = laid::Uniforms { first: 2.0, steps: 3, ..Default::default() };
    let opaque = laid::Fragment { color: Vec4::ONE, depth: 0.25, id: 2, ..Default::default() };
    let hidden = laid::Fragment { color: Vec4::splat(0.5), id: 3, ..opaque };
    assert_eq!(laid::criterion(&opaque, &uniforms), 0.5);
    assert!(laid::constraint_0(&opaque, &uniforms) && !laid::constraint_0(&hidden, &uniforms));
    assert_eq!(laid::resolve(&[opaque, hidden], &uniforms), Vec4::ONE);
    assert_eq!(laid::resolve(&[], &uniforms), Vec4::ZERO);
    assert!(laid::variant().is_ok_and(|variant| variant.keep == Some(3)));
    assert_eq!(laid::draft().keep.unwrap().count.value, KeepCount::AtMost(3));
    assert_eq!(UniformType::ALL.len(), 6);
}
