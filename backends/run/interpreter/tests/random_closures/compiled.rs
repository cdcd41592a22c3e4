//! Compiles programs by rustc, with glam, and runs them.

use std::fmt::Write;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::generator::Program;
use super::types::{ATTRIBUTES, FRAGMENTS, Type, UNIFORMS, words_of};
use super::value::Input;

/// Whether arithmetic panics where it overflows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OverflowChecks {
    On,
    Off,
}

/// The source before the programs: what the macro of fragbuf generates for a buffer, and the words of values.
const PRELUDE: &str = "
#![allow(warnings, arithmetic_overflow, unconditional_panic)]
use glam::*;

#[derive(Clone, Copy)]
struct Fragments<'a>(&'a [Fragment]);

impl<'a> Fragments<'a> {
    fn iter(self) -> std::iter::Copied<std::slice::Iter<'a, Fragment>> { self.0.iter().copied() }
    fn len(self) -> usize { self.0.len() }
    fn is_empty(self) -> bool { self.0.is_empty() }
}

impl<'a> IntoIterator for Fragments<'a> {
    type Item = Fragment;
    type IntoIter = std::iter::Copied<std::slice::Iter<'a, Fragment>>;
    fn into_iter(self) -> Self::IntoIter { self.iter() }
}

impl std::ops::Index<usize> for Fragments<'_> {
    type Output = Fragment;
    fn index(&self, index: usize) -> &Fragment { &self.0[index] }
}

trait Words { fn words(self) -> Vec<u32>; }
impl Words for u32 { fn words(self) -> Vec<u32> { vec![self] } }
impl Words for i32 { fn words(self) -> Vec<u32> { vec![self as u32] } }
impl Words for bool { fn words(self) -> Vec<u32> { vec![self as u32] } }
impl Words for f32 { fn words(self) -> Vec<u32> { vec![self.to_bits()] } }
impl Words for Vec2 { fn words(self) -> Vec<u32> { self.to_array().map(f32::to_bits).to_vec() } }
impl Words for Vec3 { fn words(self) -> Vec<u32> { self.to_array().map(f32::to_bits).to_vec() } }
impl Words for Vec4 { fn words(self) -> Vec<u32> { self.to_array().map(f32::to_bits).to_vec() } }
";

/// Returns the words of every program for every input, or `None` where Rust panics.
pub fn run(programs: &[Program], inputs: &[Input], checks: OverflowChecks) -> Vec<Vec<Option<Vec<u32>>>> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("random_closures_{checks:?}"));
    std::fs::create_dir_all(&folder).unwrap();
    let (source, binary) = (folder.join("main.rs"), folder.join("closures"));
    std::fs::write(&source, text(programs)).unwrap();
    compile(&source, &binary, checks);
    let words: Vec<String> = inputs.iter().flat_map(|input| &input.words).map(u32::to_string).collect();
    let mut child = Command::new(&binary).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(words.join(" ").as_bytes()).unwrap());
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert!(output.status.success(), "{}", output.status);
    let result = |line: &str| match line {
        "panic" => None,
        words => Some(words.split(' ').map(|word| word.parse().unwrap()).collect()),
    };
    let lines: Vec<Option<Vec<u32>>> = String::from_utf8(output.stdout).unwrap().lines().map(result).collect();
    assert_eq!(lines.len(), programs.len() * inputs.len());
    lines.chunks(inputs.len()).map(<[_]>::to_vec).collect()
}

