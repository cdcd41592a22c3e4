//! Tests that suggestions are true: a suggested expression compiles in place of what it replaces, the first fix of an incompatible
//! choice makes the description valid, and an error has no follow-up errors.

use fragbuf::load::{Description, load};
use fragbuf::{Diagnostic, Registry};

/// Returns the diagnostics of a description with changes from outside.
fn found(text: &str, set: &[(&str, &str)]) -> Vec<Diagnostic> {
    let description = Description::Text { file: "case.fragbuf".to_owned(), text: text.to_owned() };
    let set: Vec<(String, String)> = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    let found = match load(&description, &set, &[], &Registry::builtin()).variant {
        Ok(variant) => variant.warnings.clone(),
        Err(errors) => errors,
    };
    found.iter().cloned().collect()
}

fn only(text: &str, set: &[(&str, &str)]) -> Diagnostic {
    let found = found(text, set);
    let [only] = found.as_slice() else { panic!("{text}\n{set:?}: {found:#?}") };
    only.clone()
}

/// Returns the first part of a help in backquotes.
fn code(help: &str) -> &str {
    help.split('`').nth(1).unwrap_or_else(|| panic!("no code in: {help}"))
}

/// Calls of other languages, and what follows them to give a `bool`.
const CALLS: &[(&str, &str)] = &[
    ("saturate(f.depth)", " < 0.5"),
    ("saturate(f.color)", ".x < 0.5"),
    ("saturate(f.depth - 0.1)", " < 0.5"),
    ("saturate(0.5)", " < f.depth"),
    ("smoothstep(0.1, 0.2, f.depth)", " < 0.5"),
    ("smoothstep(0.1, 0.2, f.color)", ".x < 0.5"),
    ("smoothstep(f.normal, f.normal, f.normal)", ".x < 0.5"),
    ("mix(0.1, 0.2, f.depth)", " < 0.5"),
    ("mix(f.color, f.color, 0.5)", ".x < 0.5"),
    ("lerp(f.color, f.color, f.color)", ".x < 0.5"),
    ("mix(0, 1, f.depth)", " < 0.5"),
    ("select(0.1, 0.2, f.id > 2)", " < f.depth"),
    ("step(0.5, f.depth)", " < 0.5"),
    ("fract(f.depth)", " < 0.5"),
    ("frac(f.normal)", ".x < 0.5"),
    ("sign(f.depth)", " < 0.5"),
    ("inversesqrt(f.depth)", " < 0.5"),
    ("rcp(f.color)", ".x < 0.5"),
    ("pow(f.depth, 2.0)", " < 0.5"),
    ("pow(f.color, 2.2)", ".x < 0.5"),
    ("log(f.depth)", " < 0.5"),
    ("fma(f.depth, 2.0, 1.0)", " < 0.5"),
    ("fma(f.color, f.color, 1.0)", ".x < 0.5"),
    ("radians(f.depth)", " < 0.5"),
    ("degrees(f.normal)", ".x < 0.5"),
    ("fmod(f.normal, 0.1)", ".x < 0.5"),
    ("round(f.depth)", " < 0.5"),
    ("sqrt(2)", " < f.depth"),
    ("sqrt(f.id)", " < f.depth"),
    ("atan(f.depth, 1.0)", " < 0.5"),
    ("bitCount(f.id)", " < 5"),
    ("firstbithigh(f.id)", " < 5"),
    ("reversebits(5)", " < f.id"),
    ("asuint(f.depth)", " < f.id"),
    ("uintBitsToFloat(f.id)", " < f.depth"),
    ("floatBitsToInt(f.depth)", " < 5"),
    ("clamp(f.depth, 0.0, 1.0)", " < 0.5"),
    ("clamp(f.color, 0.0, 1.0)", ".x < 0.5"),
    ("max(f.color, 0)", ".x < 0.5"),
    ("max(0.0, f.color)", ".x < 0.5"),
    ("dot(f.normal, f.normal)", " < 0.5"),
    ("normalize(f.normal)", ".x < 0.5"),
    ("length(f.color.xyz() - f.normal)", " < 0.5"),
    ("abs(-f.depth)", " < 0.5"),
    ("float(f.id)", " < 0.5"),
    ("uint(f.depth)", " < f.id"),
    ("bool(f.id)", ""),
    ("float3(1.0, 2.0, 3.0)", ".x < f.depth"),
    ("float3(1, 2, 3)", ".x < f.depth"),
    ("vec4f(f.normal, 1.0)", ".x < f.depth"),
    ("vec4(f.normal, 1.0)", ".x < f.depth"),
    ("vec4(f.color.xy(), 0.0, 1.0)", ".x < f.depth"),
    ("vec4(1.0, f.normal)", ".x < f.depth"),
    ("vec3(f.color)", ".x < f.depth"),
    ("vec3(0.5)", ".x < f.depth"),
    ("float4(f.color.xy(), f.color.xy())", ".x < f.depth"),
    ("f.depth.saturate()", " < 0.5"),
    ("f.color.saturate()", ".x < 0.5"),
    ("f.normal.mix(f.normal, 0.5)", ".x < 0.5"),
];

#[test]
fn a_suggested_expression_compiles_in_place_of_the_call() {
    for (call, rest) in CALLS {
        let text = format!(
            "buffer B from kplus_array {{\n    fragment {{ color: rgba8, depth: f32, normal: octahedral, id: u32 }}\n    \
             ties: attribute {{ by: id }};\n    where |f| f.normal.x + f.color.x < 9.0;\n    where |f| {call}{rest};\n}}"
        );
        let error = only(&text, &[]);
        let suggestion = code(&error.help);
        let changed = found(&text.replace(call, suggestion), &[]);
        assert_eq!(changed, [], "{call}: {}", error.help);
    }
}

