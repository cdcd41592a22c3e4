//! What users of other languages write in closures: each has one error, and the first code of its help compiles in place of it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use fragbuf_model::Diagnostic;
use fragbuf_syntax::parse;

fn found(text: &str) -> Vec<Diagnostic> {
    parse(text, "case.fragbuf").diagnostics.iter().cloned().collect()
}

fn only(text: &str) -> Diagnostic {
    let found = found(text);
    let [only] = found.as_slice() else { panic!("{text}\n{found:#?}") };
    only.clone()
}

/// Returns the first part of a help in backquotes.
fn code(help: &str) -> &str {
    help.split('`').nth(1).unwrap_or_else(|| panic!("no code in: {help}"))
}

fn with(items: &str) -> String {
    format!(
        "buffer B from kplus_array {{\n    fragment {{ color: rgba8, depth: f32, id: u32, normal: octahedral }}\n    \
         uniform {{ cut: f32, steps: u32 }}\n    {items}\n}}"
    )
}

/// Replaces `wrong` by the first code of the help, and checks that the description has no error then.
fn follow(items: &str, wrong: &str) -> Diagnostic {
    let error = only(&with(items));
    let fixed = with(&items.replacen(wrong, code(&error.help), 1));
    assert_eq!(found(&fixed), [], "{error}\n{fixed}");
    error
}

/// Checks that the error begins at `at` in the items.
fn is_at(error: &Diagnostic, items: &str, at: &str) {
    let text = with(items);
    let offset = text.len() - items.len() - 2 + items.find(at).unwrap_or_else(|| panic!("no {at}"));
    let line = text[..offset].matches('\n').count() as u32 + 1;
    let column = text[..offset].rsplit('\n').next().unwrap().chars().count() as u32 + 1;
    assert_eq!((error.span.line, error.span.column), (line, column), "{error}\n{text}");
}

#[test]
fn a_method_of_vectors_is_none_of_a_number() {
    for (value, wrong) in [
        ("(n / 8).extend(1.0)", "(n / 8).extend(1.0)"),
        ("n.extend(1.0)", "n.extend(1.0)"),
        ("f.depth.extend(1.0)", "f.depth.extend(1.0)"),
        ("f.id.extend(0.5)", "f.id.extend(0.5)"),
        ("2.extend(1.0)", "2.extend(1.0)"),
        ("n.extend(1)", "n.extend(1)"),
    ] {
        let items = format!("where |f| {{ let n = 16; {value}.x < f.depth }};");
        let error = follow(&items, wrong);
        assert_eq!(error.code.name, "unknown-method", "{error}");
    }
    for name in ["truncate", "normalize", "dot", "length", "cross"] {
        let error = only(&with(&format!("where |f| {{ let n = 16; (n / 8).{name}().x < f.depth }};")));
        assert!(error.help.contains("Vec3") && !error.help.contains(" as "), "{error}");
    }
}

#[test]
fn increments_are_reported_where_they_are() {
    for (statement, at, expected) in [
        ("n++;", "++", "n += 1"),
        ("n--;", "--", "n -= 1"),
        ("++n;", "++", "n += 1"),
        ("--n;", "--", "n -= 1"),
        ("v.x++;", "++", "v.x += 1.0"),
        ("v[1]--;", "--", "v[1] -= 1.0"),
        ("let m = n++;", "++", "n += 1"),
        ("if n > 1 { n++ }", "++", "n += 1"),
    ] {
        let items =
            format!("where |f| {{ let mut n = 1; let mut v = vec2(f.depth, 1.0); {statement} n > 2 && v.x < 1.0 }};");
        let error = only(&with(&items));
        is_at(&error, &items, at);
        assert_eq!(error.help, format!("write `{expected}`"), "{error}");
        assert!(error.message.contains(&format!("Rust has no operator `{at}`")), "{error}");
        if statement.trim_end_matches(';').ends_with(at) || statement.starts_with(at) {
            let fixed = items.replace(statement, &format!("{};", code(&error.help)));
            let types = found(&with(&fixed));
            assert_eq!(types, [], "{fixed}");
        }
    }
}