/// Returns the source of a binary that reads inputs and writes a line per program and input.
fn text(programs: &[Program]) -> String {
    let mut text = PRELUDE.to_owned();
    for (name, fields) in [("Fragment", ATTRIBUTES.as_slice()), ("Uniforms", UNIFORMS.as_slice())] {
        let _ = writeln!(text, "#[derive(Clone, Copy)]\nstruct {name} {{");
        fields.iter().for_each(|(name, ty)| writeln!(text, "    {name}: {},", ty.rust()).unwrap());
        let _ = writeln!(text, "}}\nfn {}(words: &[u32]) -> {name} {{\n    {name} {{", name.to_lowercase());
        let mut at = 0;
        for (name, ty) in fields {
            let _ = writeln!(text, "        {name}: {},", value(*ty, at));
            at += ty.words();
        }
        text.push_str("    }\n}\n");
    }
    programs.iter().for_each(|program| text.push_str(&program.rust()));
    let (uniforms, attributes) = (words_of(&UNIFORMS), words_of(&ATTRIBUTES));
    let _ = write!(
        text,
        "fn show(run: impl FnOnce() -> Vec<u32>) {{
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(run)) {{
        Ok(words) => println!(\"{{}}\", words.iter().map(u32::to_string).collect::<Vec<_>>().join(\" \")),
        Err(_) => println!(\"panic\"),
    }}
}}
fn main() {{
    std::panic::set_hook(Box::new(|_| ()));
    let text = std::io::read_to_string(std::io::stdin()).unwrap();
    let words: Vec<u32> = text.split(' ').map(|word| word.parse().unwrap()).collect();
    let inputs: Vec<(Uniforms, Vec<Fragment>, usize)> = words.chunks({}).map(|words| {{
        let layers = words[{uniforms}..].chunks({attributes}).take({FRAGMENTS}).map(fragment).collect();
        (uniforms(words), layers, *words.last().unwrap() as usize)
    }}).collect();
",
        Input::size()
    );
    for program in programs {
        let name = program.name();
        let first = if program.is_resolve { "Fragments(&layers[..*count])" } else { "layers[0]" };
        let _ = writeln!(text, "    for (u, layers, count) in &inputs {{ show(|| {name}({first}, *u).words()); }}");
    }
    text.push_str("}\n");
    text
}

fn value(ty: Type, at: usize) -> String {
    match ty {
        Type::U32 => format!("words[{at}]"),
        Type::I32 => format!("words[{at}] as i32"),
        Type::Vector(size) => {
            let parts: Vec<String> = (at..at + size).map(|at| format!("f32::from_bits(words[{at}])")).collect();
            format!("vec{size}({})", parts.join(", "))
        }
        _ => format!("f32::from_bits(words[{at}])"),
    }
}

fn compile(source: &Path, binary: &Path, checks: OverflowChecks) {
    let checks = if checks == OverflowChecks::On { "on" } else { "off" };
    let libraries = libraries();
    let mut messages = String::from("no library of glam beside the test");
    for library in libraries {
        let output = Command::new(rustc())
            .args([
                "--edition",
                "2024",
                "-C",
                "debuginfo=0",
                "-C",
                "opt-level=0",
                "-C",
                &format!("overflow-checks={checks}"),
            ])
            .arg("--extern")
            .arg(format!("glam={}", library.display()))
            .arg("-L")
            .arg(format!("dependency={}", library.parent().unwrap().display()))
            .arg("-o")
            .args([binary, source])
            .output()
            .unwrap();
        if output.status.success() {
            return;
        }
        messages = String::from_utf8_lossy(&output.stderr).into_owned();
    }
    panic!("rustc rejects the programs in {}: {messages}", source.display());
}

/// Returns the compiler beside the cargo that runs the test.
fn rustc() -> PathBuf {
    let beside = std::env::var_os("CARGO").map(|cargo| PathBuf::from(cargo).with_file_name("rustc"));
    beside.filter(|path| path.exists()).unwrap_or_else(|| "rustc".into())
}

/// Returns the compiled libraries of glam, the newest first. Older ones may be of another compiler.
fn libraries() -> Vec<PathBuf> {
    let folder = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let is_glam = |name: &str| name.starts_with("libglam-") && name.ends_with(".rlib");
    let mut found: Vec<_> = entries
        .filter(|entry| is_glam(&entry.file_name().to_string_lossy()))
        .map(|entry| (entry.metadata().unwrap().modified().unwrap(), entry.path()))
        .collect();
    found.sort();
    found.into_iter().rev().map(|(_, path)| path).collect()
}
