//! Generates how a closure of the effect is called by its parts, where peeling passes fragments on in several iterations.

use std::fmt::Write;

use fragbuf_model::Resumable;
use fragbuf_model::resumable::{PROGRESS, Progress, RESULT, RESUMED, components};
use fragbuf_templates::vocabulary::Capability;

use crate::Plan;

/// Returns the parts of the closure if a row of the plan interrupts the effect.
pub(super) fn interrupted(plan: &Plan) -> Option<&Resumable> {
    let mut rows = plan.selection.rows.iter();
    let is_interrupted = rows.any(|selected| selected.row.requires.contains(&Capability::Resumes));
    plan.variant.resolve.as_ref().filter(|_| is_interrupted)?.resumable()
}

/// Generates the functions of the effect's contract that call the parts.
pub(super) fn text(parts: &Resumable, text: &mut String) {
    let [begin, advance, end] = parts.parts().map(|part| &part.name);
    let [not_begun, in_loop, after_loop, returned] =
        [Progress::NotBegun, Progress::InLoop, Progress::AfterLoop, Progress::Returned].map(Progress::wgsl);
    text.push_str("/// What the effect keeps between the iterations of peeling.\nstruct Resumed {\n");
    for (name, ty) in &parts.members {
        let _ = writeln!(text, "    {name}: {ty},");
    }
    let _ = writeln!(text, "}}\n\nvar<private> {RESUMED}: Resumed;\n");
    memory(parts, text);
    let _ = writeln!(
        text,
        "fn resolve_layers() -> vec4<f32> {{
    let pixel = peeling_pixel();
    resumed_load(pixel);
    // {not_begun}: the effect has not begun; {in_loop}: it reads fragments; {after_loop}: its loop has ended; {returned}: it has returned.
    if {RESUMED}.{PROGRESS} == {not_begun} {{
        {begin}();
        {RESUMED}.{PROGRESS} = {in_loop};
    }}
    if {RESUMED}.{PROGRESS} == {in_loop} {{
        {advance}();
    }}
    resumed_save(pixel);
    // The result is that after the last iteration.
    return vec4<f32>(0.0);
}}
"
    );
    let has_result = parts.members.iter().any(|(name, _)| name == RESULT);
    let early = match has_result {
        true => format!("    if {RESUMED}.{PROGRESS} == {returned} {{\n        return {RESUMED}.{RESULT};\n    }}\n"),
        false => String::new(),
    };
    let _ = writeln!(
        text,
        "fn resolve_result(pixel: u32) -> vec4<f32> {{
    resumed_load(pixel);
    if {RESUMED}.{PROGRESS} == {not_begun} {{
        // The pixel has no fragments.
        return vec4<f32>(0.0);
    }}
{early}    return {end}();
}}
"
    );
}

/// Generates the functions that read and write the members as words.
fn memory(parts: &Resumable, text: &mut String) {
    let (mut load, mut save) = (String::new(), String::new());
    let mut word = 0;
    for (name, ty) in &parts.members {
        let count = components(ty);
        for component in 0..count {
            let part = match count {
                1 => format!("{RESUMED}.{name}"),
                _ => format!("{RESUMED}.{name}.{}", ["x", "y", "z", "w"][component as usize % 4]),
            };
            let saved = format!("peeling_word({word}u, pixel)");
            let (loaded, stored) = match ty.as_str() {
                "u32" => (saved, part.clone()),
                "bool" => (format!("{saved} != 0u"), format!("select(0u, 1u, {part})")),
                "i32" => (format!("bitcast<i32>({saved})"), format!("bitcast<u32>({part})")),
                _ => (format!("bitcast<f32>({saved})"), format!("bitcast<u32>({part})")),
            };
            let _ = writeln!(load, "    {part} = {loaded};");
            let _ = writeln!(save, "    peeling_save({word}u, pixel, {stored});");
            word += 1;
        }
    }
    let _ = writeln!(text, "fn resumed_load(pixel: u32) {{\n{load}}}\n\nfn resumed_save(pixel: u32) {{\n{save}}}\n");
}