/// Functions of numbers alone are applied to the components of a vector.
#[test]
fn functions_of_numbers_are_suggested_for_each_component() {
    for (call, part) in [
        ("inversesqrt(f.normal)", "f.normal.x.sqrt().recip()"),
        ("step(0.5, f.normal)", "(if f.normal.x < 0.5 { 0.0 } else { 1.0 })"),
        ("pow(f.normal, f.normal)", "f.normal.x.powf(f.normal.x)"),
        ("sqrt(f.normal)", "f.normal.x.sqrt()"),
        ("f.normal.sqrt()", "f.normal.x.sqrt()"),
    ] {
        let text = |part: &str| {
            format!(
                "buffer B from kplus_array {{\n    fragment {{ color: rgba8, depth: f32, normal: octahedral }}\n    where |f| {part} < 0.5;\n}}"
            )
        };
        let error = only(&text(&format!("{call}.x")), &[]);
        assert_eq!(code(&error.help), part, "{call}");
        assert_eq!(found(&text(part), &[]), [], "{call}");
    }
}

#[test]
fn a_constructor_with_the_type_of_its_components_is_explained() {
    let error = only("buffer B from kplus_array {\n    where |f| vec4<f32>(1.0, 0.0, 0.0, 1.0).x < f.depth;\n}", &[]);
    assert!(error.help.contains("write `vec4(…)` without the type"), "{error}");
    let error = only("buffer B from kplus_array {\n    where |f| mod(f.depth, 0.1) < 0.5;\n}", &[]);
    assert_eq!(code(&error.help), "x - y * (x / y).floor()", "a keyword of Rust");
}

/// The first fix of a criterion that breaks the order of depth is a sort; for techniques that cannot have one, it is not.
#[test]
fn the_first_fix_makes_the_description_valid() {
    let mut sorted = 0;
    for technique in Registry::builtin().techniques() {
        let text = |choice: &str| {
            format!("buffer B from {} {{\n    keep 8 least |f| f.depth - f.color.w;\n{choice}}}", technique.key)
        };
        for error in found(&text(""), &[]) {
            if error.code.name != "missing-capability" || !error.message.contains("fragments in depth order") {
                continue;
            }
            sorted += 1;
            if error.help.starts_with("remove the criterion") {
                let text = format!("buffer B from {} {{\n    {}\n}}", technique.key, code(&error.help));
                assert_eq!(found(&text, &[]), [], "{error}");
                continue;
            }
            let fix = error.help.split('`').skip(1).step_by(2).next().unwrap();
            assert_eq!(fix, "sort: insertion", "{error}");
            if error.help.starts_with("choose ") {
                assert_eq!(found(&text(&format!("    {fix};\n")), &[]), [], "{error}");
            }
        }
    }
    assert!(sorted >= 5, "{sorted}");
    // The technique is replaced last, and the effect never first.
    let error = only("buffer B from ab_ll {\n    cull: early;\n}", &[]);
    assert!(error.help.starts_with("choose `cull: none`"), "{error}");
}

/// An item that does not parse is one error: nothing that it would have declared is missing.
#[test]
fn an_item_with_an_error_has_no_follow_up_errors() {
    for (items, line) in [
        ("fragment { color: rgba8 depth: f32 }", 2),
        ("fragment { color = rgba8, depth = f32 }\n    keep 8 least |f| f.depth - f.color.w;\n    sort: insertion;", 2),
        ("fragmnt { color: rgba8, depth: f32, heat: f32 }\n    where |f| f.heat > 0.5;", 2),
        ("fragment color: rgba8, heat: f32;\n    where |f| f.heat > 0.5;", 2),
        ("uniform { cut f32 }\n    where |f, u| f.depth < u.cut;", 2),
        ("uniform { cut: f32; far: f32 }\n    where |f, u| f.depth < u.far;", 2),
        ("keep least 8 |f| f.depth;", 2),
        ("keep = all;", 2),
        ("storage linked_list;\n    sync: slot_counter;\n    cull: none;\n    keep all;", 2),
        ("fn half(x f32) -> f32 { 0.5 * x }\n    where |f| half(f.depth) < 0.5;", 2),
        ("fragment { depth: f32 }\n    resolve |fragments| { vec4(fragments.ln(), 0.0, 0.0, 1.0) }", 3),
        ("fragment { depth: f32 }\n    resolve { vec4(0.0, 0.0, 0.0, 1.0) }", 3),
    ] {
        let found = found(&format!("buffer B from kplus_array {{\n    {items}\n}}"), &[]);
        let lines: Vec<u32> = found.iter().map(|found| found.span.line).collect();
        assert!(!lines.is_empty() && lines.iter().all(|found| *found == line), "{items}\n{found:#?}");
    }
    // Errors that do not follow are reported, too.
    let found =
        found("buffer B from kplus_array {\n    fragment { color: rgba8 depth: f32 }\n    sort: insertoin;\n}", &[]);
    assert_eq!(found.iter().map(|found| found.code.name).collect::<Vec<_>>(), ["unexpected-token", "unknown-value"]);
}

#[test]
fn the_header_of_a_buffer_has_suggestions() {
    for (header, code, expected) in [
        ("bufer B from kplus_array", "missing-buffer", "did you mean `buffer`?"),
        ("Buffer B from kplus_array", "missing-buffer", "did you mean `buffer`?"),
        ("buffer B form kplus_array", "unexpected-token", "did you mean `from`?"),
        ("buffer B using kplus_array", "unexpected-token", "write `from kplus_array`"),
        ("buffer B kplus_array", "unexpected-token", "write `from kplus_array`"),
        ("buffer B: kplus_array", "unexpected-token", "write `buffer Name from kplus_array"),
    ] {
        let error = only(&format!("{header} {{\n    keep 4;\n}}"), &[]);
        assert!(error.code.name == code && error.help.contains(expected), "{header}: {error}");
    }
}

#[test]
fn an_option_is_repeated_with_a_colon() {
    for (options, expected) in [("limit 100", "write `limit: 100`"), ("limit = 100", "write `limit: 100`")] {
        let text = format!("buffer B from kplus_array {{\n    sync: spin_lock {{ {options} }};\n}}");
        let error = only(&text, &[]);
        assert_eq!(error.help, expected);
        assert_eq!(found(&text.replace(options, code(&error.help)), &[]), []);
    }
}

