//! Writes the Rust bindings of generated passes: entry points and sources, binding numbers, buffer sizes, block layouts.

use std::collections::BTreeSet;
use std::fmt::Write;

use fragbuf_codegen::{Plan, PlanValue, Quantity, SymbolId};
use fragbuf_model::{UniformBlock, UniformType};
use fragbuf_targets::{File, Generation, PlanForTargets};

use super::rust;

/// The lints that bindings may cause in the caller's crate: names of user files are kept, and a crate need not use every binding.
const ALLOWED: &str =
    "dead_code, non_upper_case_globals, unreachable_pub, unused_imports, unused_parens, clippy::all, clippy::pedantic";

/// Returns a module `name` of bindings for a generation from `source`. Paths of files begin with `folder`, relative to the
/// Rust file. A plan is a module `plan`, with a number if targets have different plans; each target is a module with one
/// module per pass.
pub fn bindings(name: &str, source: &str, generation: &Generation, group: u32, folder: &str) -> String {
    let mut text = format!("\n/// Generated from `{source}`.\n#[allow({ALLOWED})]\npub mod {name} {{\n");
    for (index, planned) in generation.plans.iter().enumerate() {
        plan(&plan_name(index), &planned.plan, group, &mut text);
    }
    for (index, planned) in generation.plans.iter().enumerate() {
        for target in &planned.targets {
            let files: Vec<&File> = generation.files.iter().filter(|file| file.target == target.name).collect();
            target_module(target.name, &plan_name(index), planned, &files, folder, &mut text);
        }
    }
    text.push_str("}\n");
    text
}

/// Returns the name of the module that [`bindings`] writes for a description, a target, a pass or a buffer, if no other has the same name.
pub fn module_name(name: &str) -> String {
    rust::snake_case(name)
}

/// Returns the parameters of the function that [`bindings`] writes for a formula of a plan, in order.
pub fn size_parameters(formula: &Quantity, plan: &Plan) -> Vec<SymbolId> {
    rust::formula(formula, &plan.symbols).parameters
}

fn plan_name(index: usize) -> String {
    if index == 0 { "plan".to_owned() } else { format!("plan_{index}") }
}

fn plan(name: &str, plan: &Plan, group: u32, text: &mut String) {
    let axes = plan.selection.describe();
    let _ = write!(text, "\n    /// {}: {axes}.\n    pub mod {name} {{\n", plan.variant.name.value);
    let _ = writeln!(text, "        /// The bind group of all declarations.\n        pub const GROUP: u32 = {group};");
    let mut names = Names::with("GROUP");
    for (constant, value) in &plan.constants {
        let name = names.fresh(rust::identifier(constant));
        let _ = writeln!(text, "        /// `{constant}` of the shaders.\n        pub const {name}: u32 = {value};");
    }
    blocks(plan, text);
    vertex(plan, text);
    buffers(plan, text);
    text.push_str("    }\n");
}

/// Writes the uniform blocks: byte offsets of their fields, and sizes that are valid on every target.
fn blocks(plan: &Plan, text: &mut String) {
    let fields = plan.fields.iter().map(|id| (plan.symbols.get(*id).name.to_string(), UniformType::U32));
    let frame: Vec<(String, UniformType)> = fields.collect();
    block("frame", "The size of the frame and the other values that the host sets for it", 0, &frame, text);
    let user: Vec<(String, UniformType)> =
        plan.variant.uniforms.iter().map(|u| (u.name.value.clone(), u.kind.value)).collect();
    if !user.is_empty() {
        block("uniforms", "The uniforms of the description", 1, &user, text);
    }
    text.push_str(
        "\n        /// One matrix, column after column: transforms vertex positions to clip space.\n        pub mod camera {\n\
        \x20           /// The binding.\n            pub const BINDING: u32 = 2;\n\
        \x20           /// Bytes of the block.\n            pub const SIZE: u64 = 64;\n        }\n",
    );
}

fn block(name: &str, summary: &str, binding: u32, fields: &[(String, UniformType)], text: &mut String) {
    let _ = write!(text, "\n        /// {summary}.\n        pub mod {name} {{\n");
    let _ = writeln!(text, "            /// The binding.\n            pub const BINDING: u32 = {binding};");
    let UniformBlock { offsets, size } = UniformBlock::of_types(fields.iter().map(|(_, kind)| *kind));
    let mut names = Names::with("SIZE");
    for ((field, kind), offset) in fields.iter().zip(offsets) {
        let constant = names.fresh(format!("{}_OFFSET", field.to_ascii_uppercase()));
        let _ = writeln!(text, "            /// Byte offset of `{field}`, {}.", kind.wgsl_type());
        let _ = writeln!(text, "            pub const {constant}: u64 = {offset};");
    }
    let _ =
        writeln!(text, "            /// Bytes of the block.\n            pub const SIZE: u64 = {size};\n        }}");
}

/// Writes the locations of the vertex stage's inputs.
fn vertex(plan: &Plan, text: &mut String) {
    text.push_str("\n        /// Locations of the inputs of geometry passes.\n        pub mod vertex {\n");
    text.push_str("            /// vec3<f32>\n            pub const POSITION: u32 = 0;\n");
    let inputs = plan.variant.attributes.iter().filter(|attribute| attribute.is_vertex_input());
    let mut names = Names::with("POSITION");
    for (location, attribute) in (1..).zip(inputs) {
        let name = names.fresh(attribute.name.value.to_ascii_uppercase());
        let kind = attribute.format.value.wgsl_type();
        let _ = writeln!(text, "            /// {kind}\n            pub const {name}: u32 = {location};");
    }
    text.push_str("        }\n");
}

