//! Measures a first build of each crate with its dependencies, in an empty target folder, as wall time and as time of
//! all processors. It compares the DSL crates with those that depend on naga, and asserts nothing.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout, reason = "a bench prints, and fails by panicking")]

use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// Package, and its features.
const BUILDS: [(&str, &[&str]); 6] = [
    ("fragbuf-templates", &[]),
    ("fragbuf-model", &[]),
    ("fragbuf-syntax", &[]),
    ("fragbuf-codegen", &[]),
    ("fragbuf-targets", &[]),
    ("fragbuf", &["--no-default-features"]),
];

fn main() {
    // `cargo test --benches` passes this argument; nothing is measured then.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cold_build");
    println!("{:20} {:>10} {:>14} {:>8}", "package (dev)", "seconds", "of processors", "crates");
    for (package, features) in BUILDS {
        let _ = std::fs::remove_dir_all(&folder);
        let (start, before) = (Instant::now(), processor_seconds());
        let output = Command::new(env!("CARGO"))
            .args(["build", "--offline", "--package", package])
            .args(features)
            .env("CARGO_TARGET_DIR", &folder)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let crates = said.lines().filter(|line| line.trim_start().starts_with("Compiling")).count();
        let processors = before.zip(processor_seconds()).map(|(before, after)| after - before);
        let processors = processors.map_or("unknown".to_owned(), |seconds| format!("{seconds:.1}"));
        println!("{package:20} {seconds:>10.1} {processors:>14} {crates:>8}");
    }
    let _ = std::fs::remove_dir_all(&folder);
}

/// What all child processes so far have taken, where the system tells: Linux counts it in hundredths of a second.
fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name in parentheses may hold spaces; of the fields behind it, the 14th and 15th are the children's.
    let mut fields = stat.rsplit(')').next()?.split_whitespace().skip(13);
    let mut next = || fields.next()?.parse::<f64>().ok();
    Some((next()? + next()?) / 100.0)
}