#[test]
fn changes_from_outside_have_suggestions_that_work() {
    const TEXT: &str = "buffer B from kplus_array {\n    fragment { color: rgba8, depth: f32 }\n}";
    for (name, value, code, expected) in [
        ("keep", "4", "unknown-axis", "write `k=4`"),
        ("K", "4", "unknown-axis", "write `k=4`"),
        ("limit", "100", "unknown-axis", "write `sync.limit=100`"),
        ("samples.count", "8", "unknown-option", "choose `--set samples=coverage`"),
        ("fragment.colour", "vec4", "unknown-field", "did you mean `color`?"),
        ("fragment.color", "rgb8", "invalid-option", "rgba8"),
        ("sync.limt", "9", "unknown-option", "did you mean `limit`?"),
        ("cull.words", "2", "unknown-option", "choose `--set cull=occupancy`"),
        ("k", "many", "invalid-option", "a whole number, or `all`"),
        ("sort", "", "invalid-option", "a value after the `=`"),
    ] {
        let error = only(TEXT, &[(name, value)]);
        assert!(error.code.name == code && error.help.contains(expected), "{name}={value}: {error}");
        assert_eq!(&*error.span.file, "--set", "{error}");
    }
    for set in [&[("k", "4")][..], &[("sync.limit", "100")], &[("samples", "coverage"), ("samples.count", "8")]] {
        assert_eq!(found(TEXT, set), [], "{set:?}");
    }
    // The same names in a description.
    let inside = |line: &str| only(&format!("buffer B from kplus_array {{\n    {line}\n}}"), &[]).help;
    assert_eq!(inside("k: 4;"), "write `keep 4;`");
    assert_eq!(inside("limit: many;"), "it is an option: write `sync: spin_lock { limit: many }`");
}

/// Syntax of other languages and slips: each has a help that says what to write.
#[test]
fn wrong_items_say_what_to_write() {
    for (items, expected) in [
        ("where |f| f.depth < 0.5 and f.color.x > 0.1;", "write `&&`"),
        ("where |f| f.depth < .5;", "write a digit before the point: `0.5`"),
        ("fn half(x) -> f32 { 0.5 * x }", "its type, after its name: `x: f32`"),
        ("float half(float x) { return 0.5 * x; }", "write a function as in Rust"),
        ("storage: \"max_array\";", "write the name without quotes: `storage: max_array;`"),
        ("storage: \"mine.wgsl\";", "write `storage: wgsl(\"mine.wgsl\");`"),
        ("storage: max-array;", "names have `_` in place of `-`: `max_array`"),
        ("storage: glsl(\"mine.glsl\");", "a user file is WGSL: `storage: wgsl(\"file.wgsl\");`"),
        ("sync: spin_lock(limit: 100);", "options are in braces"),
        ("sync: spin_lock | interlock;", "separated by `else`: `spin_lock else interlock`"),
        ("sync: spin_lock, interlock;", "separated by `else`: `spin_lock else interlock`"),
        ("sync: spin_lock { limit: -1 };", "numbers of options are 0 or more"),
        ("k: 4;", "write `keep 4;`"),
        ("keep 4 |f| f.depth;", "write `least` before the criterion"),
        ("fragment { color: rgba8, depth: f32 },\n    keep 4;", "remove it: items are not separated by commas"),
        ("fragment { rgba8 color, depth: f32 }", "write `color: rgba8`"),
        ("fragment { color: vec4<f32>, depth: f32 }", "write `color: vec4`, without the type"),
        ("fragment { color: rgba8; depth: f32 }", "separate declarations by commas"),
        ("fragment { color: rgba8 = 0, depth: f32 }", "a declaration has no value"),
        ("criterion |f| f.depth;", "the criterion follows `keep`"),
        ("filter |f| f.depth < 0.5;", "write `where |f| f.depth > 0.5;`"),
        ("where |f| f.depth as bool;", "compare it: `x != 0.0`"),
    ] {
        let error = only(&format!("buffer B from kplus_array {{\n    {items}\n}}"), &[]);
        assert!(error.help.contains(expected), "{items}: {error}");
    }
    for (header, expected) in [
        ("buffer B from \"kplus_array\"", "without quotes: `from kplus_array`"),
        ("buffer B from kplus-array", "write `from kplus_array`"),
    ] {
        let error = only(&format!("{header} {{ keep 4; }}"), &[]);
        assert!(error.help.contains(expected), "{header}: {error}");
    }
    let set = |name: &str, value: &str| only("buffer B from kplus_array { }", &[(name, value)]).help;
    assert!(set("fragment", "vec4").contains("`fragment.name=format`"));
    assert!(set("uniform.far", "1").contains("`--uniform far=1`"));
    assert!(set("storage", "wgsl(\"a.wgsl\")").contains("relative to the current folder"));
}

/// Closures with slips of other languages: the help fits the types.
#[test]
fn wrong_expressions_say_what_to_write() {
    for (closure, expected) in [
        ("where |f| 2.sqrt() < f.depth;", "write `2.0_f32.sqrt()`"),
        ("where |f| f.depth.sin < 0.5;", "it is a method: write `f.depth.sin()`"),
        ("where |f| f.depth ** 2.0 < 0.5;", "for a power, write `x.powf(2.0)`"),
        ("where |f| f.depth ^ 2.0 < 0.5;", "for a power, write `x.powf(2.0)`"),
        ("where |f| dFdx(f.depth) < 0.5;", "closures have no derivatives"),
        ("where |f| f.color > 0.5;", "compare components, `a.x < b.x`"),
        ("where |f| any(f.color.xyz());", "`v.x > 0.5 || v.y > 0.5`"),
        ("where |f| let x = f.depth; x < 0.5;", "enclose statements in braces"),
        ("resolve |fragments| { fragments[-1].color }", "`fragments[fragments.len() - 1]`"),
        ("where |f| length(f.depth) < 0.5;", "it is a method of Vec2, Vec3, Vec4"),
    ] {
        let error = only(&format!("buffer B from kplus_array {{\n    {closure}\n    keep 4;\n}}"), &[]);
        assert!(error.help.contains(expected), "{closure}: {error}");
    }
}

