//! Describes two buffers in one crate, calls their closures on the CPU and generates their passes.
//!
//! `cargo run --example two_buffers`

use std::io::Write;
use std::process::ExitCode;

use fragbuf::glam::Vec4;
use fragbuf::{Form, Registry, Request, Variant, fragment_buffer, generate, target};

fragment_buffer! {
    /// The eight most visible fragments in front of a plane: opaque ones count as nearer.
    buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32 }
        uniform { far: f32 }
        keep 8 least |f| f.depth - 0.25 * f.color.w;
        where |f, u| f.depth < u.far;
    }
}

fragment_buffer! {
    /// The thickness of matter along a ray: entry and exit fragments alternate.
    buffer Thickness from ab_ll {
        fragment { depth: f32 }
        uniform { density: f32 }
        fn transmittance(thickness: f32, density: f32) -> f32 { (-density * thickness).exp() }
        resolve |fragments, u| {
            let mut thickness = 0.0;
            let mut sign = -1.0;
            for f in fragments {
                thickness += sign * f.depth;
                sign = -sign;
            }
            let through = transmittance(thickness, u.density);
            vec4(through, through, through, 1.0)
        }
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // `Result` as the type of `main` prints the `Debug` form. There is no other stream to report a failure of this one on.
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn std::error::Error>> {
    report(&mut std::io::stdout())
}

/// Prints the output of the example.
pub fn report(out: &mut impl Write) -> Result<(), Box<dyn std::error::Error>> {
    let uniforms = glass::Uniforms { far: 0.9, ..Default::default() };
    for (alpha, depth) in [(1.0, 0.5), (0.25, 0.4), (0.5, 0.95)] {
        let fragment = glass::Fragment { color: Vec4::new(1.0, 1.0, 1.0, alpha), depth };
        let enters = glass::constraint_0(&fragment, &uniforms);
        let criterion = glass::criterion(&fragment, &uniforms);
        writeln!(out, "glass: alpha {alpha:.2} at {depth:.2}: enters {enters}, criterion {criterion:.4}")?;
    }
    let layers = [0.25, 0.5, 0.625, 0.75].map(|depth| thickness::Fragment { depth });
    let through = thickness::resolve(&layers, &thickness::Uniforms { density: 2.0, ..Default::default() });
    writeln!(out, "thickness: a ray through two bodies keeps {:.4} of its light", through.x)?;

    for (prefix, variant) in [("glass_", glass::variant()), ("thickness_", thickness::variant())] {
        let variant = variant.map_err(|errors| errors.to_string())?;
        passes(&variant, prefix, out)?;
    }
    writeln!(out, "uniform blocks: {} and {} bytes", glass::Uniforms::SIZE, thickness::Uniforms::SIZE)?;
    Ok(())
}

/// Prints the passes of a buffer. The prefix keeps its names distinct, so that one shader may contain both buffers.
fn passes(variant: &Variant, prefix: &str, out: &mut impl Write) -> Result<(), Box<dyn std::error::Error>> {
    let wgsl = target("wgsl").ok_or("no such target")?;
    let request = Request { targets: &[wgsl], form: Form::Program, prefix, group: 0 };
    let generation = generate(variant, &request, &Registry::builtin()).map_err(|errors| errors.to_string())?;
    for file in &generation.files {
        let lines = file.bytes.iter().filter(|byte| **byte == b'\n').count();
        writeln!(out, "{}: pass {}, {lines} lines of WGSL", variant.name.value, file.pass)?;
    }
    Ok(())
}
