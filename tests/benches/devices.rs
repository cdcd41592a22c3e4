//! Compares the CPU device with the software driver: milliseconds of each pass, of all passes, and of the whole command, as ratios.
//! The whole command has everything in it: the scene, compilation, opening the device, the PNG.
//!
//! `FRAGBUF_SCENE=dragon.ply.gz cargo bench --bench devices` measures a model instead of the generated scenes.
#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a bench prints, and fails by panicking"
)]

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

/// Technique, scene, size, and its description.
const CASES: [(&str, &str, &str, &str); 5] = [
    ("kplus_array", "builtin:cubes", "512x512", "36 triangles"),
    ("ab_ll", "builtin:cubes", "512x512", "36 triangles"),
    // As many triangles as the dragon of the papers has, within 2 %.
    ("kplus_array", "builtin:marbles,n=22", "512x512", "48,576 triangles"),
    ("ab_ll", "builtin:marbles,n=22", "512x512", "48,576 triangles"),
    ("kplus_array", "builtin:slabs,n=40", "512x512", "40 layers"),
];

/// Runs of each, of which the fastest counts.
const RUNS: usize = 3;

/// Milliseconds of the command, and of each pass.
struct Times {
    command: f64,
    passes: Vec<(String, f64)>,
}

impl Times {
    fn passes(&self) -> f64 {
        self.passes.iter().map(|(_, milliseconds)| milliseconds).sum()
    }
}

fn run(device: &str, (key, scene, size, _): (&str, &str, &str, &str)) -> Times {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bench.png");
    let start = Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_fragbuf"))
        .args([
            "render",
            key,
            "--set",
            "counters=losses",
            "--scene",
            scene,
            "--size",
            size,
            "--device",
            device,
            "--json",
            "--out",
        ])
        .arg(out)
        .output()
        .unwrap();
    let command = start.elapsed().as_secs_f64() * 1000.0;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
    let passes = figures["ms"].as_object().unwrap();
    Times { command, passes: passes.iter().map(|(pass, ms)| (pass.clone(), ms.as_f64().unwrap())).collect() }
}

fn fastest(device: &str, case: (&str, &str, &str, &str)) -> Times {
    let runs = (0..RUNS).map(|_| run(device, case));
    runs.min_by(|a, b| a.passes().total_cmp(&b.passes())).unwrap()
}

/// The generated scenes, or the model that the environment names.
fn cases(model: Option<&str>) -> Vec<(&'static str, &str, &'static str, &'static str)> {
    match model {
        Some(model) => ["kplus_array", "ab_ll"].map(|key| (key, model, "512x512", "a model")).to_vec(),
        None => CASES.to_vec(),
    }
}

fn main() {
    let model = std::env::var("FRAGBUF_SCENE").ok();
    for case in cases(model.as_deref()) {
        let (key, scene, size, what) = case;
        let (own, driver) = (fastest("cpu", case), fastest("llvmpipe", case));
        println!("{key}, {scene} ({what}), {size}, in milliseconds: cpu / llvmpipe");
        for ((pass, own), (_, driver)) in own.passes.iter().zip(&driver.passes) {
            println!("    {pass:12} {own:9.1} / {driver:9.1} = {:6.2}", own / driver);
        }
        let (a, b) = (own.passes(), driver.passes());
        println!("    {:12} {a:9.1} / {b:9.1} = {:6.2}", "all passes", a / b);
        println!(
            "    {:12} {:9.1} / {:9.1} = {:6.2}",
            "command",
            own.command,
            driver.command,
            own.command / driver.command
        );
    }
}
