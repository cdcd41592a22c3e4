//! A shader's source: parsed, validated and compiled for the interpreter.
//!
//! Input: WGSL source. Output: the programs of the entry point and of the function `holds`, with the module that names its
//! variables. Pipeline-overridable constants have their values.

use fragbuf_codegen::{Profile, SourceMap, too_long};
use fragbuf_interpreter::{Bytecode, LEAST_RETRY_LIMIT, Options, Space, Unsupported};
use fragbuf_model::{Diagnostic, SourceSpan, codes, nearest_name};
use fragbuf_targets::{before_missing_semicolon, causes, explained, validate};
use naga::back::{PipelineConstants, pipeline_constants::process_overrides};
use naga::valid::ModuleInfo;
use naga::{Module, ResourceBinding, ShaderStage, SourceLocation, TypeInner};

use crate::programs::{CheckedSource, MARKERS};
use crate::report::code_location;
use crate::verdict::Error;

use super::{HOLDS, Shader};

/// An entry point that calls `holds`, so that it remains where overrides are replaced by constants.
const CALLER: &str = "fragbuf_calls_holds";

/// The programs of a shader.
pub(super) struct ShaderSource<'a> {
    pub(super) shader: &'a Shader<'a>,
    /// The module of the entry point.
    pub(super) module: Module,
    pub(super) stage: ShaderStage,
    pub(super) program: Bytecode,
    pub(super) holds: Option<Bytecode>,
    pub(super) text: CheckedSource,
}

impl<'a> ShaderSource<'a> {
    pub(super) fn new(shader: &'a Shader<'a>) -> Result<Self, Error> {
        let (module, info) = validated(shader, shader.source)?;
        let stage = entry_stage(&module, shader)?;
        let has_holds = has_holds(&module, shader)?;
        let compiled = |module: &Module, info: &ModuleInfo, is_holds: bool| {
            let options = Options { markers: &MARKERS, ..Options::default() };
            let program = match is_holds {
                true => Bytecode::function(module, info, HOLDS, &options).and_then(Bytecode::without_textures),
                false => Bytecode::entry_point(module, info, shader.entry, &options),
            };
            let program = program.map_err(|unsupported| unsupported_error(&unsupported, shader))?;
            if is_holds && program.buffers.iter().any(|buffer| buffer.space == Space::Workgroup) {
                let text =
                    format!("{}: `{HOLDS}` reads workgroup variables, which end with the workgroup", shader.file);
                return Err(Error::Unable(text));
            }
            Ok(program)
        };
        let text =
            CheckedSource { text: shader.source.to_owned(), lines: SourceMap::default(), file: shader.file.to_owned() };
        if module.overrides.is_empty() && shader.overrides.is_empty() {
            let program = compiled(&module, &info, false)?;
            let holds = has_holds.then(|| compiled(&module, &info, true)).transpose()?;
            return Ok(ShaderSource { shader, module, stage, program, holds, text });
        }
        let values = override_values(&module, shader)?;
        let (constant, constant_info) = without_overrides(&module, &info, (stage, shader.entry), &values, shader)?;
        let program = compiled(&constant, &constant_info, false)?;
        let mut holds = None;
        if has_holds {
            let called = format!("{}\n@compute @workgroup_size(1) fn {CALLER}() {{ _ = {HOLDS}(); }}", shader.source);
            let (module, info) = validated(shader, &called)?;
            let entry = (ShaderStage::Compute, CALLER);
            let (module, info) = without_overrides(&module, &info, entry, &values, shader)?;
            holds = Some(compiled(&module, &info, true)?);
        }
        Ok(ShaderSource { shader, module: constant, stage, program, holds, text })
    }

