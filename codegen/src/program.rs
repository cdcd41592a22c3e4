//! A plan as text: one WGSL text per pass, every line with where it comes from.

mod instances;

use std::sync::Arc;

use fragbuf_model::{Diagnostic, Diagnostics, Origin, Selected, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Kind, Pass};

use crate::link::{self, Source};
use crate::{GENERATOR, Plan, emit};

/// How texts are linked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Linking {
    /// What the text may use.
    pub profile: Profile,
    /// What it is for.
    pub form: Form,
    /// Before every name but the entry points', so that two buffers can share a shader.
    pub prefix: String,
    /// The bind group of everything declared.
    pub group: u32,
}

/// What a WGSL text may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Profile {
    /// The WGSL standard: browsers take it.
    Portable,
    /// naga's additions too: coherent buffers.
    Native,
}

/// What a text is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Entry points for every pass.
    Program,
    /// Geometry passes as functions for a shader of the caller's own; the other passes with their entry points.
    Module,
}

/// A plan, linked: its texts. The plan itself says what to do with them.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// How it was linked.
    pub linking: Linking,
    /// One per pass, in the order of the steps.
    pub passes: Vec<PassText>,
}

/// The text of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassText {
    /// The pass.
    pub anchor: String,
    /// WGSL.
    pub text: String,
    /// Where its lines come from.
    pub lines: LineMap,
    /// Its entry points, in the order of the text.
    pub entry_points: Vec<EntryPoint>,
    /// The functions that a caller's shader calls, in module form.
    pub exports: Vec<String>,
    /// Resources that the text declares, by name.
    pub resources: Vec<String>,
    /// Private arrays whose elements are written before they are read, by name: no target needs to set them to zero. All
    /// arrays of templates are, and the CPU device and the checker begin them with words that no program means, so that their
    /// tests fail otherwise. A file of the user's own may rely on zeros.
    pub written_first: Vec<String>,
    /// Who made it and what the algorithms linked into it rest on, for texts that lose the templates' comments.
    pub notes: Notes,
}

/// Comments for the head of a file, lines without a comment sign.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// Technique, generator and choices other than the defaults.
    pub generated: String,
    /// The printed heads of the templates that come from papers.
    pub algorithms: String,
}

/// An entry point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EntryPoint {
    /// Its name in the text.
    pub name: String,
    /// Its stage.
    pub stage: Stage,
}

/// A shader stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Vertex.
    Vertex,
    /// Fragment.
    Fragment,
    /// Compute.
    Compute,
}

/// Where each line of a text comes from: runs of lines that follow each other in one source, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineMap {
    lines: usize,
    runs: Vec<Run>,
}

/// Lines from `first` on (from 1) up to the next run.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    first: usize,
    origin: LineOrigin,
}

/// Where one line comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum LineOrigin {
    /// Headers, banners and blank lines.
    None,
    /// A template or generated text, by its name and line.
    Source {
        /// `storage/max_array.wgsl`, `generated/buffers`.
        name: Arc<str>,
        /// From 1.
        line: usize,
    },
    /// The user's description.
    User(Origin),
    /// A WGSL file of the user's own, from the line's first sign to its last: the same text, unless it was renamed.
    Own(Origin),
}

impl LineMap {
    /// Lines that come from nowhere.
    pub(crate) fn skip(&mut self, lines: usize) {
        self.run(lines, LineOrigin::None);
    }

    /// Lines of which the first comes from `origin`, and those after it from the lines after that.
    pub(crate) fn run(&mut self, lines: usize, origin: LineOrigin) {
        self.runs.push(Run { first: self.lines + 1, origin });
        self.lines += lines;
    }

    /// The origin of a line, counted from 1.
    pub fn origin(&self, line: usize) -> LineOrigin {
        let index = self.runs.partition_point(|run| run.first <= line);
        let Some(run) = index.checked_sub(1).map(|index| &self.runs[index]).filter(|_| line <= self.lines) else {
            return LineOrigin::None;
        };
        match &run.origin {
            LineOrigin::Source { name, line: first } => {
                LineOrigin::Source { name: name.clone(), line: first + line - run.first }
            }
            other => other.clone(),
        }
    }
}

