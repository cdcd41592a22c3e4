//! rustc is the second judge: every good description, as the macro emits it, is Rust that compiles with glam's types;
//! and of what our checker refuses in a closure, rustc refuses the same or accepts it for a reason that is named here.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use proc_macro2::TokenStream;

/// A file that has every good description as one module, unchecked by the registry: what the language's own tests read
/// need not be a whole variant.
#[test]
fn every_good_description_is_rust_that_compiles() {
    let mut text = String::from("//! Written by a test.\n#![allow(warnings)]\n\n");
    let mut count = 0;
    for path in good() {
        let description = std::fs::read_to_string(&path).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let tokens: TokenStream = format!("[fragbuf_dsl] {description}").parse().unwrap();
        let module =
            fragbuf_expansion::unchecked_fragment_buffer(tokens).unwrap_or_else(|| panic!("{name} is refused"));
        let _ = writeln!(text, "// {name}\n{module}\n");
        count += 1;
    }
    assert!(count >= 25, "only {count} descriptions");
    text.push_str("fn main() {}\n");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("good_descriptions.rs");
    std::fs::write(&file, text).unwrap();
    let cases = trybuild::TestCases::new();
    cases.pass(file);
    cases.pass("tests/ui_pass/*.rs");
}

fn good() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("syntax/tests/good");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "fragbuf"));
    paths.sort();
    paths
}

/// What rustc says of a closure that we refuse.
enum Rustc {
    Refuses,
    /// It accepts, and why we do not.
    Accepts(&'static str),
}

use Rustc::{Accepts, Refuses};

/// Bodies of `fn(f: Fragment, u: Uniforms) -> f32` that we refuse.
const REFUSED: &[(&str, Rustc)] = &[
    // Types.
    ("f.depth + f.id", Refuses),
    ("f.depth + 1", Refuses),
    ("f.id as f32 * 2", Refuses),
    ("f.depth > 0.5", Refuses),
    ("{ let n: u32 = f.depth; n as f32 }", Refuses),
    ("if f.depth { 1.0 } else { 0.0 }", Refuses),
    ("if f.id > 1 { f.depth } else { f.id }", Refuses),
    ("-f.id as f32", Refuses),
    ("!f.depth", Refuses),
    ("f.depth & 1", Refuses),
    ("(f.id > 0) as f32", Refuses),
    ("f.depth as bool", Refuses),
    ("f[0]", Refuses),
    ("f.depth.x", Refuses),
    ("f", Refuses),
    ("{ for i in 0..f.depth { } 1.0 }", Refuses),
    ("{ let x = 2.0; x.sqrt() }", Refuses),
    // Values and paths.
    ("{ f.depth; }", Refuses),
    ("{ if f.depth > 0.5 { return 1.0; } }", Refuses),
    ("{ return; }", Refuses),
    ("if f.depth > 0.5 { 1.0 }", Refuses),
    ("{ break; }", Refuses),
    // Names.
    ("f.deph", Refuses),
    ("u.cutt", Refuses),
    ("f.depth.squareroot()", Refuses),
    ("weigth(f.depth)", Refuses),
    ("depth", Refuses),
    // Arguments.
    ("f.depth.max()", Refuses),
    ("f.depth.clamp(0.0)", Refuses),
    ("twice(f.depth, 1.0)", Refuses),
    ("twice(f.id)", Refuses),
    // Assignments.
    ("{ let x = 1.0; x += f.depth; x }", Refuses),
    ("{ f.depth = 1.0; f.depth }", Refuses),
    ("{ u.cut = 1.0; f.depth }", Refuses),
    ("{ 1.0 = f.depth; f.depth }", Refuses),
    // Ranges of numbers.
    ("5000000000u32 as f32", Refuses),
    ("(f.id << 32) as f32", Refuses),
    ("(f.id / 0) as f32", Refuses),
    ("(4294967295u32 + 1) as f32", Refuses),
    // What Rust has and a shader has not.
    ("match f.id { _ => 1.0 }", Accepts("`match` is not part of the language")),
    ("{ let mut n = 0; while n < 3 { n += 1; } n as f32 }", Accepts("the end of a `while` cannot be read")),
    ("loop { break 1.0; }", Accepts("the end of a `loop` cannot be read")),
    ("{ let (a, b) = (1.0, 2.0); a + b * f.depth }", Accepts("tuples are not part of the language")),
    ("{ let a = [1.0, f.depth]; a[1] }", Accepts("arrays are not part of the language")),
    ("*&f.depth", Accepts("references are not part of the language")),
    ("(f.depth as f64) as f32", Accepts("shaders have no `f64`")),
    ("f.depth.round()", Accepts("rounds halves otherwise in a shader")),
    ("f.depth.powi(2)", Accepts("no power of a negative number in a shader")),
    ("f32::INFINITY", Accepts("shaders may assume that all numbers are finite")),
    ("f.depth.cbrt()", Accepts("has no counterpart in a shader")),
    ("[f].iter().map(|f| f.depth).sum()", Accepts("closures inside closures are not part of the language")),
    ("f.depth + 1.0 / 0.0", Accepts("a constant that is not finite is an error in WGSL")),
];

#[test]
fn what_rustc_refuses_we_refuse() {
    let judged = |index: usize| {
        let (body, rustc) = &REFUSED[index];
        assert!(!we_accept(body), "we accept: {body}");
        match rustc {
            Refuses => assert!(!rustc_accepts(body, index), "rustc accepts, and no reason is given: {body}"),
            Accepts(why) => assert!(rustc_accepts(body, index), "rustc refuses, too: {body} ({why})"),
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for first in 0..threads {
            scope.spawn(move || (first..REFUSED.len()).step_by(threads).for_each(judged));
        }
    });
    // That rustc can accept at all, so that refusing means something.
    assert!(we_accept("twice(f.depth - u.cut)") && rustc_accepts("twice(f.depth - u.cut)", REFUSED.len()));
}

fn we_accept(body: &str) -> bool {
    let text = format!(
        "buffer B {{ fragment {{ depth: f32, id: u32 }} uniform {{ cut: f32 }}
            fn twice(x: f32) -> f32 {{ x * 2.0 }}
            fn judged(f: Fragment, u: Uniforms) -> f32 {{ {body} }} }}"
    );
    fragbuf_dsl::parse(&text, "judged").diagnostics.is_empty()
}

/// As plain Rust, without anything of ours.
fn rustc_accepts(body: &str, index: usize) -> bool {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let file = folder.join(format!("judged_{index}.rs"));
    let text = format!(
        "#![allow(warnings)]
        #[derive(Clone, Copy)] pub struct Fragment {{ pub depth: f32, pub id: u32 }}
        #[derive(Clone, Copy)] pub struct Uniforms {{ pub cut: f32 }}
        fn twice(x: f32) -> f32 {{ x * 2.0 }}
        pub fn judged(f: Fragment, u: Uniforms) -> f32 {{ {body} }}"
    );
    std::fs::write(&file, text).unwrap();
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc)
        .args(["--edition", "2024", "--crate-type", "lib", "--emit", "obj", "--out-dir"])
        .arg(folder)
        .arg(&file)
        .output()
        .unwrap();
    output.status.success()
}
