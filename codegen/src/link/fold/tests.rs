//! Tests of folding on small sources.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::super::{Source, link};
use crate::source_map::LineSource;

/// Functions that fold, and others.
const LIBRARY: &str = "\
const LIMIT = 0u;
const MOST = 4u;
const ONE = 1.0;
const TABLE = array(1.0, 2.0);
var<private> state: u32;
var<private> pair: vec2<u32>;

struct Frame {
    k: u32,
}

var<uniform> frame: Frame;

fn size(a: u32) -> u32 {
    return frame.k;
}

fn nothing(a: u32) {}

fn yes() -> bool {
    return true;
}

fn no(a: u32, b: u32) -> bool {
    return false;
}

fn share() -> f32 {
    return 1.0;
}

fn zero() -> u32 {
    return 0u;
}

fn half() -> f16 {
    return 0.5;
}

fn second(a: u32, b: u32) -> u32 {
    return b;
}

fn read(a: u32) -> u32 {
    var found = a;
    for (var i = 0u; i < a; i++) {
        found += state;
    }
    return found;
}

fn write(a: u32) -> u32 {
    state = a;
    return a;
}

fn write_deep(a: u32) -> u32 {
    return write(a) + 1u;
}

fn write_after_a_block(a: u32) -> u32 {
    if a > 0u {
        var state = a;
        state += 1u;
    }
    state = a;
    return a;
}

fn write_after_a_loop(a: u32) -> u32 {
    for (var state = 0u; state < a; state++) {
        let b = a;
    }
    state = a;
    return a;
}

fn write_through_a_pointer(a: u32) -> u32 {
    let p = &pair;
    p.x = a;
    return a;
}

fn write_through_an_argument(p: ptr<function, vec2<u32>>) -> u32 {
    p.x = 1u;
    return 2u;
}

fn write_locals(a: u32) -> u32 {
    const ZERO = 0u;
    var<function> b = vec2<u32>(ZERO);
    b.x = a;
    for (var i = 0u; i < a; i++) {
        i += 1u;
    }
    var state = a;
    state += b.x;
    return state;
}

fn memory_fence() {}

fn there(a: u32) -> u32 {
    return back(a) + 1u;
}

fn back(a: u32) -> u32 {
    return there(a) + 1u;
}
";

/// Links a function `f` with this body and result. Returns its lines without the first and the last.
fn folded(result: &str, body: &str) -> String {
    let signature = format!("fn f(x: u32, t: bool){result} {{");
    let text = format!("{signature}\n{body}}}\n");
    let sources = [Source::generated("a", LIBRARY.to_owned()), Source::generated("b", text)];
    let linked = link("", &sources, &["f"], "").unwrap();
    let start = linked.text.find(&signature).unwrap() + signature.len() + 1;
    linked.text[start..].trim_end().strip_suffix('}').unwrap().to_owned()
}

fn folds(result: &str, body: &str, expected: &str) {
    assert_eq!(folded(result, body), expected, "{body}");
}

#[test]
fn removes_calls_of_empty_functions_with_the_comments_above() {
    folds("", "    let a = x;\n    // Counts.\n    nothing(a);\n    state = a;\n", "    let a = x;\n    state = a;\n");
    folds("", "    state = x;\n\n    nothing(read(x)); // Twice.\n", "    state = x;\n");
    folds("", "    nothing(write(x));\n", "    nothing(write(x));\n");
    folds("", "    nothing(write_deep(x));\n", "    nothing(write_deep(x));\n");
    folds("", "    memory_fence();\n    state = x;\n", "    memory_fence();\n    state = x;\n");
    folds("", "    nothing(there(x));\n    state = x;\n", "    state = x;\n");
}

#[test]
fn known_conditions_select_a_branch() {
    let then = "    if yes() {\n        // Kept.\n        state = x;\n\n        state = 2u;\n    }\n";
    folds("", then, "    // Kept.\n    state = x;\n\n    state = 2u;\n");
    folds("", "    // Why.\n    if !yes() {\n        state = x;\n    }\n    state = 1u;\n", "    state = 1u;\n");
    let chain = "    if no(x, x) {\n        state = 1u;\n    } else if t {\n        state = 2u;\n    } else {\n        state = 3u;\n    }\n";
    folds("", chain, "    if t {\n        state = 2u;\n    } else {\n        state = 3u;\n    }\n");
    let middle = "    if t {\n        state = 1u;\n    } else if no(x, x) {\n        state = 2u;\n    } else {\n        state = 3u;\n    }\n";
    folds("", middle, "    if t {\n        state = 1u;\n    } else {\n        state = 3u;\n    }\n");
    let ends = "    if t {\n        state = 1u;\n    } else if yes() {\n        state = 2u;\n    } else {\n        state = 3u;\n    }\n";
    folds("", ends, "    if t {\n        state = 1u;\n    } else {\n        state = 2u;\n    }\n");
    let other = "    if no(x, x) {\n        state = 1u;\n    } else {\n        state = 2u;\n    }\n";
    folds("", other, "    state = 2u;\n");
}