#[test]
fn loops_of_c_are_ranges() {
    for (head, range) in [
        ("for (int i = 0; i < 4; i++)", "for i in 0..4 { … }"),
        ("for (uint i = 0; i <= u.steps; ++i)", "for i in 0..=u.steps { … }"),
        ("for (int i = 3; i >= 0; i--)", "for i in (0..=3).rev() { … }"),
        ("for (int i = fragments.len() - 1; i >= 0; i -= 1)", "for i in (0..fragments.len()).rev() { … }"),
        ("for (int i = 4; i > 0; --i)", "for i in (0 + 1..=4).rev() { … }"),
        ("for (i = 1; i < n; i += 1)", "for i in 1..n { … }"),
        ("for (int i = 0; i < 8; i += 2)", "for i in 0..4 { … }"),
    ] {
        let items = format!(
            "resolve |fragments, u| {{ let n = 4; let mut s = 0.0; {head} {{ s += 1.0; }} vec4(s, u.cut, n as f32, 1.0) }}"
        );
        let error = only(&with(&items));
        is_at(&error, &items, "for (");
        assert_eq!(code(&error.help), range, "{error}");
        let fixed = items.replace(head, range.trim_end_matches(" { … }"));
        assert_eq!(found(&with(&fixed)), [], "{fixed}");
    }
    // A loop of Rust over pairs is no loop of C, whatever else is wrong.
    let error = only(&with(
        "resolve |fragments| { let mut s = 0.0; for (i, f) in fragments.iter().enumerate() { s += f.depth * i as f32 } let let; vec4(s, s, s, 1.0) }",
    ));
    assert!(!error.help.contains("0..4"), "{error}");
}

#[test]
fn operators_of_other_languages_are_reported_where_they_are() {
    for (condition, at) in [
        ("f.depth > 0.5 and f.id > 2", "and"),
        ("f.depth > 0.5 or f.id > 2", "or"),
        ("not f.depth > 0.5", "not"),
        ("f.id === 2", "==="),
        ("f.id !== 2", "!=="),
        ("f.id <> 2", "<>"),
        ("f.depth =< 0.5", "=<"),
        ("f.depth < .5", ".5"),
    ] {
        let items = format!("where |f| {condition};");
        let error = only(&with(&items));
        is_at(&error, &items, at);
        assert!(error.message.starts_with("invalid Rust syntax: ") && error.help.starts_with("write "), "{error}");
    }
    let items = "where |f| { float x = 1.0; x < f.depth };";
    is_at(&only(&with(items)), items, "float");
}

#[test]
fn mix_has_the_name_of_its_method() {
    for wrong in ["mix(f.color, f.color, f.depth)", "lerp(f.normal, f.normal, 0.5)", "f.color.mix(f.color, 0.5)"] {
        let error = follow(&format!("where |f| {wrong}.x < 0.5;"), wrong);
        assert!(error.help.contains(".lerp("), "{error}");
    }
    follow("where |f| mix(0.1, f.depth, f.color.w) < 0.5;", "mix(0.1, f.depth, f.color.w)");
    follow("where |f| mix(f.color, f.color, f.color).x < 0.5;", "mix(f.color, f.color, f.color)");
}

