//! What a first build costs: each crate with everything under it, in an empty target folder, as wall time and as time of
//! all processors. The DSL crates stand beside those that bring naga in; nothing here is asserted.
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
    ("fragbuf-backends", &[]),
    ("fragbuf", &["--no-default-features"]),
];

fn main() {
    // `cargo test --benches` passes this, and wants nothing measured.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cold_build");
    println!("{:20} {:>10} {:>8}", "package (dev)", "seconds", "crates");
    for (package, features) in BUILDS {
        let _ = std::fs::remove_dir_all(&folder);
        let start = Instant::now();
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
        println!("{package:20} {seconds:>10.1} {crates:>8}");
    }
    let _ = std::fs::remove_dir_all(&folder);
}
