//! A study: builds one buffer in a loop over criteria and sizes, and prints the diagnostic of an error in a closure.
//!
//! `cargo run --example builder`

use std::io::Write;
use std::process::ExitCode;

use fragbuf::builder::{Buffer, Closure, Format, UniformType, value};
use fragbuf::{Registry, closure, function};

/// Returns the parts that all variants of the study share.
fn study(k: u32, criterion: Closure) -> Buffer {
    Buffer::named("Study")
        .from("kplus_array")
        .attribute("color", Format::Rgba8)
        .attribute("depth", Format::F32)
        .attribute("normal", Format::Octahedral)
        .uniform("eye", UniformType::Vec3)
        .helper(function!(
            fn facing(n: Vec3, eye: Vec3) -> f32 {
                n.dot(eye).abs()
            }
        ))
        .keep_least(k, criterion)
        .constraint(closure!(|f| f.color.w > 0.0))
        .choose("sync", value("interlock").or_else("spin_lock").option("limit", 4096))
        .resolve(closure!(|fragments, u| {
            let mut sum = Vec4::ZERO;
            for f in fragments {
                let alpha = f.color.w * facing(f.normal, u.eye);
                sum += (1.0 - sum.w) * (f.color.truncate() * alpha).extend(alpha);
            }
            sum
        }))
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
    let criteria = [
        ("nearest", closure!(|f| f.depth)),
        ("most opaque", closure!(|f| -f.color.w)),
        ("facing", closure!(|f, u| f.depth - 0.1 * facing(f.normal, u.eye))),
    ];
    for (name, criterion) in criteria {
        for k in [2, 8] {
            let draft = study(k, criterion.clone()).draft().map_err(|errors| errors.to_string())?;
            let criterion = draft.keep.and_then(|keep| keep.criterion).ok_or("no criterion")?;
            let shader = criterion.wgsl.lines().nth(1).unwrap_or_default().trim().to_owned();
            writeln!(out, "{name}, k = {k}: {shader}")?;
        }
    }
    // Criteria that a program writes as text: the weights of a sweep.
    for weight in [0.125, 0.25] {
        let criterion = Closure::text(format!("|f| f.depth - {weight} * f.color.w"));
        let variant = study(4, criterion).variant(&Registry::builtin()).map_err(|errors| errors.to_string())?;
        writeln!(out, "weight {weight}: keeps {:?}", variant.keep)?;
    }
    let mistaken = study(4, closure!(|f| f.depth - f.colour.w));
    if let Err(errors) = mistaken.variant(&Registry::builtin()) {
        writeln!(out, "\n{errors}")?;
    }
    Ok(())
}