#[test]
fn folds_operators_if_one_side_determines_the_result() {
    let value = |expression: &str, expected: &str| {
        folds(" -> bool", &format!("    return {expression};\n"), &format!("    return {expected};\n"));
    };
    value("t && yes()", "t");
    value("yes() && (t || read(x) > 1u)", "t || read(x) > 1u");
    value("t || !no(x, x)", "true");
    value("write(x) == 1u || yes()", "write(x) == 1u || true");
    value("read(x) == 1u || yes()", "true");
    value("!(t && yes())", "!t");
    value("(t || no(x, x)) && x < 2u", "t && x < 2u");
    value("no(write(x), x) && t", "no(write(x), x) && t");
    value("LIMIT > 0u && f32(x) < ONE", "false");
    value("LIMIT != MOST && x < MOST", "x < MOST");
    value("x < LIMIT", "x < LIMIT");
    value("select(x, state, yes()) == 1u", "state == 1u");
}

#[test]
fn numbers_and_arguments_replace_calls() {
    folds(
        " -> f32",
        "    var a = f32(x) * share();\n    a *= share();\n    a += 2.0;\n    return a;\n",
        "    var a = f32(x);\n    a += 2.0;\n    return a;\n",
    );
    folds(" -> u32", "    return 8u / zero();\n", "    return 8u / zero();\n");
    folds(" -> u32", "    return 2u * second(x, x + state);\n", "    return 2u * (x + state);\n");
    folds(" -> u32", "    return second(\n        read(x),\n        write(x),\n    );\n", "    return write(x);\n");
    folds(" -> u32", "    return second(write(x), x);\n", "    return second(write(x), x);\n");
}

#[test]
fn members_of_the_frame_replace_calls() {
    folds(" -> u32", "    return 8u / size(x) - 1u;\n", "    return 8u / frame.k - 1u;\n");
    folds(" -> u32", "    return size(write(x));\n", "    return size(write(x));\n");
    folds(" -> u32", "    let frame = x;\n    return size(frame);\n", "    let frame = x;\n    return size(frame);\n");
}

#[test]
fn removes_statements_after_a_return_and_unread_locals() {
    folds(
        " -> u32",
        "    if yes() {\n        return x;\n    }\n    // Never.\n    let a = x;\n    return a;\n",
        "    return x;\n",
    );
    folds("", "    let a = read(x);\n    nothing(a);\n    state = x;\n", "    state = x;\n");
    folds("", "    let a = write(x);\n    nothing(a);\n", "    let a = write(x);\n");
    folds(
        "",
        "    while t {\n        if yes() {\n            break;\n        }\n        state = x;\n    }\n",
        "    while t {\n        break;\n    }\n",
    );
    let continued = "    loop {\n        if t {\n            continue;\n        }\n        nothing(x);\n        break;\n        continuing {\n            state = x;\n        }\n    }\n";
    folds("", continued, &continued.replace("        nothing(x);\n", ""));
    folds("", "    state = x;\n    if yes() {\n        return;\n    }\n", "    state = x;\n");
    folds("", "    if t {\n        nothing(x);\n    }\n    state = x;\n", "    state = x;\n");
    folds(
        "",
        "    if t {\n        state = x;\n    } else {\n        nothing(x);\n    }\n",
        "    if t {\n        state = x;\n    }\n",
    );
}

#[test]
fn an_if_that_returns_its_condition_becomes_a_return() {
    let body = |condition: &str, value: bool| {
        format!("    nothing(x);\n    if {condition} {{\n        return {value};\n    }}\n    return {};\n", !value)
    };
    folds(" -> bool", &body("!t", false), "    return t;\n");
    folds(" -> bool", &body("t", false), "    return !t;\n");
    folds(" -> bool", &body("x > 1u", true), "    return x > 1u;\n");
    folds(" -> bool", &body("x > 1u", false), "    return !(x > 1u);\n");
}

