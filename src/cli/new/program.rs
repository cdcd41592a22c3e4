//! The program of a new crate: it lists the passes of a frame and the sizes of its buffers, through the bindings.
//!
//! Input: the generated passes. Output: the text of `main.rs`.

use std::fmt::Write;

use fragbuf::build::{module_name, size_parameters};
use fragbuf::{Generation, Plan, Target};
use fragbuf_codegen::{PlanValue, SymbolId};

/// Returns the program of the crate `name`, whose bindings are in `module`.
pub(super) fn main(module: &str, name: &str, generation: &Generation, target: &Target) -> String {
    let mut text = format!(
        "//! Lists the passes of `{name}.fragbuf` and the memory of a frame.\n\n\
         // The module `{module}`, which build.rs writes: sources, entry points and bindings.\n\
         include!(concat!(env!(\"OUT_DIR\"), \"/fragbuf.rs\"));\n\nfn main() {{\n    use {module}::{} as passes;\n\n",
        module_name(target.name)
    );
    text += "    // In the order of a frame. The manifest of `fragbuf generate` states how an engine runs them.\n";
    text += "    let stages = [\n";
    for planned in &generation.plans {
        for pass in &planned.plan.passes {
            for file in generation.files.iter().filter(|file| file.pass == pass.name) {
                for (stage, _) in &file.entry_points {
                    let (constant, pass_module) = (stage.to_ascii_uppercase(), module_name(&pass.name));
                    let path = format!("passes::{pass_module}::{constant}");
                    let _ = writeln!(text, "        ({:?}, {stage:?}, {path}_ENTRY_POINT, {path}.len()),", pass.name);
                }
            }
        }
    }
    text += "    ];\n    for (pass, stage, entry_point, bytes) in stages {\n        \
             println!(\"{pass:12} {stage:9} {entry_point:20} {bytes:7} bytes of source\");\n    }\n\n";
    if let Some(planned) = generation.plans.first() {
        sizes(&planned.plan, &mut text);
    }
    text + "}\n"
}

/// Writes the sizes of the buffers of a frame of 1280 × 720 pixels.
fn sizes(plan: &Plan, text: &mut String) {
    let (mut values, mut rows) = (Vec::new(), String::new());
    for planned in plan.resources.iter().filter(|planned| !planned.is_external()) {
        let arguments = arguments(&size_parameters(&planned.words, plan), plan, &mut values);
        let name = &planned.resource.name;
        let _ = writeln!(rows, "        ({name:?}, passes::plan::buffers::{}::bytes({arguments})),", module_name(name));
    }
    if rows.is_empty() {
        return;
    }
    *text += "    // What the sizes of the buffers depend on.\n";
    for (_, line) in values {
        let _ = writeln!(text, "    {line}");
    }
    let _ = write!(
        text,
        "    let buffers = [\n{rows}    ];\n    for (buffer, bytes) in buffers {{\n        \
         println!(\"{{buffer:12}} {{bytes:10}} bytes\");\n    }}\n"
    );
}

/// Returns the arguments for parameters, and adds the values that they need to `values`, each after those that it depends on.
fn arguments(parameters: &[SymbolId], plan: &Plan, values: &mut Vec<(SymbolId, String)>) -> String {
    for id in parameters {
        if values.iter().any(|(known, _)| known == id) {
            continue;
        }
        let symbol = plan.symbols.get(*id);
        let value = match (&symbol.value, *id) {
            (_, SymbolId::WIDTH) => "1280".to_owned(),
            (_, SymbolId::HEIGHT) => "720".to_owned(),
            (PlanValue::Number(number), _) => number.to_string(),
            (PlanValue::Default(quantity), _) => {
                let needed = arguments(&size_parameters(quantity, plan), plan, values);
                format!("passes::plan::defaults::{}({needed})", module_name(&symbol.name))
            }
            // Only the program can know how many fragments its scene has.
            (PlanValue::Open, _) => "4 * 1280 * 720".to_owned(),
        };
        values.push((*id, format!("let {} = {value}; // {}", symbol.name, symbol.meaning)));
    }
    let names: Vec<&str> = parameters.iter().map(|id| &*plan.symbols.get(*id).name).collect();
    names.join(", ")
}