#[test]
fn chains_of_iterators_are_loops() {
    for wrong in [
        "fragments.iter().map(|f| f.depth).sum::<f32>()",
        "fragments.iter().map(|f| f.depth).sum()",
        "fragments.iter().map(|f| f.color).sum::<Vec4>().x",
        "fragments.iter().rev().map(|f| 1.0 - f.color.w).product::<f32>()",
        "fragments.iter().filter(|f| f.depth > 0.5).map(|f| f.depth * 2.0).sum::<f32>()",
        "fragments.iter().map(|f| f.depth).filter(|d| *d > 0.5).sum::<f32>()",
        "fragments.iter().map(|f| f.depth).map(|d| d * d).sum::<f32>()",
        "fragments.iter().take_while(|f| f.depth < 0.5).map(|f| f.depth).sum::<f32>()",
        "fragments.iter().enumerate().map(|(i, f)| f.depth * i as f32).sum::<f32>()",
        "fragments.iter().map(|f| f.depth).fold(0.0, |a, d| a + d)",
        "fragments.iter().fold(0.0, |a, f| f.depth.max(a))",
        "fragments.iter().map(|f| f.depth).fold(0.0, f32::max)",
        "(0..4).map(|i| i as f32).sum::<f32>()",
        "(fragments.iter().map(|f| f.id).sum::<u32>() as f32)",
        "(fragments.iter().filter(|f| f.depth > 0.5).count() as f32)",
        "(fragments.iter().count() as f32)",
        "(if fragments.iter().any(|f| f.depth > 0.5) { 1.0 } else { 0.0 })",
        "(if fragments.iter().all(|f| f.depth > 0.5) { 1.0 } else { 0.0 })",
        "(if (2..5).contains(&fragments.len()) { 1.0 } else { 0.0 })",
        "fragments.iter().next().unwrap().depth",
        "fragments.iter().last().unwrap().depth",
    ] {
        let items = format!("resolve |fragments| {{ let a = {wrong}; vec4(a, a, a, 1.0) }}");
        let text = with(&items);
        let errors = found(&text);
        let [error] = errors.as_slice() else { panic!("{wrong}: {errors:#?}") };
        if wrong.contains("*d") {
            continue;
        }
        // The error is about the chain, which the fix replaces.
        let start = text.lines().nth(error.span.line as usize - 1).unwrap();
        let column = error.span.column as usize - 1;
        let chain: String = start.chars().skip(column).take(error.span.length as usize).collect();
        let chain =
            if error.code.name == "unknown-method" { wrong.trim_end_matches(".depth").to_owned() } else { chain };
        let fixed = with(&items.replacen(&chain, code(&error.help), 1));
        assert_eq!(found(&fixed), [], "{error}\n{fixed}");
    }
    // What no loop is known for has an example.
    let error = only(&with(
        "resolve |fragments| { let a = fragments.iter().zip(fragments.iter()).count(); vec4(a as f32, 0.0, 0.0, 1.0) }",
    ));
    assert!(error.help.contains("for f in fragments"), "{error}");
}

#[test]
fn elements_of_the_list_are_indexed() {
    for (wrong, right) in [
        ("fragments.first()", "fragments[0]"),
        ("fragments.first().unwrap()", "fragments[0]"),
        ("fragments.last()", "fragments[fragments.len() - 1]"),
        ("fragments.last().unwrap()", "fragments[fragments.len() - 1]"),
        ("fragments.get(2)", "fragments[2]"),
        ("fragments.get(1).unwrap()", "fragments[1]"),
    ] {
        let error = follow(&format!("resolve |fragments| {{ {wrong}.color }}"), wrong);
        assert_eq!(code(&error.help), right, "{error}");
    }
    for wrong in ["fragments.size()", "fragments.length()", "fragments.count()"] {
        follow(&format!("resolve |fragments| {{ let n = {wrong} as f32; vec4(n, n, n, 1.0) }}"), wrong);
    }
}

#[test]
fn swizzles_have_the_letters_xyzw() {
    for wrong in [
        "f.color.rgb()",
        "f.color.bgr()",
        "f.color.a()",
        "f.color.stp()",
        "f.normal.rg()",
        "f.color.x()",
        "f.color.rgba()",
    ] {
        let items = format!("where |f| {{ let v = {wrong}; v == v || f.depth < 0.5 }};");
        let error = found(&with(&items)).remove(0);
        assert_eq!(error.code.name, "unknown-method", "{error}");
        let fixed = with(&items.replacen(wrong, code(&error.help), 1));
        assert!(found(&fixed).iter().all(|error| error.code.name != "unknown-method"), "{fixed}");
    }
    let error = only(&with("where |f| f.normal.rgba().x < f.depth;"));
    assert_eq!(error.help, "the components of `Vec3` are x, y, z");
    let error = only(&with("where |f| { let x = f.depth.sqrt::<f32>(); x < 0.5 };"));
    assert_eq!(error.help, "remove `::<f32>`");
}