/// Slips that had follow-up errors or help that does not fit.
#[test]
fn slips_are_one_error_each() {
    for (text, code, expected) in [
        ("buffer B {\n    storge: linked_list;\n    sync: slot_counter;\n}", "unknown-axis", "did you mean `storage`?"),
        ("buffer B from kplus_array {\n    keep 4 leats |f| f.depth;\n}", "unexpected-token", "did you mean `least`?"),
        (
            "buffer B from kplus_array {\n    fragment { color: rgba8, depth: f32, id: u32 }\n    ties: attribute { by: idd };\n}",
            "invalid-option",
            "did you mean `id`?",
        ),
        ("buffer B from kplus_array {\n    where |(a, b)| a < 0.5;\n}", "unsupported", "write a name"),
        (
            "buffer B from kplus_array {\n    resolve |fragments| {\n        let mut c = Vec3::ZERO;\n        for f in fragments { c += f.color; }\n        \
             c.extend(1.0)\n    }\n}",
            "type-mismatch",
            "write `f.color.truncate()` or `f.color.xyz()`",
        ),
        (
            "buffer B from kplus_array {\n    resolve |fragments| {\n        let mut c = 0.0;\n        for f in fragments { c += f.color; }\n        \
             vec4(c, c, c, 1.0)\n    }\n}",
            "type-mismatch",
            "declare it with a vector: `let mut c = Vec4::ZERO;`",
        ),
    ] {
        let error = only(text, &[]);
        assert!(error.code.name == code && error.help.contains(expected), "{text}: {error}");
    }
}

/// Returns the code of a suggestion in the place of the wrong part of a description, which then compiles.
fn follow(text: &str, wrong: &str, suggestion: impl Fn(&str) -> String) {
    let error = only(text, &[]);
    let fixed = text.replacen(wrong, &suggestion(code(&error.help)), 1);
    assert_eq!(found(&fixed, &[]), [], "{error}\n{fixed}");
}

/// A declaration without a colon, or with the type before it, names the attribute first and a type of the block.
#[test]
fn a_declaration_has_its_name_first() {
    const EFFECT: &str = "resolve |fragments, u| { vec4(fragments[0].depth, u.cut, 0.0, 1.0) }";
    for (block, wrong, expected) in [
        ("fragment { color rgba8, depth: f32 }", "color rgba8", "color: rgba8"),
        ("fragment { rgba8 color, depth: f32 }", "rgba8 color", "color: rgba8"),
        ("fragment { float3 color, depth: f32 }", "float3 color", "color: vec3"),
        ("fragment { depth float }", "depth float", "depth: f32"),
        ("fragment { depth: f32, f32 heat }", "f32 heat", "heat: f32"),
        ("fragment { normal octahedral, depth: f32 }", "normal octahedral", "normal: octahedral"),
        ("fragment { f32: depth }", "f32: depth", "depth: f32"),
        ("fragment { rgba8: color, depth: f32 }", "rgba8: color", "color: rgba8"),
        ("uniform { float cut }", "float cut", "cut: f32"),
        ("uniform { cut f32 }", "cut f32", "cut: f32"),
        ("uniform { f32: cut }", "f32: cut", "cut: f32"),
        ("uniform cut f32;", "uniform cut f32;", "uniform { cut: f32 }"),
        ("fragment vec3 flow;", "fragment vec3 flow;", "fragment { flow: vec3, depth: f32 }"),
    ] {
        let text = format!("buffer B from kplus_array {{\n    {block}\n    {EFFECT}\n}}");
        let errors: Vec<Diagnostic> = found(&text, &[]).into_iter().filter(|error| error.span.line == 2).collect();
        let [error] = errors.as_slice() else { panic!("{block}: {errors:#?}") };
        assert_eq!(code(&error.help), expected, "{block}: {error}");
        let fixed = text.replace(wrong, expected);
        let names = |errors: Vec<Diagnostic>| errors.iter().map(|error| error.code.name).collect::<Vec<_>>();
        let left: Vec<&str> = names(found(&fixed, &[]));
        assert!(
            left.iter().all(|code| ["unused-attribute", "unknown-field", "missing-depth"].contains(code)),
            "{fixed}: {left:?}"
        );
    }
}

/// The name of a buffer is one word: the help joins the words, in a file as in the builder.
#[test]
fn the_name_of_a_buffer_is_one_word() {
    for (name, wrong) in [
        ("My Heat", "buffer My Heat"),
        ("my heat", "buffer my heat"),
        ("My-Heat", "buffer My-Heat"),
        ("My own heat", "buffer My own heat"),
        ("Heat 2", "buffer Heat 2"),
        ("\"My Heat\"", "buffer \"My Heat\""),
    ] {
        follow(&format!("buffer {name} from kplus_array {{ keep 4; }}"), wrong, str::to_owned);
    }
    let error = only("buffer My Heat {\n    storage: max_array;\n    keep 4;\n}", &[]);
    assert_eq!((code(&error.help), error.span.line, error.span.column), ("buffer MyHeat", 1, 11));
    let built = fragbuf::builder::Buffer::named("My Heat").from("kplus_array").draft().unwrap_err();
    assert!(built.iter().any(|error| error.help == "a name is one word: write `MyHeat`"), "{built}");
}

/// A constant among the items, and in a closure, is an error with the whole replacement; its uses are no further errors.
#[test]
fn a_constant_is_a_function() {
    for (constant, used) in [
        ("const NEAR: f32 = 0.5;", "NEAR"),
        ("const NEAR: float = -0.5;", "NEAR"),
        ("let near = 0.5;", "near"),
        ("let near: f32 = 0.25 + 0.25;", "near"),
        ("static NEAR: f32 = 0.5;", "NEAR"),
        ("let near = vec3(0.5, 0.5, 0.1);", "near.x"),
    ] {
        let text = |item: &str, used: &str| {
            format!("buffer B from kplus_array {{\n    {item}\n    where |f| f.depth < {used};\n    keep 4;\n}}")
        };
        let error = only(&text(constant, used), &[]);
        let call = error.help.split('`').nth(3).unwrap();
        let name = used.split('.').next().unwrap();
        let fixed = text(code(&error.help), &used.replacen(name, call, 1));
        assert_eq!(found(&fixed, &[]), [], "{error}\n{fixed}");
        assert_eq!(error.span.line, 2);
    }
    let text = "buffer B from kplus_array {\n    where |f| { const X: f32 = 0.5; f.depth < X };\n}";
    follow(text, "const X: f32 = 0.5;", str::to_owned);
}