#[test]
fn replaces_constant_locals_by_their_value() {
    let wanted = "    var wanted = yes();\n    if wanted && no(x, x) {\n        wanted = false;\n    }\n    if wanted {\n        state = x;\n    }\n";
    folds("", wanted, "    state = x;\n");
    let changed = "    var wanted = yes();\n    if t {\n        wanted = false;\n    }\n    if wanted {\n        state = x;\n    }\n";
    folds("", changed, &changed.replace("yes()", "true"));
}

#[test]
fn does_not_change_shadowed_names() {
    // The inner `a` would conflict with the outer one.
    let body = "    let a = x;\n    if yes() {\n        let a = 2u;\n        state = a;\n    }\n    state = a;\n";
    folds("", body, &body.replace("yes()", "true"));
    let hidden = "    let LIMIT = x;\n    if LIMIT > 0u {\n        state = 1u;\n    }\n";
    folds("", hidden, hidden);
}

#[test]
fn loops_and_switches_keep_their_structure() {
    let body = "    for (var i = 0u; i < MOST && yes(); i++) {\n        nothing(i);\n        switch i {\n            case 0u: {\n                nothing(i);\n                state = i;\n            }\n            default: {}\n        }\n    }\n";
    let expected = "    for (var i = 0u; i < MOST; i++) {\n        switch i {\n            case 0u: {\n                state = i;\n            }\n            default: {}\n        }\n    }\n";
    folds("", body, expected);
}

#[test]
fn removes_functions_that_become_empty_and_their_constants() {
    let text = "fn outer(x: u32) {\n    if no(x, x) {\n        inner(x);\n    }\n}\n\nfn inner(x: u32) {\n    nothing(MOST);\n}\n\nfn f(x: u32) {\n    outer(x);\n    state = x;\n}\n";
    let sources = [Source::generated("a", LIBRARY.to_owned()), Source::generated("b", text.to_owned())];
    let linked = link("", &sources, &["f"], "p_").unwrap();
    let expected = "\n// ---- generated/a\nvar<private> p_state: u32;\n\n// ---- generated/b\n\nfn p_f(x: u32) {\n    p_state = x;\n}\n\n";
    assert_eq!(linked.text, expected);
    let line = linked.text.lines().position(|line| line.contains("p_state = x")).unwrap() + 1;
    assert_eq!(linked.lines.source(line), LineSource::Source { name: "generated/b".into(), line: 13 });
}

#[test]
fn does_not_change_functions_that_cannot_be_parsed() {
    let body = "    if yes() {\n        state = x;\n    }\n    @diagnostic(off, derivative_uniformity)\n    if t {\n        state = 1u;\n    }\n";
    folds("", body, body);
}

#[test]
fn does_not_change_functions_with_block_comments() {
    let body = "    nothing(x); /* // */ state = x;\n    if yes() { /* { */\n        state = 1u;\n    }\n";
    folds("", body, body);
}

#[test]
fn does_not_join_tokens() {
    folds(
        "",
        "    if(yes() && t) {\n        state = x;\n    }\n    nothing(x);\n",
        "    if t {\n        state = x;\n    }\n",
    );
    folds(" -> bool", "    return(yes());\n", "    return true;\n");
    folds(" -> f32", "    let a = f32(x);\n    return a -share()*-a;\n", "    let a = f32(x);\n    return a - -a;\n");
    folds(" -> bool", "    if(yes()&&t){\n        return true;\n    }\n    return false;\n", "    return t;\n");
}

#[test]
fn keeps_statements_on_the_lines_of_braces() {
    let kept = |body: &str| folds("", body, &body.replace("yes()", "true"));
    kept("    if yes() { state = 1u;\n        state = x;\n    }\n");
    kept("    if yes() {\n        state = x;\n    state = 2u; }\n");
    kept("    if yes() {\n        state = x;\n    } state = 2u;\n");
    kept("    state = 3u; if yes() {\n        state = x;\n    }\n");
    kept("    if yes() { state = x; }\n");
    folds("", "    if yes() {}\n    state = x;\n", "    state = x;\n");
    folds("", "    if yes() { // Why.\n        state = x;\n    } // So.\n", "    state = x;\n");
    folds("", "    if yes() { nothing(x); state = x; }\n", "    if true { state = x; }\n");
}

#[test]
fn keeps_declarations_in_blocks_if_their_names_have_another_meaning_outside() {
    let kept = |body: &str| folds("", body, &body.replace("yes()", "true"));
    // After the block, `MOST` is a constant and `state` a variable.
    kept("    if yes() {\n        let MOST = x;\n        state = MOST;\n    }\n    state = MOST;\n");
    kept("    if yes() {\n        var state = x;\n        state += x;\n    }\n    state = x;\n");
    kept("    if yes() {\n        var<function> x = 1u;\n        x += 1u;\n        state = x;\n    }\n");
    folds("", "    if yes() {\n        let a = x;\n        state = a;\n    }\n", "    let a = x;\n    state = a;\n");
}

