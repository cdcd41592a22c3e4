//! Prints a whole unit: first the bodies, which determine the required declarations; then all parts in GLSL's order.
//!
//! Input: a printer and the unit. Output: the GLSL source, which is invalid if the printer has recorded errors.

use std::collections::BTreeSet;

use naga::{EarlyDepthTest, EntryPoint, Function, GlobalVariable, Handle, ShaderStage, Span, TypeInner};

use crate::footprint::{CallFootprints, of_functions};
use crate::function::FunctionPrinter;
use crate::interface::Interface;
use crate::names::unique_name;
use crate::options::Unit;
use crate::printer::Printer;
use crate::reach::reached;

/// Prints a unit.
pub fn print(printer: &mut Printer, unit: Unit) -> String {
    let module = printer.module;
    match unit {
        Unit::Library => {
            let functions = module
                .functions
                .iter()
                .map(|(handle, _)| handle)
                .filter(|handle| printer.marker(*handle).is_none())
                .collect();
            let calls = of_functions(module, &functions, |function| printer.marker(function));
            let bodies = print_functions(printer, &functions, &calls);
            assemble(printer, Vec::new(), Vec::new(), bodies, false)
        }
        Unit::EntryPoint(name) => {
            let Some(index) = module.entry_points.iter().position(|entry| entry.name == name) else {
                return printer.error(format!("no entry point `{name}`"), Span::UNDEFINED);
            };
            printer.has_main = true;
            let entry = &module.entry_points[index];
            let functions = reached(module, &entry.function.body, &|function| printer.marker(function).is_some());
            let calls = of_functions(module, &functions, |function| printer.marker(function));
            let mut bodies = print_functions(printer, &functions, &calls);
            let (main, interface) = print_main(printer, index, &calls);
            bodies.push(main);
            let stage = stage_lines(printer, entry);
            assemble(printer, stage, interface.declarations, bodies, true)
        }
    }
}

fn print_functions(
    printer: &mut Printer,
    functions: &BTreeSet<Handle<Function>>,
    calls: &CallFootprints,
) -> Vec<Vec<String>> {
    functions.iter().map(|function| print_function(printer, *function, calls)).collect()
}

/// Prints a function, with its comments.
fn print_function(printer: &mut Printer, handle: Handle<Function>, calls: &CallFootprints) -> Vec<String> {
    let module = printer.module;
    let info = printer.info;
    let function = &module.functions[handle];
    let above = module.functions.get_span(handle).to_range().map(|range| printer.comments.above(range.start));
    let mut lines: Vec<String> = above.into_iter().flatten().map(str::to_owned).collect();
    lines.extend(printer.documentation(|documentation| documentation.functions.get(&handle)));
    let name = printer.names.functions.get(&handle).cloned().unwrap_or_default();
    let result = match &function.result {
        Some(result) => printer.type_name(result.ty, Span::UNDEFINED),
        None => "void".to_owned(),
    };
    let mut inner = FunctionPrinter::new(printer, function, &info[handle], calls);
    let mut parameters = Vec::new();
    for argument in &function.arguments {
        let name = inner.declare(argument.name.as_deref().unwrap_or("argument"));
        inner.arguments.push(name.clone());
        let (qualifier, ty) = match inner.printer.module.types[argument.ty].inner {
            TypeInner::Pointer { base, space: naga::AddressSpace::Function | naga::AddressSpace::Private } => {
                ("inout ", base)
            }
            TypeInner::Pointer { .. }
            | TypeInner::ValuePointer { .. }
            | TypeInner::Image { .. }
            | TypeInner::Sampler { .. } => {
                inner.printer.error(format!("the argument `{name}`, whose type GLSL cannot pass"), Span::UNDEFINED);
                continue;
            }
            _ => ("", argument.ty),
        };
        parameters.push(format!("{qualifier}{}", inner.printer.declaration(ty, &name, Span::UNDEFINED)));
    }
    lines.push(format!("{result} {name}({}) {{", parameters.join(", ")));
    inner.open_block();
    inner.statements(&function.body, true);
    inner.close_block();
    lines.append(&mut inner.lines);
    lines.push("}".to_owned());
    lines
}

