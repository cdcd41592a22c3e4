//! Links a plan to a program: one WGSL source per pass, with a source map.

mod instances;

use fragbuf_model::{Diagnostic, Diagnostics, SelectedRow, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Kind, Pass};

use crate::link::{self, Source};
use crate::{EntryPoint, Form, GENERATOR, Linking, Plan, Profile, SourceMap, UserBuffer, emit};

/// The linked sources of a plan. The plan describes how to run them.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The parameters of linking.
    pub linking: Linking,
    /// One source per pass, in the order of the plan's passes.
    pub passes: Vec<PassSource>,
}

/// The source of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassSource {
    /// The name of the pass.
    pub name: String,
    /// The WGSL source.
    pub text: String,
    /// The origin of each line.
    pub lines: SourceMap,
    /// Its entry points, in source order.
    pub entry_points: Vec<EntryPoint>,
    /// The functions that a caller's shader calls, in module form.
    pub exports: Vec<String>,
    /// Names of the resources that the source declares.
    pub resources: Vec<String>,
    /// Names of private arrays whose elements are written before they are read, so that no target needs to set them to zero. This
    /// holds for every array of a template: the CPU device and the checker fill them with 0xdeadbeef, so that tests fail
    /// otherwise. User files may rely on zeros.
    pub written_first: Vec<String>,
    /// Names of functions whose atomic loads and stores may be plain accesses of coherent words, because only the critical section
    /// calls them. Empty where the language cannot access a word in both ways.
    pub guarded: Vec<String>,
    /// The buffers of user files, for messages about the files.
    pub user_buffers: Vec<UserBuffer>,
    /// Generator and algorithms, for targets that lose the comments of templates.
    pub notes: Notes,
}

/// Comments for the header of a file, without comment signs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// Technique, generator and choices other than the defaults.
    pub generated: String,
    /// The printed headers of templates that implement papers.
    pub algorithms: String,
}

/// Links every pass of a plan.
pub fn link(plan: &Plan, linking: &Linking, registry: &Registry) -> Result<Program, Diagnostics> {
    let mut passes = Vec::new();
    let mut diagnostics = Diagnostics::new();
    for pass in &plan.passes {
        match link_pass(plan, pass, linking, registry) {
            Ok(source) => passes.push(source),
            Err(error) => diagnostics.push(diagnostic(plan, pass, &error)),
        }
    }
    diagnostics.into_result(Program { linking: linking.clone(), passes })
}

fn diagnostic(plan: &Plan, pass: &Pass, error: &link::LinkError) -> Diagnostic {
    match &error.user_line {
        Some(span) => {
            let help = "names must be unique in a program: begin private names with the name of the file";
            Diagnostic::new(codes::INVALID_WGSL, span, &error.problem, help)
        }
        None => Diagnostic::new(
            codes::INTERNAL,
            &plan.variant.name.span,
            format!("pass `{}`: {}", pass.name, error.problem),
            "report this defect with the description; a row of your own must implement the contracts of its axis",
        ),
    }
}