#[test]
fn writes_to_anything_but_a_local_variable_are_side_effects() {
    let kept = |body: &str| folds("", body, body);
    kept("    nothing(write_after_a_block(x));\n");
    kept("    nothing(write_after_a_loop(x));\n");
    kept("    nothing(write_through_a_pointer(x));\n");
    kept("    var a = vec2<u32>(x);\n    nothing(write_through_an_argument(&a));\n    state = a.x;\n");
    folds("", "    nothing(write_locals(x));\n    state = x;\n", "    state = x;\n");
}

#[test]
fn literals_keep_the_types_around_them() {
    let value = |result: &str, expression: &str, expected: &str| {
        let body = |value: &str| format!("    var<function> y = f32(x);\n    return {value};\n");
        folds(result, &body(expression), &body(expected));
    };
    let float = |expression: &str, expected: &str| value(" -> f32", expression, expected);
    // Without the factor, the other side could be a whole number.
    float("f32(1 * share())", "f32(1 * share())");
    float("y + f32(no(x, x) || 1 * 1.0 > ONE)", "y + f32(no(x, x) || 1 * 1.0 > ONE)");
    float("ONE * share()", "ONE * share()");
    float("y * (ONE * share())", "y * (ONE * share())");
    float("TABLE[0] * share()", "TABLE[0] * share()");
    float("share() * y + share()", "y + 1.0");
    float("(y + 2.0) * share()", "y + 2.0");
    float("2.0f * share()", "2.0f * share()");
    float("y * half()", "y * half()");
    float("select(1, 2, yes()) * y", "select(1, 2, true) * y");
    float("y + select(1, 2.0f, yes())", "y + 2.0f");
    float("select(y, 1, yes())", "select(y, 1, true)");
    float("select(y, 1.0f, yes())", "1.0f");
    float("select(1, y, yes())", "y");
    value(" -> u32", "second(x, 1)", "second(x, 1)");
    value(" -> u32", "second(x, MOST)", "second(x, MOST)");
    value(" -> u32", "second(x, 1u)", "1u");
}

#[test]
fn keeps_runtime_values_in_expressions_that_the_compiler_would_evaluate() {
    let kept = |expression: &str| {
        let body = format!("    var<function> y = array<u32, 2>(x, x);\n    return {expression};\n");
        folds(" -> u32", &body, &body);
    };
    kept("y[zero()]");
    kept("y[second(x, 5u)]");
    kept("y[zero() + 1u]");
    kept("max(zero(), x)");
    kept("max(second(x, 1u), x)");
    kept("u32(1.0 / share())");
    kept("1u << zero()");
    kept("x / second(x, 0u)");
    kept("1u / u32(no(x, x))");
    kept("second(x, 0u) + zero()");
    kept("1u / (zero() + zero())");
    folds("", "    state /= zero();\n", "    state /= zero();\n");
    folds("", "    state <<= zero();\n    state += zero();\n", "    state <<= zero();\n    state += 0u;\n");
    let moved = |expression: &str, expected: &str| {
        let body = |value: &str| format!("    var<function> y = array<u32, 2>(x, x);\n    return {value};\n");
        folds(" -> u32", &body(expression), &body(expected));
    };
    moved("y[second(x, x & 1u)]", "y[x & 1u]");
    moved("max(x + zero(), second(x, state))", "max(x + 0u, state)");
    moved("1u / u32(t && no(x, x))", "1u / u32(t && false)");
    moved("read(zero())", "read(0u)");
    moved("x / second(x, state + 1u)", "x / (state + 1u)");
}

#[test]
fn keeps_known_locals_where_a_constant_is_not_allowed() {
    let body = "    let wanted = yes();\n    if wanted && t {\n        state = 1u / u32(!wanted);\n    }\n";
    folds("", body, &body.replace("yes()", "true").replace("wanted && t", "t"));
    let changed = "    var wanted = yes();\n    (wanted) = t;\n    if wanted {\n        state = x;\n    }\n";
    folds("", changed, &changed.replace("yes()", "true"));
    // Two edits of one statement: the removal includes the use.
    let unread = "    let wanted = yes();\n    let other = !wanted;\n    nothing(x);\n    state = x;\n";
    folds("", unread, "    state = x;\n");
}

#[test]
fn a_call_statement_remains_a_statement() {
    folds("", "    second(x, x + write(x));\n", "    second(x, x + write(x));\n");
}