/// Slips of operators and parameters: the suggestion compiles in place of what is wrong.
#[test]
fn slips_of_operators_have_replacements_that_compile() {
    for (closure, wrong) in [
        ("where |f| f.depth = 0.5;", "f.depth = 0.5"),
        ("where |f| f.depth > 0.2 && f.color.x = 0.5;", "f.depth > 0.2 && f.color.x = 0.5"),
        ("where |f| { if f.id = 2 { return false; } true }", "f.id = 2"),
        ("where |f| not (f.depth < 0.5);", "not (f.depth < 0.5)"),
        ("where |f| not f.depth < 0.5;", "not f.depth < 0.5"),
        ("where |f| f.depth > 0.5 && not f.depth < 0.5;", "not f.depth < 0.5"),
        ("where |f| f.depth =< 0.5;", "=<"),
        ("where |f| f.depth <> 0.5;", "<>"),
        ("where |f| f.depth === 0.5;", "==="),
        ("where |f| f.depth !== 0.5;", "!=="),
        ("where |f| f.id == -1;", "f.id == -1"),
        ("where |f| -1 < f.id;", "-1 < f.id"),
        ("where |f| f.id + 2 >= -3;", "f.id + 2 >= -3"),
        ("where |u, f| f.depth < u.cut;", "|u, f|"),
        ("keep 4 least |u, f| f.depth * u.cut; sort: insertion;", "|u, f|"),
        ("resolve |u, fragments| { vec4(u.cut, fragments[0].depth, 0.0, 1.0) }", "|u, fragments|"),
        ("resolve |u, all| { let mut c = u.cut; for f in all { c += f.depth; } vec4(c, c, c, 1.0) }", "|u, all|"),
        ("resolve |all| { let mut c = 0.0; for i in range(4) { c += 0.1; } vec4(c, c, c, 1.0) }", "range(4)"),
        (
            "resolve |all| { let mut c = 0.0; for i in range(1, all.len()) { c += all[i].depth; } vec4(c, c, c, 1.0) }",
            "range(1, all.len())",
        ),
        (
            "resolve |all| { let mut c = Vec4::ZERO; for f in all { c.xyz += f.color.xyz() * 0.5; } c }",
            "c.xyz += f.color.xyz() * 0.5;",
        ),
        (
            "resolve |all| { let mut c = Vec4::ZERO; for f in all { c.rgb = f.color.xyz(); } c }",
            "c.rgb = f.color.xyz();",
        ),
        ("resolve |all| { let mut c = Vec4::ZERO; c.xy() *= 2.0; c }", "c.xy() *= 2.0;"),
    ] {
        let text = format!(
            "buffer B from kplus_array {{\n    fragment {{ color: rgba8, depth: f32, id: u32 }}\n    uniform {{ cut: f32 }}\n    \
             ties: attribute {{ by: id }};\n    where |f, u| f.color.x + f.depth < u.cut;\n    {closure}\n}}"
        );
        let errors = found(&text, &[]);
        let [error] = errors.as_slice() else { panic!("{closure}: {errors:#?}") };
        let last = error.help.split('`').skip(1).step_by(2);
        // `=` assigns: write `==` to compare, `a == b`.
        let suggestion =
            last.filter(|part| !matches!(*part, "=" | "u32::MAX") && (*part != "==" || wrong == "===")).last().unwrap();
        let fixed = text.replacen(wrong, suggestion, 1);
        assert_eq!(found(&fixed, &[]), [], "{error}\n{fixed}");
        assert_eq!(error.span.line, 6, "{error}");
    }
}

/// Alternatives are separated by `else`, whatever separates them, also in `--set`.
#[test]
fn alternatives_are_separated_by_else() {
    for separated in [
        "interlock, spin_lock",
        "interlock | spin_lock",
        "interlock / spin_lock",
        "interlock or spin_lock",
        "interlock spin_lock",
    ] {
        let text = format!("buffer B from kplus_array {{\n    sync: {separated};\n}}");
        let error = only(&text, &[]);
        let suggestion = error.help.split('`').rev().nth(1).unwrap();
        assert_eq!(suggestion, "interlock else spin_lock", "{error}");
        assert_eq!(found(&text.replace(separated, suggestion), &[]), []);
        let set = only("buffer B from kplus_array { }", &[("sync", separated)]);
        assert!(set.help.contains("`interlock else spin_lock`"), "{set}");
    }
    // The next item follows a missing semicolon.
    let error = only("buffer B from kplus_array {\n    sync: interlock else spin_lock\n    keep 4;\n}", &[]);
    assert_eq!(error.help, "end the item with `;`");
}