    /// Returns notes on what the verdict depends on: that nothing states what is right, and loops that are taken to wait.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = self.marker_note().into_iter().collect();
        if self.holds.is_none() {
            notes.push(format!(
                "{} has no `fn {HOLDS}() -> bool`, which would state what is right in the end: nothing checks the final state",
                self.shader.file
            ));
        }
        let mut places: Vec<String> =
            self.program.retry_loops().map(|at| code_location(&self.program, at, &self.text)).collect();
        places.dedup();
        for place in places {
            notes.push(format!(
                "the loop at {place} is taken to wait while another invocation can change what it reads, because it has at least \
                 {LEAST_RETRY_LIMIT} attempts"
            ));
        }
        notes
    }

    /// Returns a note for a check in which no invocation changes memory: the buffers that decide so may lack their words. `None`: the
    /// program has no buffer to write.
    pub(super) fn without_effect(&self) -> Option<String> {
        let buffers = || self.program.buffers.iter().filter(|buffer| buffer.space != Space::Workgroup);
        let named = |is_written: bool| -> Vec<String> {
            let is_filled = |name: &str| self.shader.fill.iter().any(|(filled, _)| filled == name);
            let named = buffers().filter(|buffer| buffer.is_written == is_written);
            named
                .filter(|buffer| is_written || !is_filled(&buffer.name))
                .map(|buffer| format!("`{}`", buffer.name))
                .collect()
        };
        let (written, zero) = (named(true), named(false));
        if written.is_empty() {
            return None;
        }
        let reason = match zero.first() {
            Some(first) => format!(
                ": {} hold only 0 here; give the words of a frame with `--fill`, as `--fill {}=1,1`",
                zero.join(", "),
                first.trim_matches('`')
            ),
            None => String::new(),
        };
        Some(format!("no invocation changes a word of {}, so the check covers little{reason}", written.join(", ")))
    }

    /// Returns a note on functions that stand for what WGSL does not have.
    fn marker_note(&self) -> Option<String> {
        let names: Vec<String> = MARKERS
            .iter()
            .filter(|(_, marker)| self.program.calls(*marker))
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        let (last, before) = names.split_last()?;
        let all = if before.is_empty() { last.clone() } else { format!("{} and {last}", before.join(", ")) };
        let verb = if before.is_empty() { "stands for an operation" } else { "stand for operations" };
        Some(format!("{all} {verb} that WGSL does not have: a browser calls the function as it is written"))
    }
}

/// Gives bindings consecutive numbers, because memory is a list by number. Variables of equal bindings stay together.
fn renumber(module: &mut Module) {
    let mut known = Vec::new();
    for (_, variable) in module.global_variables.iter_mut() {
        let Some(binding) = &mut variable.binding else { continue };
        let number = known.iter().position(|other| other == binding).unwrap_or_else(|| {
            known.push(*binding);
            known.len() - 1
        });
        *binding = ResourceBinding { group: 0, binding: number as u32 };
    }
}

/// Parses and validates source.
fn validated(shader: &Shader<'_>, text: &str) -> Result<(Module, ModuleInfo), Error> {
    if let Some(error) = too_long(text, shader.file) {
        return Err(Error::Description(error.into()));
    }
    let (mut module, info) =
        validate(text, Profile::Native).map_err(|rejection| invalid(shader, rejection.location, rejection.message))?;
    // What is known about a module does not depend on the numbers of bindings.
    renumber(&mut module);
    Ok((module, info))
}

fn invalid(shader: &Shader<'_>, location: Option<SourceLocation>, message: String) -> Error {
    let before = location.and_then(|location| before_missing_semicolon(&message, location, shader.source));
    let span = before.or(location).map_or(SourceSpan::new(shader.file, 1, 1), |at| {
        let line = shader.source.lines().nth(at.line_number.saturating_sub(1) as usize).unwrap_or_default();
        let before = line.get(..at.line_position.saturating_sub(1) as usize).map_or(0, |text| text.chars().count());
        SourceSpan::new(shader.file, at.line_number, before as u32 + 1).with_length(at.length.max(1))
    });
    let (message, help) = explained(&message, shader.source);
    Error::Description(Diagnostic::new(codes::INVALID_WGSL, &span, message, help).into())
}

/// Returns whether the module has the function `holds`, whose signature is checked.
fn has_holds(module: &Module, shader: &Shader<'_>) -> Result<bool, Error> {
    let mut functions = module.functions.iter();
    let Some((handle, function)) = functions.find(|(_, function)| function.name.as_deref() == Some(HOLDS)) else {
        return Ok(false);
    };
    let result = function.result.as_ref().map(|result| &module.types[result.ty].inner);
    let is_bool = matches!(result, Some(TypeInner::Scalar(scalar)) if *scalar == naga::Scalar::BOOL);
    if is_bool && function.arguments.is_empty() {
        return Ok(true);
    }
    let location = module.functions.get_span(handle).location(shader.source);
    Err(invalid(shader, Some(location), format!("`{HOLDS}` has no arguments and returns `bool`")))
}