/// Prints an entry point as `main`. Returns its interface too.
fn print_main(printer: &mut Printer, index: usize, calls: &CallFootprints) -> (Vec<String>, Interface) {
    let module = printer.module;
    let info = printer.info;
    let entry = &module.entry_points[index];
    let mut lines = printer.documentation(|documentation| documentation.entry_points.get(&index));
    let interface = printer.interface(entry);
    let mut inner = FunctionPrinter::new(printer, &entry.function, info.get_entry_point(index), calls);
    inner.interface = Some(interface);
    lines.push("void main() {".to_owned());
    inner.open_block();
    inner.assemble_inputs();
    inner.statements(&entry.function.body, true);
    inner.close_block();
    let interface = inner.interface.take().unwrap_or_default();
    let mut body = std::mem::take(&mut inner.lines);
    lines.append(&mut zero_initialisation(printer));
    lines.append(&mut body);
    lines.push("}".to_owned());
    (lines, interface)
}

/// Prints the initialisation to zero that WGSL requires and the GLSL declarations lack.
fn zero_initialisation(printer: &mut Printer) -> Vec<String> {
    let module = printer.module;
    let shared =
        |handle: &Handle<GlobalVariable>| module.global_variables[*handle].space == naga::AddressSpace::WorkGroup;
    let (shared, private): (Vec<_>, Vec<_>) = printer.requirements.globals.iter().copied().partition(shared);
    let mut lines = Vec::new();
    for handle in private.into_iter().filter(|handle| printer.is_long_private_array(*handle)).collect::<Vec<_>>() {
        set_to_zero(printer, handle, "    ", &mut lines);
    }
    if !shared.is_empty() && printer.options.zero_workgroup_memory {
        lines.push("    if (gl_LocalInvocationIndex == 0u) {".to_owned());
        for handle in shared {
            set_to_zero(printer, handle, "        ", &mut lines);
        }
        lines.extend(["    }", "    memoryBarrierShared();", "    barrier();"].map(str::to_owned));
    }
    if !lines.is_empty() {
        lines.insert(0, "    // Variables begin as zero.".to_owned());
        lines.push(String::new());
    }
    lines
}

/// Prints the initialisation of a variable to zero; a loop for an array.
fn set_to_zero(printer: &mut Printer, handle: Handle<GlobalVariable>, indent: &str, lines: &mut Vec<String>) {
    let name = printer.names.globals.get(&handle).cloned().unwrap_or_default();
    let ty = printer.module.global_variables[handle].ty;
    let TypeInner::Array { base, size: naga::ArraySize::Constant(size), .. } = printer.module.types[ty].inner else {
        let zero = printer.zero(ty, Span::UNDEFINED);
        lines.push(format!("{indent}{name} = {zero};"));
        return;
    };
    let index = unique_name("index", |name| printer.names.is_taken(name));
    let zero = printer.zero(base, Span::UNDEFINED);
    lines.push(format!("{indent}for (uint {index} = 0u; {index} < {size}u; {index}++) {{"));
    lines.push(format!("{indent}    {name}[{index}] = {zero};"));
    lines.push(format!("{indent}}}"));
}