fn link_pass(plan: &Plan, pass: &Pass, linking: &Linking, registry: &Registry) -> Result<PassSource, link::LinkError> {
    let is_library = linking.form == Form::Module && pass.kind == Kind::Geometry;
    let stage = match pass.kind {
        Kind::Geometry if !is_library => Some("geometry"),
        Kind::Fullscreen => Some("fullscreen"),
        _ => None,
    };
    let no_renames = link::Renames::default();
    let implementations = instances::sources(pass, plan, registry)?;
    // A shared function implements a contract where no row does.
    let implemented: Vec<&'static str> = implementations.iter().flat_map(Source::implemented).collect();
    let shared = registry.shared().iter();
    let shared = shared.map(|template| Source::template(template, &no_renames).without(implemented.clone()));
    let mut templates: Vec<Source> = shared.chain(implementations).collect();
    if let Some(stage) = stage {
        templates.push(instances::skeleton(stage, registry)?);
    }
    let skeleton = instances::skeleton(&pass.skeleton, registry)?;
    let is_early = pass.state.depth.as_ref().is_some_and(|depth| depth.early);
    let export = export(&pass.skeleton, &skeleton);
    templates.push(if is_early { skeleton.with_early_depth()? } else { skeleton });
    let called: Vec<String> = templates.iter().flat_map(Source::further_accessors).collect();
    let mut sources = emit::sources(plan, pass, linking, &called);
    sources.extend(templates);
    let exports: Vec<&str> = if is_library { vec![&export] } else { Vec::new() };
    let prefix = if linking.prefix.is_empty() { String::new() } else { format!("{}_", linking.prefix) };
    let generated = generated(plan, registry);
    let header = format!("{}\n{}", commented(&generated), enabled(&sources));
    let linked = link::link(&header, &sources, &exports, &prefix)?;
    let notes = Notes { generated, algorithms: instances::algorithms(pass, plan, registry, &linked.headers)? };
    Ok(PassSource {
        name: pass.name.clone(),
        text: format!("{}\n", linked.text.trim_end()),
        lines: linked.lines,
        entry_points: linked.entry_points,
        exports: exports.iter().map(|name| format!("{prefix}{name}")).collect(),
        resources: plan
            .resources
            .iter()
            .map(|planned| &planned.resource.name)
            .filter(|name| linked.declared.contains(*name))
            .cloned()
            .collect(),
        written_first: linked.private_arrays,
        guarded: guarded(pass, linking, &prefix),
        user_buffers: emit::user_buffers(plan, pass),
        notes,
    })
}

/// Returns the accessors whose atomic loads and stores may be plain.
fn guarded(pass: &Pass, linking: &Linking, prefix: &str) -> Vec<String> {
    let hinted = pass.uses.iter().filter(|usage| usage.access == Access::Hinted && linking.profile == Profile::Native);
    hinted.flat_map(|usage| ["load", "store"].map(|access| format!("{prefix}{}_{access}", usage.resource))).collect()
}

/// Returns the function that a module exports: `NAME_fragment`. A form of a skeleton (`store_reserving`) exports the function of the
/// skeleton (`store_fragment`).
fn export(name: &str, skeleton: &Source) -> String {
    let mut base = name;
    loop {
        let export = format!("{base}_fragment");
        match base.rsplit_once('_') {
            Some((shorter, _)) if !skeleton.mentions(&format!("fn {export}(")) => base = shorter,
            _ => return export,
        }
    }
}

/// Returns the choices that a file is generated from. Defaults of axes are omitted, so that a new axis changes no file.
fn generated(plan: &Plan, registry: &Registry) -> String {
    let name = plan.variant.technique.as_deref().unwrap_or(&plan.variant.name.value);
    let mut text = format!("{name}, generated by {GENERATOR}.\n");
    for SelectedRow { row, options } in &plan.selection.rows {
        let is_default = registry.axis(&row.axis).and_then(|axis| axis.default) == Some(&*row.key);
        let options: Vec<String> = options.iter().map(|(name, value)| format!("{name}: {value}")).collect();
        text.push_str(&match options.as_slice() {
            [] if is_default => continue,
            [] => format!("    {}: {}\n", row.axis, row.key),
            options => format!("    {}: {} {{ {} }}\n", row.axis, row.key, options.join(", ")),
        });
    }
    text
}

/// Returns the WGSL directives that the sources require.
fn enabled(sources: &[Source]) -> &'static str {
    if sources.iter().any(|source| source.mentions("builtin(primitive_index)")) {
        "enable primitive_index;\n\n"
    } else {
        ""
    }
}

/// Returns each line as a comment.
fn commented(lines: &str) -> String {
    lines.lines().map(|line| format!("// {line}\n")).collect()
}