/// The error of a choice is at the item that causes it, and its first suggestion compiles in place of this item.
#[test]
fn a_condition_points_to_the_item_that_violates_it() {
    for (technique, items, at, line, expected) in [
        ("ab_ll", "fragment { color: vec3, depth: f32 }", "vec3", 2, "fragment { color: rgba8, depth: f32 }"),
        ("ab_ll", "fragment { colour: rgba8, depth: f32 }", "colour", 2, "fragment { color: rgba8, depth: f32 }"),
        ("ab_ll", "fragment { albedo: vec4, depth: f32 }", "albedo", 2, "fragment { color: vec4, depth: f32 }"),
        ("ab_ll", "fragment { depth: f32 }", "depth", 2, "fragment { color: rgba8, depth: f32 }"),
        ("z_buffer", "keep 4;", "4", 2, "keep 1;"),
        ("kb_sr", "keep 32;", "32", 2, "keep 8;"),
        ("kb_sr", "keep 3;", "3", 2, "keep 2;"),
        ("kb_sr", "keep 4 least |f| f.color.x;", "|f| f.color.x", 2, "keep 4;"),
        ("kb_stream", "keep 4 least |f| f.color.x;", "|f| f.color.x", 2, "keep 4;"),
        ("kb_mdt64", "fragment { color: vec4, depth: f32 }", "vec4", 2, "fragment { color: rgba8, depth: f32 }"),
        (
            "kb_mdt64",
            "fragment { color: rgba8, depth: f32, heat: f32 }",
            "heat",
            2,
            "fragment { color: rgba8, depth: f32 }",
        ),
        ("kb_mdt64", "keep 8 least |f| f.color.x;", "|f| f.color.x", 2, "keep 8;"),
    ] {
        let text = format!("buffer B from {technique} {{\n    {items}\n}}");
        let errors = found(&text, &[]);
        let error = errors.iter().find(|error| error.code.name == "missing-capability");
        let error = error.unwrap_or_else(|| panic!("{technique}: {items}: {errors:#?}"));
        let column = 5 + items.find(at).unwrap() as u32;
        assert_eq!((error.span.line, error.span.column), (line, column), "{error}");
        assert!(
            error.labels.iter().any(|label| label.text.ends_with("is chosen here") && label.span.line == 1),
            "{error}"
        );
        let suggestions: Vec<&str> = error.help.split('`').skip(1).step_by(2).collect();
        assert!(suggestions.contains(&expected), "{error}");
        assert_eq!(found(&text.replace(items, expected), &[]), [], "{error}");
    }
    // A closure that the storage cannot call.
    let text = "buffer B from kb_stream {\n    resolve |fragments| { vec4(fragments[0].depth, 0.0, 0.0, 1.0) }\n}";
    let error = only(text, &[]);
    assert_eq!((error.code.name, error.span.line, error.span.column), ("missing-capability", 2, 13), "{error}");
    assert!(error.help.contains("`resolve: stream` in place of the closure"), "{error}");
    assert_eq!(found("buffer B from kb_stream {\n    resolve: stream;\n}", &[]), []);
    // The closure that an effect of a missing colour suggests.
    let error = only("buffer B from ab_ll {\n    fragment { depth: f32 }\n}", &[]);
    let closure = error.help.split('`').find(|part| part.starts_with("resolve |")).unwrap();
    assert_eq!(found(&format!("buffer B from ab_ll {{\n    fragment {{ depth: f32 }}\n    {closure}\n}}"), &[]), []);
}

/// The replacement repeats the user's condition, criterion or arguments, and compiles.
#[test]
fn replacements_repeat_what_the_user_wrote() {
    for (wrong, right) in [
        ("where f.depth < 0.5;", "where |f| f.depth < 0.5;"),
        ("where f.color.w <= 0.1 && f.depth < 0.9;", "where |f| f.color.w <= 0.1 && f.depth < 0.9;"),
    ] {
        let error = only(&format!("buffer B from kplus_array {{ {wrong} }}"), &[]);
        assert_eq!(code(&error.help), right, "{error}");
        assert_eq!(found(&format!("buffer B from kplus_array {{ {right} }}"), &[]), []);
    }
    for (wrong, right) in [
        ("f.depth.smoothstep(0.25, 1.0)", "((f.depth - 0.25) / (1.0 - 0.25))"),
        ("f.depth.log(2.0)", "f.depth.log2()"),
        ("f.depth.log(10.0)", "(f.depth.ln() / 10.0_f32.ln())"),
        ("max(f.color.xyz())", "f.color.xyz().max_element()"),
        ("max(f.depth, 0.5, f.color.w)", "f.depth.max(0.5).max(f.color.w)"),
        ("f.depth.lerp(1.0, 0.5)", "(f.depth + (1.0 - f.depth) * 0.5)"),
    ] {
        let text = |value: &str| format!("buffer B from kplus_array {{ where |f| {value} < 0.5; }}");
        let error = only(&text(wrong), &[]);
        let replacement = code(&error.help);
        assert!(replacement.contains(right), "{error}");
        assert_eq!(found(&text(replacement), &[]), [], "{replacement}");
    }
}

#[test]
fn choices_and_names_have_suggestions_for_what_was_meant() {
    let error = only("buffer B from ab_ll { sort: bitonic, resolve: complexity; }", &[]);
    assert_eq!(error.help, "end the item with `;`: `sort: bitonic; resolve: …`");
    let error = only("buffer B from kplus_array { sync: spin_lock(100); }", &[]);
    assert_eq!(error.help, "options are in braces: `{ … }`");
    let error = only("buffer B from kplus { }", &[]);
    assert!(error.help.contains("did you mean `kplus_array`?"), "{error}");
    let error =
        only("buffer B from kplus_array { uniform { far: f32 } where |f, u| f.depth < u.far; }", &[("far", "1")]);
    assert_eq!(error.help, "it is a uniform: write `--uniform far=1`");
}

const PAYLOAD: &str = "fragment { color: rgba8, depth: f32, id: u32, normal: octahedral }\n    uniform { cut: f32, steps: u32 }\n    \
                       ties: attribute { by: id };\n    where |f, u| f.normal.x + f.color.x < u.cut && f.id < u.steps;";

/// Returns a description with these items.
fn with_items(items: &str) -> String {
    format!("buffer B from kplus_array {{\n    {PAYLOAD}\n    {items}\n}}")
}