/// Returns the layout qualifiers of the stage.
fn stage_lines(printer: &mut Printer, entry: &EntryPoint) -> Vec<String> {
    let mut lines = Vec::new();
    match entry.stage {
        ShaderStage::Vertex | ShaderStage::Fragment => {}
        ShaderStage::Compute => {
            let [x, y, z] = entry.workgroup_size;
            if entry.workgroup_size_overrides.is_some() {
                printer.error("a workgroup size set by an override", Span::UNDEFINED);
            }
            lines.push(format!("layout(local_size_x = {x}, local_size_y = {y}, local_size_z = {z}) in;"));
        }
        other => drop(printer.error(format!("the stage {other:?}"), Span::UNDEFINED)),
    }
    match entry.early_depth_test {
        Some(EarlyDepthTest::Force) => lines.push("layout(early_fragment_tests) in;".to_owned()),
        // The qualifier is a promise to the driver. ES lacks it; without it the depth test is late, which is always correct.
        Some(EarlyDepthTest::Allow { .. }) if printer.es() => {}
        Some(EarlyDepthTest::Allow { conservative }) => {
            let condition = match conservative {
                naga::ConservativeDepth::GreaterEqual => "greater",
                naga::ConservativeDepth::LessEqual => "less",
                naga::ConservativeDepth::Unchanged => "unchanged",
            };
            lines.push(format!("layout(depth_{condition}) out float gl_FragDepth;"));
        }
        None => {}
    }
    lines
}

/// Joins all parts. A blank line precedes each top-level item; one-line declarations of a kind stay together.
fn assemble(
    printer: &mut Printer,
    mut stage: Vec<String>,
    interface: Vec<String>,
    bodies: Vec<Vec<String>>,
    versioned: bool,
) -> String {
    stage.extend(printer.requirements.interlock.map(|interlock| format!("layout({interlock}) in;")));
    let (structures, constants, globals) = declarations(printer);
    let helpers: Vec<_> = printer
        .requirements
        .helpers
        .iter()
        .map(|helper| if versioned { helper.text() } else { helper.guarded() })
        .collect();

    let mut sections: Vec<Vec<String>> = Vec::new();
    let mut preamble = Vec::new();
    if versioned {
        preamble.push(if printer.es() { "#version 310 es" } else { "#version 450" }.to_owned());
    }
    preamble
        .extend(printer.requirements.extensions.iter().map(|extension| format!("#extension {extension} : require")));
    sections.push(preamble);
    if versioned && printer.es() {
        // Fragment shaders of ES have no default precision for floats, and a low one for integers.
        sections.push(["precision highp float;", "precision highp int;"].map(str::to_owned).to_vec());
    }
    sections.push(printer.options.header.lines().map(|line| format!("// {line}").trim_end().to_owned()).collect());
    sections.push(stage);
    sections.extend(structures);
    sections.extend(grouped(constants));
    sections.push(interface);
    sections.extend(grouped(globals));
    sections.extend(helpers.iter().map(|text| text.lines().map(str::to_owned).collect()));
    sections.extend(bodies);
    let texts: Vec<String> =
        sections.into_iter().filter(|lines| !lines.is_empty()).map(|lines| lines.join("\n")).collect();
    texts.join("\n\n") + "\n"
}

/// Top-level items, each as its lines.
type Items = Vec<Vec<String>>;

/// Prints structures, constants and globals. Declarations may require further ones, so this repeats until none is new.
fn declarations(printer: &mut Printer) -> (Items, Items, Items) {
    let globals =
        printer.requirements.globals.clone().into_iter().map(|handle| printer.global_declaration(handle)).collect();
    loop {
        let before = (printer.requirements.types.len(), printer.requirements.constants.len());
        let constants = printer
            .requirements
            .constants
            .clone()
            .into_iter()
            .map(|handle| printer.constant_declaration(handle))
            .collect();
        let structures =
            printer.requirements.types.clone().into_iter().map(|handle| printer.structure(handle)).collect();
        if before == (printer.requirements.types.len(), printer.requirements.constants.len()) {
            return (structures, constants, globals);
        }
    }
}

/// Joins consecutive items of one line into one section; each longer item is a section.
fn grouped(items: Items) -> Items {
    let mut sections: Items = Vec::new();
    let mut open = false;
    for item in items {
        let short = item.len() == 1;
        match sections.last_mut() {
            Some(section) if short && open => section.extend(item),
            _ => sections.push(item),
        }
        open = short;
    }
    sections
}