fn entry_stage(module: &Module, shader: &Shader<'_>) -> Result<ShaderStage, Error> {
    let stages = [ShaderStage::Compute, ShaderStage::Fragment];
    let known = module.entry_points.iter().filter(|entry| stages.contains(&entry.stage));
    let known: Vec<(&str, ShaderStage)> = known.map(|entry| (entry.name.as_str(), entry.stage)).collect();
    if let Some((_, stage)) = known.iter().find(|(name, _)| *name == shader.entry) {
        return Ok(*stage);
    }
    let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
    let others = match &names[..] {
        [] => "it has none".to_owned(),
        names => format!("it has {}", names.join(", ")),
    };
    let near = nearest_name(shader.entry, &names).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    let text = format!("{} has no compute or fragment entry point `{}`: {others}{near}", shader.file, shader.entry);
    Err(Error::Unable(text))
}

/// Returns the values of overrides, by naga's keys.
fn override_values(module: &Module, shader: &Shader<'_>) -> Result<PipelineConstants, Error> {
    let mut values = PipelineConstants::default();
    for (name, value) in shader.overrides {
        let is_named = |id: Option<u16>, own: &Option<String>| {
            own.as_deref() == Some(name) || id.is_some_and(|id| id.to_string() == *name)
        };
        let Some((_, found)) = module.overrides.iter().find(|(_, one)| is_named(one.id, &one.name)) else {
            let known: Vec<&str> = module.overrides.iter().filter_map(|(_, one)| one.name.as_deref()).collect();
            let near = nearest_name(name, &known).map_or(String::new(), |near| format!("did you mean `{near}`? "));
            let known =
                if known.is_empty() { "it has none".to_owned() } else { format!("it has {}", known.join(", ")) };
            return Err(Error::Unable(format!("{} has no override `{name}`: {near}{known}", shader.file)));
        };
        let key = found.id.map_or(found.name.clone(), |id| Some(id.to_string()));
        values.insert(key.unwrap_or_default(), *value);
    }
    Ok(values)
}

/// Tests whether an override has a value.
fn is_given(one: &naga::Override, values: &PipelineConstants) -> bool {
    let key = one.id.map(|id| id.to_string()).or_else(|| one.name.clone());
    key.is_some_and(|key| values.contains_key(&key))
}

/// Replaces overrides by constants, in what an entry point uses.
fn without_overrides(
    module: &Module,
    info: &ModuleInfo,
    entry: (ShaderStage, &str),
    values: &PipelineConstants,
    shader: &Shader<'_>,
) -> Result<(Module, ModuleInfo), Error> {
    let (module, info) = process_overrides(module, info, Some(entry), values).map_err(|error| {
        let without = module.overrides.iter().find(|(_, one)| one.init.is_none() && !is_given(one, values));
        let name = without.and_then(|(_, one)| one.name.clone()).unwrap_or_else(|| "NAME".to_owned());
        let text = format!("{}: {}: give it a value with `--override {name}=1`", shader.file, causes(&error));
        Error::Unable(text)
    })?;
    Ok((module.into_owned(), info.into_owned()))
}

fn unsupported_error(unsupported: &[Unsupported], shader: &Shader<'_>) -> Error {
    let mut messages: Vec<String> = Vec::new();
    // A statement that contains such a construct is reported, too.
    let mut known = Vec::new();
    for one in unsupported {
        let location = one.span.is_defined().then(|| one.span.location(shader.source));
        let line = location.map(|at| at.line_number);
        if known.contains(&(line, &one.what)) {
            continue;
        }
        known.push((line, &one.what));
        messages.push(match location {
            Some(at) => format!("{}:{}:{}: {one}", shader.file, at.line_number, at.line_position),
            None => format!("{}: {one}", shader.file),
        });
    }
    Error::Unable(messages.join("\n"))
}