/// Writes the buffers: binding numbers, and sizes as functions of the values known at allocation.
fn buffers(plan: &Plan, text: &mut String) {
    text.push_str("\n        /// Buffers and textures.\n        pub mod buffers {\n");
    let mut names = Names::with("");
    let mut used = BTreeSet::new();
    for planned in &plan.resources {
        let (name, resource) = (names.fresh(rust::snake_case(&planned.resource.name)), &planned.resource);
        let size = rust::formula(&planned.words, &plan.symbols);
        let _ =
            writeln!(text, "            /// `{}`: {}.\n            pub mod {name} {{", resource.name, resource.summary);
        let binding = planned.binding;
        let _ = writeln!(text, "                /// The binding.\n                pub const BINDING: u32 = {binding};");
        let _ = writeln!(text, "                /// Bytes: 4 * ({}).", planned.words);
        function("bytes", &size, "4 * ", 4, plan, text);
        text.push_str("            }\n");
        used.extend(size.parameters);
    }
    text.push_str("        }\n");
    defaults(used, plan, text);
}

/// Writes the values that symbols have unless the host sets others, for parameters of sizes.
fn defaults(used: BTreeSet<SymbolId>, plan: &Plan, text: &mut String) {
    let of = |id: SymbolId| match &plan.symbols.get(id).value {
        PlanValue::Default(quantity) => Some((id, quantity)),
        _ => None,
    };
    let defaults: Vec<(SymbolId, &Quantity)> = used.into_iter().filter_map(of).collect();
    if defaults.is_empty() {
        return;
    }
    text.push_str("\n        /// The values of parameters, unless the host sets others.\n        pub mod defaults {\n");
    for (id, quantity) in defaults {
        let symbol = plan.symbols.get(id);
        let _ = writeln!(text, "            /// `{}`, {}: {quantity}.", symbol.name, symbol.meaning);
        let value = rust::formula(quantity, &plan.symbols);
        function(&rust::identifier(&symbol.name), &value, "", 3, plan, text);
    }
    text.push_str("        }\n");
}

/// Writes a constant function of a formula, with the meaning of each parameter.
fn function(name: &str, of: &rust::RustFormula, factor: &str, level: usize, plan: &Plan, text: &mut String) {
    let indent = "    ".repeat(level);
    let symbols: Vec<_> = of.parameters.iter().map(|id| plan.symbols.get(*id)).collect();
    if !symbols.is_empty() {
        let _ = writeln!(text, "{indent}///");
    }
    for symbol in &symbols {
        let _ = writeln!(text, "{indent}/// * `{}`: {}.", symbol.name, symbol.meaning);
    }
    let parameters: Vec<String> = symbols.iter().map(|symbol| format!("{}: u64", symbol.name)).collect();
    let _ = writeln!(text, "{indent}pub const fn {name}({}) -> u64 {{", parameters.join(", "));
    let _ = writeln!(text, "{indent}    {factor}{}\n{indent}}}", of.value);
}

fn target_module(target: &str, plan: &str, planned: &PlanForTargets, files: &[&File], folder: &str, text: &mut String) {
    let name = rust::snake_case(target);
    let _ =
        write!(text, "\n    /// The passes of a frame for the target `{target}`, in order.\n    pub mod {name} {{\n");
    let _ = writeln!(text, "        pub use super::{plan}{};", if plan == "plan" { "" } else { " as plan" });
    let mut names = Names::with("plan");
    for pass in &planned.plan.passes {
        let _ = write!(
            text,
            "\n        /// The pass `{0}`.\n        pub mod {1} {{\n",
            pass.name,
            names.fresh(rust::snake_case(&pass.name))
        );
        for file in files.iter().filter(|file| file.pass == pass.name) {
            for (stage, entry_point) in &file.entry_points {
                stage_constants(stage, entry_point, &format!("{folder}/{}", file.path), text);
            }
        }
        text.push_str("        }\n");
    }
    text.push_str("    }\n");
}

/// The names of one module. Rust accepts each name once, but names of a description may differ only by case.
struct Names(Vec<String>);

impl Names {
    fn with(taken: &str) -> Self {
        Names(vec![taken.to_owned()])
    }

    /// Returns the name, with `_` appended until it is unique.
    fn fresh(&mut self, mut name: String) -> String {
        while self.0.contains(&name) {
            name.push('_');
        }
        self.0.push(name.clone());
        name
    }
}

fn stage_constants(stage: &str, entry_point: &str, path: &str, text: &mut String) {
    let constant = stage.to_ascii_uppercase();
    let (kind, include) = if path.ends_with(".spv") { ("&[u8]", "include_bytes") } else { ("&str", "include_str") };
    let _ = writeln!(text, "            /// The entry point of the {stage} stage.");
    let _ = writeln!(text, "            pub const {constant}_ENTRY_POINT: &str = {entry_point:?};");
    let _ = writeln!(text, "            /// The file of the {stage} stage.");
    let _ = writeln!(text, "            pub const {constant}: {kind} = {include}!({path:?});");
}