/// Links every pass of a plan.
pub fn link(plan: &Plan, linking: &Linking, registry: &Registry) -> Result<Program, Diagnostics> {
    let mut passes = Vec::new();
    let mut diagnostics = Diagnostics::new();
    for pass in &plan.passes {
        match link_pass(plan, pass, linking, registry) {
            Ok(text) => passes.push(text),
            Err(fault) => diagnostics.push(unlinkable(plan, pass, &fault)),
        }
    }
    diagnostics.gate(Program { linking: linking.clone(), passes })
}

fn unlinkable(plan: &Plan, pass: &Pass, fault: &link::Fault) -> Diagnostic {
    match &fault.own {
        Some(origin) => {
            let hint = "every file of a program has its own names: begin private ones with the name of the file";
            Diagnostic::new(codes::REFUSED, origin, &fault.problem, hint)
        }
        None => Diagnostic::new(
            codes::INTERNAL,
            &plan.variant.name.origin,
            format!("pass `{}`: {}", pass.anchor, fault.problem),
            "report it with the description; a row of your own must fulfil the contract of its axis",
        ),
    }
}

fn link_pass(plan: &Plan, pass: &Pass, linking: &Linking, registry: &Registry) -> Result<PassText, link::Fault> {
    let is_library = linking.form == Form::Module && pass.kind == Kind::Geometry;
    let stage_text = match pass.kind {
        Kind::Geometry if !is_library => Some("geometry"),
        Kind::Fullscreen => Some("fullscreen"),
        _ => None,
    };
    let no_renames = link::Renames::default();
    let own = instances::sources(pass, plan, registry)?;
    // A shared function serves a contract where no row has one of its own.
    let fulfilled: Vec<&'static str> = own.iter().flat_map(Source::fulfilled).collect();
    let shared = registry.shared().iter();
    let shared = shared.map(|text| Source::template(text, &no_renames).leaving(fulfilled.clone()));
    let mut templates: Vec<Source> = shared.chain(own).collect();
    if let Some(stage) = stage_text {
        templates.push(instances::skeleton(stage, registry)?);
    }
    let skeleton = instances::skeleton(&pass.skeleton, registry)?;
    let is_early = pass.state.depth.as_ref().is_some_and(|depth| depth.early);
    templates.push(if is_early { skeleton.with_early_depth()? } else { skeleton });
    let atomics: Vec<String> = templates.iter().flat_map(Source::atomic_accessors).collect();
    let mut sources = emit::sources(plan, pass, linking, &atomics);
    sources.extend(templates);
    // Forms of a skeleton (`store_reserving`) offer a caller's shader the same function.
    let export = format!("{}_fragment", pass.skeleton.split('_').next().unwrap_or_default());
    let exports: Vec<&str> = if is_library { vec![&export] } else { Vec::new() };
    let prefix = if linking.prefix.is_empty() { String::new() } else { format!("{}_", linking.prefix) };
    let generated = generated(plan, registry);
    let header = format!("{}\n{}", commented(&generated), enabled(&sources));
    let linked = link::link(&header, &sources, &exports, &prefix)?;
    let notes = Notes { generated, algorithms: instances::algorithms(pass, plan, registry, &linked.heads)? };
    Ok(PassText {
        anchor: pass.anchor.clone(),
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
        notes,
    })
}

/// What a file is made from. Choices that are their axis' default are left out, so that a new axis changes no file.
fn generated(plan: &Plan, registry: &Registry) -> String {
    let name = plan.variant.technique.as_deref().unwrap_or(&plan.variant.name.value);
    let mut text = format!("{name}, generated by {GENERATOR}.\n");
    for Selected { row, options } in &plan.selection.rows {
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

/// What WGSL wants to be told at the top of a text: directives for words that some source uses.
fn enabled(sources: &[Source]) -> &'static str {
    if sources.iter().any(|source| source.mentions("builtin(primitive_index)")) {
        "enable primitive_index;\n\n"
    } else {
        ""
    }
}

/// Each line as a comment.
fn commented(lines: &str) -> String {
    lines.lines().map(|line| format!("// {line}\n")).collect()
}