/// A variable that is declared with an integer literal and used as a float: its declaration is what has to change, as in Rust.
#[test]
fn a_declaration_that_does_not_fit_its_uses_is_replaced() {
    for (closure, wrong) in [
        ("let mut s = 0; for f in fragments { s += f.depth; } vec4(s, s, s, 1.0)", "let mut s = 0;"),
        ("let mut s = 0; for f in fragments { s = s + f.depth; } vec4(s, s, s, 1.0)", "let mut s = 0;"),
        ("let mut s = 0; for f in fragments { s = f.depth; } vec4(s, s, s, 1.0)", "let mut s = 0;"),
        ("let mut s = 0; for f in fragments { s = f.depth.max(s); } vec4(s, s, s, 1.0)", "let mut s = 0;"),
        ("let mut s = 0; for f in fragments { s = s.max(f.depth); } vec4(s, s, s, 1.0)", "let mut s = 0;"),
        (
            "let mut s = -1; for f in fragments { if f.depth > s { s = f.depth; } } vec4(s, s, s, 1.0)",
            "let mut s = -1;",
        ),
        ("let mut s = 0; for f in fragments { s = s.max(f.id); } vec4(s as f32, 0.0, 0.0, 1.0)", "let mut s = 0;"),
        ("let mut c = 0; for f in fragments { c += f.color; } c", "let mut c = 0;"),
        ("let mut c = 0.0; for f in fragments { c += f.color; } c", "let mut c = 0.0;"),
        ("let mut c = 0.0; for f in fragments { c = c + f.color; } c", "let mut c = 0.0;"),
        ("let n = 3; fragments[0].color / n", "let n = 3;"),
        ("let n = 0.0; fragments[n].color", "let n = 0.0;"),
        ("let mut n: u32 = 0; for f in fragments { n += f.depth; } vec4(n as f32, 0.0, 0.0, 1.0)", "f.depth"),
        ("let mut n = 0; for f in fragments { n += f.id; n += f.depth; } vec4(n as f32, 0.0, 0.0, 1.0)", "f.depth"),
        ("let mut s = 0.0; for f in fragments { s += f.id; } vec4(s, s, s, 1.0)", "f.id"),
        ("let mut s = 0.0; for f in fragments { s += 1; } vec4(s, s, s, 1.0)", "1"),
    ] {
        let text = with_items(&format!("resolve |fragments| {{ {closure} }}"));
        let error = only(&text, &[]);
        let (before, rest) = text.split_once("resolve").unwrap();
        let rest = match wrong {
            // The literal after `+=`.
            "1" => rest.replacen("+= 1", &format!("+= {}", code(&error.help)), 1),
            _ => rest.replacen(wrong, code(&error.help), 1),
        };
        assert_eq!(found(&format!("{before}resolve{rest}"), &[]), [], "{closure}: {error}");
    }
    // A float would not fit `n += 1`.
    let text = with_items("resolve |fragments| { let mut n = 0; for f in fragments { n += 1; } Vec4::splat(n) }");
    let error = only(&text, &[]);
    assert_eq!(code(&error.help), "(n as f32)");
    assert_eq!(found(&text.replace("splat(n)", "splat((n as f32))"), &[]), [], "{error}");
    // A literal takes the integer type of its uses, as in Rust.
    let counted =
        "resolve |fragments| { let mut n = 0; for f in fragments { n += f.id; } vec4(n as f32, 0.0, 0.0, 1.0) }";
    assert_eq!(found(&with_items(counted), &[]), []);
}

/// An assignment to several components has the statements that replace it, whatever swizzles its value has.
#[test]
fn a_swizzled_assignment_has_its_statements() {
    for wrong in [
        "c.xyz += v.xyz()",
        "c.xyz += v.xyz",
        "c.rgb = v.bgr",
        "c.rgb += v.rgb * v.a",
        "c.xy = c.yx",
        "c.xy = c.yx()",
        "c.rgb *= 2",
        "c.xyz() += fragments[0].normal",
        "c.xyz = 1.0 - c.xyz",
        "c.zw = v.xy * 0.5",
    ] {
        let closure = format!("let mut c = Vec4::ONE; let v = fragments[0].color; {wrong}; c * v");
        follow(&with_items(&format!("resolve |fragments| {{ {closure} }}")), &format!("{wrong};"), str::to_owned);
    }
    let text = with_items("resolve |fragments| { let mut c = Vec4::ONE; c.xy = c.yx; c }");
    assert_eq!(code(&only(&text, &[]).help), "let v = c.yx(); c.x = v.x; c.y = v.y;", "both values are read first");
}

#[test]
fn a_function_with_a_path_is_suggested_as_the_language_has_it() {
    for (call, rest) in [
        ("std::cmp::min(f.id, 3)", " < 2"),
        ("f32::lerp(f.depth, 0.5, 0.1)", " < 0.5"),
        ("Vec3::from(f.color)", ".x < 0.5"),
        ("f32::from(f.id)", " < 0.5"),
        ("u32::from(f.depth)", " < 2"),
        ("self::half(f.depth)", " < 0.5"),
        ("glam::vec3(f.depth, 0.0, 0.0)", ".x < 0.5"),
        ("2.max(f.id)", " < 4"),
        ("(2.0 * 3.0).sqrt()", " < f.depth"),
    ] {
        let text = with_items(&format!(
            "fn half(x: f32) -> f32 {{ 0.5 * x }}\n    where |f| half(f.depth) < 0.4;\n    where |f| {call}{rest};"
        ));
        follow(&text, call, str::to_owned);
    }
    // A literal alone has no type that a method could be called on: the declaration gets one, too.
    let text = with_items(
        "resolve |fragments| { let mut m = 0; for f in fragments { m = max(m, f.depth); } vec4(m, m, m, 1.0) }",
    );
    let error = only(&text, &[]);
    let parts: Vec<&str> = error.help.split('`').collect();
    let fixed = text.replace("max(m, f.depth)", parts[1]).replace("let mut m = 0;", parts[3]);
    assert_eq!(found(&fixed, &[]), [], "{error}");
    let list = "resolve |fragments| { if fragments.length > 1 { fragments[1].color } else { fragments[0].color } }";
    follow(&with_items(list), "fragments.length", str::to_owned);
    let error = only(&with_items("where |f| foo::shade(f.depth, f.id, 2) < 0.5;"), &[]);
    assert!(error.help.contains("declare `fn shade(depth: f32, id: u32, x: i32) -> f32 { … }`"), "{error}");
    assert!(error.help.ends_with("call it as `shade(f.depth, f.id, 2)`"), "{error}");
    let error = only(&with_items("where |f| smoothtep(0.1, 0.2, f.depth) < 0.5;"), &[]);
    assert!(error.help.starts_with("did you mean `smoothstep`? write `({ let t = "), "{error}");
}

