//! Compiles programs: by fragbuf to one shader for many, and by syn for the evaluator.

use std::collections::HashMap;
use std::fmt::Write;

use fragbuf_model::{Diagnostics, codes};

use super::evaluator::{Function, Outcome, evaluate};
use super::generator::Program;
use super::types::{ATTRIBUTES, FRAGMENTS, Type, UNIFORMS};
use super::value::{Input, Value};

/// The words of a result.
pub const RESULT_WORDS: usize = 4;

/// The diagnostics of a program that fragbuf rejects.
#[derive(Debug)]
pub struct Rejection(Diagnostics);

impl Rejection {
    /// Tests whether a generated program may be rejected like this: rustc accepts it, and some of its constants are out of range.
    pub fn is_expected(&self) -> bool {
        !self.0.is_empty() && self.0.iter().all(|diagnostic| diagnostic.code == codes::OUT_OF_RANGE)
    }
}

impl std::fmt::Display for Rejection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

/// Returns the functions of a program as fragbuf lowers them, or its diagnostics.
pub fn lowered(program: &Program) -> Result<String, Rejection> {
    let parsed = fragbuf_syntax::parse(&program.description(), "compared");
    let draft = match parsed.draft {
        Some(draft) if parsed.diagnostics.is_empty() => draft,
        _ => return Err(Rejection(parsed.diagnostics)),
    };
    let mut wgsl = String::new();
    for function in draft.helpers.iter().chain(&draft.resolve) {
        wgsl.push_str(&function.wgsl.replace("fn user_resolve(", &format!("fn user_{}(", program.name())));
    }
    Ok(wgsl)
}

/// Returns a shader whose invocations run every program on one input each.
pub fn shader(programs: &[(Program, String)]) -> String {
    let mut wgsl = String::new();
    for (name, fields) in [("Fragment", ATTRIBUTES.as_slice()), ("Uniforms", UNIFORMS.as_slice())] {
        let fields: Vec<String> = fields.iter().map(|(name, ty)| format!("    {name}: {},\n", ty.wgsl())).collect();
        let _ = write!(wgsl, "struct {name} {{\n{}}}\n", fields.concat());
    }
    let _ = write!(
        wgsl,
        "@group(0) @binding(0) var<storage, read> inputs: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
var<private> uniforms: Uniforms;
var<private> layers: array<Fragment, {FRAGMENTS}>;
var<private> layers_used: u32;
fn layer(index: u32) -> Fragment {{
    return layers[min(index, {}u)];
}}
fn layer_count() -> u32 {{
    return layers_used;
}}
",
        FRAGMENTS - 1
    );
    for (_, functions) in programs {
        wgsl.push_str(functions);
    }
    wgsl.push_str("@compute @workgroup_size(1)\nfn main(@builtin(global_invocation_id) id: vec3<u32>) {\n");
    let _ = writeln!(wgsl, "    let first = id.x * {}u;", Input::size());
    read_input(&mut wgsl);
    for (at, (program, _)) in programs.iter().enumerate() {
        let arguments = if program.is_resolve { "" } else { "layers[0]" };
        let _ = writeln!(wgsl, "    let r{at} = user_{}({arguments});", program.name());
        let base = format!("(id.x * {}u + {at}u) * {RESULT_WORDS}u", programs.len());
        write_result(&mut wgsl, at, program.result, &base);
    }
    wgsl.push_str("}\n");
    wgsl
}

fn read_input(wgsl: &mut String) {
    let mut at = 0;
    let mut read = |wgsl: &mut String, place: &str, fields: &[(&str, Type)]| {
        for (name, ty) in fields {
            let words: Vec<String> = (0..ty.words()).map(|word| format!("inputs[first + {}u]", at + word)).collect();
            at += ty.words();
            let value = match ty {
                Type::U32 => words[0].clone(),
                Type::Vector(_) => {
                    let parts: Vec<String> = words.iter().map(|word| format!("bitcast<f32>({word})")).collect();
                    format!("{}({})", ty.wgsl(), parts.join(", "))
                }
                _ => format!("bitcast<{}>({})", ty.wgsl(), words[0]),
            };
            let _ = writeln!(wgsl, "    {place}.{name} = {value};");
        }
    };
    read(wgsl, "uniforms", &UNIFORMS);
    for fragment in 0..FRAGMENTS {
        read(wgsl, &format!("layers[{fragment}]"), &ATTRIBUTES);
    }
    let _ = writeln!(wgsl, "    layers_used = inputs[first + {at}u];");
}

fn write_result(wgsl: &mut String, at: usize, ty: Type, base: &str) {
    match ty {
        Type::Vector(size) => {
            for part in ["x", "y", "z", "w"].iter().take(size).enumerate() {
                let _ = writeln!(wgsl, "    results[{base} + {}u] = bitcast<u32>(r{at}.{});", part.0, part.1);
            }
        }
        Type::Bool => {
            let _ = writeln!(wgsl, "    results[{base}] = select(0u, 1u, r{at});");
        }
        _ => {
            let _ = writeln!(wgsl, "    results[{base}] = bitcast<u32>(r{at});");
        }
    }
}

/// A program as syn parses it.
pub struct Parsed {
    functions: HashMap<String, Function>,
    name: String,
    is_resolve: bool,
}

impl Parsed {
    pub fn new(program: &Program) -> Result<Parsed, String> {
        let file = syn::parse_file(&program.rust()).map_err(|error| error.to_string())?;
        let mut functions = HashMap::new();
        for item in file.items {
            if let syn::Item::Fn(function) = item {
                functions.insert(function.sig.ident.to_string(), function_of(function));
            }
        }
        Ok(Parsed { functions, name: program.name(), is_resolve: program.is_resolve })
    }

    /// Evaluates the program.
    pub fn evaluate(&self, input: &Input) -> Outcome {
        let first = match self.is_resolve {
            true => Value::Fragments,
            false => input.layers[0].clone(),
        };
        evaluate(&self.functions, &self.name, vec![first, Value::Uniforms], input)
    }
}

fn function_of(function: syn::ItemFn) -> Function {
    let named = |ty: &syn::Type| match ty {
        syn::Type::Path(path) => path.path.get_ident().and_then(|name| Type::named(&name.to_string())),
        _ => None,
    };
    let parameter = |argument: &syn::FnArg| match argument {
        syn::FnArg::Typed(typed) => match &*typed.pat {
            syn::Pat::Ident(name) => Some((name.ident.to_string(), named(&typed.ty))),
            _ => None,
        },
        syn::FnArg::Receiver(_) => None,
    };
    let result = match &function.sig.output {
        syn::ReturnType::Type(_, ty) => named(ty),
        syn::ReturnType::Default => None,
    };
    let parameters = function.sig.inputs.iter().filter_map(parameter).collect();
    Function { parameters, result, body: *function.block }
}