/// Returns the messages about calls and ranges with bounds in the wrong order.
fn suspicious(items: &str) -> Vec<(String, String)> {
    let parsed = parse(&with(items), "case.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    let calls = parsed.draft.unwrap().suspicious;
    calls.into_iter().map(|call| (call.value.message, call.value.help)).collect()
}

#[test]
fn bounds_in_the_wrong_order_are_suspicious() {
    let smooth = "fn smoothstep(a: f32, b: f32, x: f32) -> f32 { let t = ((x - a) / (b - a)).clamp(0.0, 1.0); t * t * (3.0 - 2.0 * t) }";
    let remap = "fn remap(x: f32, low: f32, high: f32) -> f32 { (x - low) / (high - low) }";
    for (items, message) in [
        (
            "where |f| f.depth.max(1.0).min(0.0) < 0.5;",
            "this is always 0.0: the lower bound 1.0 is above the upper bound 0.0",
        ),
        (
            "where |f| f.depth.min(0.0).max(1.0) < 0.5;",
            "this is always 1.0: the lower bound 1.0 is above the upper bound 0.0",
        ),
        ("where |f| f.id.max(8).min(2) < 5;", "this is always 2: the lower bound 8 is above the upper bound 2"),
        ("where |f| f.normal.max(Vec3::ONE).min(Vec3::ZERO).x < f.depth;", "a lower bound is above its upper bound"),
        (
            &*format!("{smooth} where |f| smoothstep(0.9, 0.1, f.depth) < 0.5;"),
            "the lower bound `a` is 0.9, and the upper bound `b` is 0.1",
        ),
        (
            &*format!("{remap} where |f| remap(f.depth, 2.0 * 0.5, 0.0) < 0.5;"),
            "the lower bound `low` is 1.0, and the upper bound `high` is 0.0",
        ),
        (
            "where |f| { let mut s = 0.0; for i in 8..0 { s += i as f32; } s < f.depth };",
            "this loop never runs: its range begins at 8, above its end 0",
        ),
        (
            "where |f| { let mut s = 0.0; for i in (4..=1).rev() { s += i as f32; } s < f.depth };",
            "this loop never runs: its range begins at 4, above its end 1",
        ),
    ] {
        let found = suspicious(items);
        assert_eq!(found.iter().map(|(message, _)| message.as_str()).collect::<Vec<_>>(), [message], "{items}");
        assert!(found[0].1.contains("swap"), "{found:?}");
    }
    for items in [
        "where |f, u| f.depth.max(0.0).min(1.0) < u.cut;",
        "where |f, u| f.depth.max(u.cut).min(0.0) < 0.5;",
        "where |f| { let mut s = 0.0; for i in (0..8).rev() { s += i as f32; } s < f.depth };",
        "where |f| { let mut s = 0.0; for i in 0..0 { s += i as f32; } s < f.depth };",
        &*format!("{smooth} where |f| smoothstep(0.1, 0.9, f.depth) < 0.5;"),
        "fn mix(a: f32, b: f32, t: f32) -> f32 { a + (b - a) * t } where |f| mix(1.0, 0.0, f.depth) < 0.5;",
    ] {
        assert_eq!(suspicious(items), [], "{items}");
    }
    let error = only(&with("where |f| f.depth.clamp(1.0, 0.0) < 0.5;"));
    assert_eq!(error.help, "swap them: `clamp(0.0, 1.0)`");
}
