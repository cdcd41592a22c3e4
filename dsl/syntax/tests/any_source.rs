//! Any source gives a draft or errors: nothing panics, hangs or exhausts the stack.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use fragbuf_syntax::parse;

/// A random number generator (xorshift64*) with the same output on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % below.max(1)
    }
}

fn sources(directory: &str) -> Vec<String> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(directory);
    let mut paths: Vec<_> =
        fs::read_dir(directory).expect("readable").map(|entry| entry.expect("readable").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "fragbuf"));
    paths.sort();
    paths.iter().map(|path| fs::read_to_string(path).expect("readable")).collect()
}

/// Returns names, numbers, single punctuation characters, and the spaces between them.
fn tokens(source: &str) -> Vec<String> {
    let kind = |letter: char| match letter {
        letter if letter.is_alphanumeric() || letter == '_' => 0,
        letter if letter.is_whitespace() => 1,
        _ => 2,
    };
    let mut tokens: Vec<String> = Vec::new();
    let mut last = 3;
    for letter in source.chars() {
        let kind = kind(letter);
        match tokens.last_mut() {
            Some(token) if kind == last && kind < 2 => token.push(letter),
            _ => tokens.push(letter.to_string()),
        }
        last = kind;
    }
    tokens
}

fn check(source: &str) {
    let parsed = parse(source, "any");
    for found in &parsed.diagnostics {
        assert!(!found.help.is_empty() && found.span.line > 0 && found.span.column > 0, "{found}");
    }
    let Some(draft) = parsed.draft else {
        assert!(!parsed.diagnostics.is_empty(), "neither draft nor error: {source}");
        return;
    };
    for function in draft.helpers.iter().chain(&draft.constraints).chain(&draft.resolve) {
        assert_eq!(function.wgsl.lines().count(), function.lines.len(), "{}", function.wgsl);
    }
}

#[test]
fn truncated_at_every_character() {
    for source in sources("good") {
        for (index, _) in source.char_indices() {
            check(&source[..index]);
        }
    }
}

/// Returns the source with its open brackets closed, and without unmatched closing brackets.
fn closed(source: &str) -> String {
    let mut open = Vec::new();
    let mut result = String::new();
    for letter in source.chars() {
        match letter {
            '(' => open.push(')'),
            '{' => open.push('}'),
            '[' => open.push(']'),
            ')' | '}' | ']' if open.last() != Some(&letter) => continue,
            ')' | '}' | ']' => drop(open.pop()),
            _ => {}
        }
        result.push(letter);
    }
    result.extend(open.into_iter().rev());
    result
}

#[test]
fn truncated_and_closed() {
    for source in sources("good") {
        for (index, _) in source.char_indices().step_by(3) {
            check(&closed(&source[..index]));
        }
    }
}

#[test]
fn tokens_deleted_duplicated_and_swapped() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let all: Vec<Vec<String>> = sources("good").iter().chain(&sources("bad")).map(|source| tokens(source)).collect();
    for _ in 0..6000 {
        let mut mutated = all[random.next(all.len())].clone();
        for _ in 0..1 + random.next(4) {
            if mutated.is_empty() {
                break;
            }
            let at = random.next(mutated.len());
            let other = random.next(mutated.len());
            match random.next(4) {
                0 => drop(mutated.remove(at)),
                1 => mutated.insert(at, mutated[other].clone()),
                2 => mutated.swap(at, other),
                _ => {
                    let source = &all[random.next(all.len())];
                    mutated[at] = source.get(random.next(source.len())).cloned().unwrap_or_default();
                }
            }
        }
        check(&mutated.concat());
        check(&closed(&mutated.concat()));
    }
}

#[test]
fn tokens_in_any_order() {
    let mut random = Random(42);
    let all: Vec<String> =
        sources("good").iter().flat_map(|source| tokens(source)).filter(|token| !token.trim().is_empty()).collect();
    for _ in 0..4000 {
        let body: Vec<&str> = (0..random.next(40)).map(|_| all[random.next(all.len())].as_str()).collect();
        let body = closed(&body.join(" "));
        check(&format!("buffer B {{ {body} }}"));
        check(&format!("buffer B {{ resolve |fragments, u| {{ {body} }} }}"));
        check(&format!("buffer B {{ keep 8 least |f, u| {body} ; }}"));
    }
}

#[test]
fn deep_nesting_is_safe() {
    let deep = |open: &str, inner: &str, close: &str, count: usize| {
        format!("buffer B {{ keep 8 least |f| {}{inner}{}; }}", open.repeat(count), close.repeat(count))
    };
    for count in [10, 30, 45, 200, 590, 5_000, 100_000] {
        check(&deep("(", "f.depth", ")", count));
        check(&deep("{", "f.depth", "}", count));
        check(&deep("[", "f.depth", "]", count));
        check(&deep("-", "f.depth", "", count));
        check(&deep("! ", "f.depth", "", count));
        check(&deep("& ", "f.depth", "", count));
        check(&deep("*", "f.depth", "", count));
        check(&deep("f.depth + ", "f.depth", "", count));
        check(&deep("f = ", "f.depth", "", count));
        check(&deep("return ", "f.depth", "", count));
        check(&deep("|f| ", "f.depth", "", count));
        check(&deep("", "f", ".depth", count));
        check(&deep("", "f", ".abs()", count));
        check(&deep("", "f", "[0]", count));
        check(&deep("", "f", " as f32", count));
        check(&deep("", "f", "?", count));
        check(&deep("if f { 1.0 } else ", "{ 2.0 }", "", count));
        check(&deep("if ", "f", " {}", count));
        check(&deep("{} - ", "f", "", count));
        check(&deep("f as A<", "f32", ">", count));
        check(&deep("f as A<u32, ", "f32", ">", count));
        check(&deep("f as fn() -> ", "f32", "", count));
        check(&deep("f as &", "f32", "", count));
        check(&deep("f::<", "f32", ">", count));
        check(&deep("'a: ", "{}", "", count));
        check(&deep("match f ", "{}", "", count));
        check(&deep("unsafe {", "f", "}", count));
        check(&deep("if let A(", "f", ") = f {}", count));
        check(&deep("if let &", "f", " = f {}", count));
        check(&deep("f..", "f", "", count));
        check(&deep("f, ", "f", "", count));
        check(&"(".repeat(count));
        check(&"/*".repeat(count));
        check(&format!("buffer B {{ {} }}", "sync: a else b { c: d } ;".repeat(count.min(2_000))));
        check(&format!("buffer B {{ {} }}", "fn f(x: f32) -> f32 { f(x) }".repeat(count.min(300))));
    }
}

#[test]
fn long_chains_of_helpers() {
    let count = 2_000;
    let functions: String =
        (0..count).map(|index| format!("fn g{index}(x: f32) -> f32 {{ g{}(x) }}\n", (index + 1) % count)).collect();
    let parsed = parse(&format!("buffer B {{ {functions} }}"), "chain");
    assert_eq!(parsed.diagnostics.iter().count(), 1, "one cycle of calls");
}