#[test]
fn a_ternary_is_an_if_with_the_same_parts() {
    for (closure, wrong) in [
        ("where |f| f.depth > 0.5 ? true : false;", "f.depth > 0.5 ? true : false"),
        (
            "resolve |fragments| { let a = fragments[0].depth > 0.5 ? 1.0 : 0.0; vec4(a, a, a, 1.0) }",
            "fragments[0].depth > 0.5 ? 1.0 : 0.0",
        ),
        (
            "resolve |fragments| { let a = 1.0 + ((fragments.len() > 1) ? 1.0 : 0.0); vec4(a, a, a, 1.0) }",
            "(fragments.len() > 1) ? 1.0 : 0.0",
        ),
        (
            "fn f(x: f32) -> f32 { return x > 0.5 ? x : x < 0.1 ? 2.0 * x : 0.0; }\n    where |g| f(g.depth) > 0.1;",
            "x > 0.5 ? x : x < 0.1 ? 2.0 * x : 0.0",
        ),
        (
            "resolve |fragments| { let mut a = 0.0; a += fragments.len() >= 2 ? 1.0 : 0.0; vec4(a, a, a, 1.0) }",
            "fragments.len() >= 2 ? 1.0 : 0.0",
        ),
        (
            "resolve |fragments| { vec4(0.0, fragments.len() == 2 ? 1.0 : 0.0, 0.0, 1.0) }",
            "fragments.len() == 2 ? 1.0 : 0.0",
        ),
    ] {
        let text = with_items(closure);
        follow(&text, wrong, str::to_owned);
        let error = only(&text, &[]);
        let line = text.lines().nth(error.span.line as usize - 1).unwrap();
        assert_eq!(line.chars().nth(error.span.column as usize - 1), Some('?'), "{error}");
    }
}

/// A missing `;` is at the end of what it should end.
#[test]
fn a_missing_semicolon_is_at_the_end_of_its_statement() {
    for (items, last) in [
        (
            "resolve |fragments| {\n        let a = 1.0\n        let b = 2.0;\n        vec4(a, b, 0.0, 1.0)\n    }",
            "1.0\n",
        ),
        (
            "resolve |fragments| {\n        let mut a = 1.0;\n        a += vec2(2.0, 1.0).length()\n        a += 1.0;\n        vec4(a, a, 0.0, 1.0)\n    }",
            ")\n        a",
        ),
        ("sort: insertion\n    keep 4;", "insertion\n"),
        ("keep 4\n    sort: insertion;", "4\n    sort"),
        ("where |f| f.depth < 0.5\n    keep 4;", "0.5\n    keep"),
    ] {
        let text = with_items(items);
        let error = only(&text, &[]);
        let at = text.rfind(last).unwrap();
        let line = text[..at].matches('\n').count() as u32 + 1;
        let column = (at - text[..at].rfind('\n').unwrap()) as u32;
        assert_eq!((error.span.line, error.span.column), (line, column), "{error}");
        assert!(error.message.contains("expected `;` after"), "{error}");
        let end = text.split('\n').take(line as usize).map(|line| line.len() + 1).sum::<usize>() - 1;
        assert_eq!(found(&format!("{};{}", &text[..end], &text[end..]), &[]), [], "{error}");
    }
}

/// `else` separates alternatives of a choice. Other items have none, and their error is one.
#[test]
fn only_choices_have_alternatives() {
    for (items, wrong) in [
        ("keep 4 else all;", " else all"),
        ("keep 4 else 8;", " else 8"),
        ("keep 4 least |f| f.depth else all;", " else all"),
        ("where |f| f.depth > 0.5 else true;", " else true"),
        ("resolve |fragments| { fragments[0].color } else over;", " else over"),
    ] {
        let text = with_items(items);
        let error = only(&text, &[]);
        assert_eq!(code(&error.help), format!("remove `{}`", wrong.trim()).split('`').nth(1).unwrap(), "{error}");
        assert!(error.help.contains(&format!("remove `{}`", wrong.trim())), "{error}");
        assert_eq!(found(&text.replacen(wrong, "", 1), &[]), [], "{error}");
    }
}

/// Attributes and uniforms without their prefix, with the wrong one, or nearly right.
#[test]
fn a_name_is_suggested_with_its_prefix() {
    for (closure, wrong, right) in [
        ("where |f, u| f.depth > cutt;", "cutt", "u.cut"),
        ("where |f, u| f.depth > cut;", "cut;", "u.cut;"),
        ("where |f, u| dpth > u.cut;", "dpth", "f.depth"),
        ("where |f, u| f.depth > u.depth;", "u.depth", "f.depth"),
        ("where |f, u| f.depth > f.cut;", "f.cut", "u.cut"),
        ("where |f, u| f.cuut > 0.5 * u.cut;", "f.cuut", "u.cut"),
        ("where |f, u| f.dpeth > u.cut;", "dpeth", "depth"),
        ("where |f, u| f.depth > u.cutt;", "cutt", "cut"),
        ("where |p, v| p.depth > cutt && v.cut > 0.0;", "cutt", "v.cut"),
    ] {
        let text = with_items(closure);
        let error = only(&text, &[]);
        assert_eq!(code(&error.help), right.trim_end_matches(';'), "{error}");
        assert_eq!(found(&text.replacen(wrong, right, 1), &[]), [], "{error}");
    }
    let help = |items: &str| only(&with_items(items), &[]).help;
    assert_eq!(help("where |f| f.depth > cut;"), "it is a uniform: add a parameter, `|f, u|`, and write `u.cut`");
    assert_eq!(help("where |f| f.depth > u.cut;"), "declare the uniforms as a parameter: `|f, u|`");
    let helper = "fn g(x: f32) -> f32 { x * cut } where |f| g(f.depth) > 0.5;";
    assert_eq!(help(helper), "it is a uniform: add a parameter, `u: Uniforms`, and write `u.cut`");
    assert!(help("resolve |fragments| { f.color }").starts_with("iterate over the fragments: `for f in fragments"));
    assert!(help("keep 4 least |f| fragments[0].depth;").contains("only `resolve` has all fragments"));
}
