//! A study: one buffer, built in a loop over criteria and sizes, and what a mistake in a closure looks like.
//!
//! `cargo run --example builder`

use std::io::Write;

use fragbuf::builder::{Buffer, Closure, Format, UniformType, value};
use fragbuf::{Registry, closure, function};

/// Everything that the variants of the study have in common.
fn described(k: u32, criterion: Closure) -> Buffer {
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
        .admit(closure!(|f| f.color.w > 0.0))
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    report(&mut std::io::stdout())
}

/// Everything that the example prints.
pub fn report(out: &mut impl Write) -> Result<(), Box<dyn std::error::Error>> {
    let criteria = [
        ("nearest", closure!(|f| f.depth)),
        ("most opaque", closure!(|f| -f.color.w)),
        ("facing", closure!(|f, u| f.depth - 0.1 * facing(f.normal, u.eye))),
    ];
    for (name, criterion) in criteria {
        for k in [2, 8] {
            let draft = described(k, criterion.clone()).draft().map_err(|faults| faults.to_string())?;
            let criterion = draft.keep.and_then(|keep| keep.criterion).ok_or("no criterion")?;
            let shader = criterion.wgsl.lines().nth(1).unwrap_or_default().trim().to_owned();
            writeln!(out, "{name}, k = {k}: {shader}")?;
        }
    }
    // Criteria that a program makes: every weight of a sweep.
    for weight in [0.125, 0.25] {
        let criterion = Closure::text(format!("|f| f.depth - {weight} * f.color.w"));
        let variant = described(4, criterion).variant(&Registry::builtin()).map_err(|faults| faults.to_string())?;
        writeln!(out, "weight {weight}: keeps {:?}", variant.keep)?;
    }
    let mistaken = described(4, closure!(|f| f.depth - f.colour.w));
    if let Err(faults) = mistaken.variant(&Registry::builtin()) {
        writeln!(out, "\n{faults}")?;
    }
    Ok(())
}
