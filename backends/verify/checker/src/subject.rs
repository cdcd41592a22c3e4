//! The subject of a check: a variant on a target, as the programs that run there.
//!
//! Input: a variant, a target, the registry. Output: the plan, one program per stage of every pass, and the functions that
//! read a storage out.

use fragbuf_codegen::{Action, Form, Linking, LoopUntil, PassId, Plan, PlannedResource, link, plan};
use fragbuf_interpreter::{Bytecode, LEAST_RETRY_LIMIT};
use fragbuf_model::{Diagnostic, Diagnostics, Selection, SourceSpan, Variant, codes};
use fragbuf_targets::{Checked, Target, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Capability, Feature, Kind, Objects, Parameter, Permits, Row, Soundness};

use crate::dispatches::Dispatches;
use crate::fragments::AttributeValues;
use crate::probe::{probe_pass, probe_row};
use crate::programs::{FullscreenProgram, Runnable, StreamPrograms, diagnostics, fullscreen_program, options};
use crate::read_out::ReadOut;

/// The probe pass of a plan whose storage emits a stream.
const READ_STREAM: &str = "read_stream";

/// How often a fragment retries before it times out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RetryLimit {
    /// As the description says. A fragment that waits is taken to wait until something changes, unless the number is low.
    AsDeclared,
    /// The least that the row allows, so that timeouts are checked.
    Minimum,
}

/// A variant on a target, ready to run.
#[derive(Debug)]
pub(crate) struct Subject {
    pub(crate) plan: Plan,
    pub(crate) passes: Vec<Runnable>,
    /// The fullscreen passes whose textures are all external.
    pub(crate) fullscreen: Vec<FullscreenProgram>,
    /// Reads what a pixel holds.
    pub(crate) read_out: ReadOut,
    /// The bound of the storage, where a cull relies on it.
    pub(crate) bound: Option<Bytecode>,
    /// Reads what a pixel has emitted, where the storage emits a stream.
    pub(crate) stream: Option<StreamPrograms>,
    /// Whether a fragment may time out because the number of its attempts is low.
    pub(crate) may_time_out: bool,
    pub(crate) has_fences: bool,
    /// Whether a compare-exchange of the target may fail although it finds the expected value.
    pub(crate) has_weak_exchange: bool,
    /// Whether an interlock admits fragments in submission order.
    pub(crate) has_ordered_interlock: bool,
    /// The words of the uniform buffer, which alternate.
    pub(crate) uniforms: [u32; 2],
    pub(crate) attributes: AttributeValues,
    pub(crate) dispatches: Dispatches,
}

impl Subject {
    /// Compiles every program. An error is in the description, in the target or internal. `None`: there is no retry limit to
    /// set to its minimum.
    pub(crate) fn new(
        variant: &Variant,
        target: &Target,
        registry: &Registry,
        retries: RetryLimit,
    ) -> Result<Option<Self>, Diagnostics> {
        let mut provides = target.provides.to_vec();
        provides.push(Feature::OwnEntryPoints);
        let mut selection = variant.select(&provides).map_err(|missing| {
            let span = variant.span_of(&missing).unwrap_or(&variant.name.span);
            let help = format!("choose another target, or another value of `{}` after `else`", missing.axis);
            let message = format!("{} cannot express it: {missing}", target.name);
            Diagnostics::from(Diagnostic::new(codes::UNSUPPORTED_TARGET, span, message, help))
        })?;
        if retries == RetryLimit::Minimum && !minimise_retries(&mut selection) {
            return Ok(None);
        }
        let stream_row = probe_row(READ_STREAM, include_str!("read_stream.wgsl"), "checker/read_stream.wgsl");
        let registry = registry.clone().with(stream_row);
        let plan = plan(variant, &selection, &registry)?;
        let may_time_out = has_few_retries(&plan);
        let needs_bound = selection.rows.iter().any(|row| row.row.requires.contains(&Capability::ConservativeBound));
        let (passes, fullscreen, stream) = compiled(&plan, target, &registry)?;
        let read_out = ReadOut::new(&plan, target.profile, &registry)?;
        Ok(Some(Subject {
            passes,
            fullscreen,
            bound: read_out.bound.clone().filter(|_| needs_bound),
            read_out,
            stream,
            may_time_out,
            has_fences: target.provides.contains(&Feature::Fences),
            has_weak_exchange: target.has_weak_exchange,
            has_ordered_interlock: plan.requires.contains(&Feature::OrderedInterlock),
            uniforms: [1.0_f32.to_bits(); 2],
            attributes: AttributeValues::Unit,
            dispatches: Dispatches::default(),
            plan,
        }))
    }

    /// Returns what the rows declare may go wrong, hazard by hazard.
    pub(crate) fn permits(&self) -> impl Iterator<Item = &Permits> {
        self.plan.hazards.iter().map(|hazard| &hazard.permits)
    }

    /// Returns whether fragments may be lost, duplicated or torn by design.
    pub(crate) fn is_racy(&self) -> bool {
        self.plan.soundness == Soundness::Racy
    }

    /// Returns whether every fragment is kept at last, by one of several iterations.
    pub(crate) fn keeps_later(&self) -> bool {
        self.plan.selection.provides().contains(&Capability::KeepsLater)
    }

    /// Returns whether iterations tell fragments with equal keys apart.
    pub(crate) fn tells_ids_apart(&self) -> bool {
        self.plan.selection.provides().contains(&Capability::TellsIdsApart)
    }

    /// Returns the program of a fullscreen pass that reads the storage in every iteration of a loop, and what it reads is kept.
    pub(crate) fn accumulating(&self, id: PassId) -> Option<&FullscreenProgram> {
        let writes = |one: &&FullscreenProgram| one.program.buffers.iter().any(|buffer| buffer.is_written);
        self.fullscreen.iter().find(|one| one.id == id && self.keeps_later()).filter(writes)
    }

    /// Returns whether no accumulating pass of an iteration precedes this one.
    pub(crate) fn is_first_accumulating(&self, id: PassId) -> bool {
        self.fullscreen
            .iter()
            .map(|one| one.id)
            .filter(|one| self.accumulating(*one).is_some())
            .all(|one| one.0 >= id.0)
    }

    /// Returns whether fragments can be culled without being counted as a loss.
    pub(crate) fn culls(&self) -> bool {
        self.bound.is_some() || self.accepts_k_best_only()
    }

    /// Returns whether shaders reject fragments behind the external opaque depth.
    pub(crate) fn reads_opaque_depth(&self) -> bool {
        let is_depth = |name: &str| self.plan.resource(name).is_some_and(PlannedResource::is_opaque_depth);
        let mut uses = self.passes.iter().flat_map(|pass| &pass.pass.uses);
        uses.any(|usage| usage.access == Access::Sampled && is_depth(&usage.resource))
    }

    /// Returns whether a row culls fragments by the other fragments of the pixel, kept or not.
    pub(crate) fn accepts_k_best_only(&self) -> bool {
        self.plan.selection.rows.iter().any(|selected| selected.row.requires.contains(&Capability::AcceptsKBestOnly))
    }

    /// Returns whether the fragments that a pixel holds depend on k. Otherwise it holds all.
    pub(crate) fn keeps_best(&self) -> bool {
        !self.keeps_all() || self.accepts_k_best_only()
    }

    /// Returns whether the storage keeps every fragment that it is given.
    pub(crate) fn keeps_all(&self) -> bool {
        self.plan.selection.kept().is_some_and(|kept| kept.most.is_none())
    }
}

/// The compiled passes of a plan: those that the checker interleaves, fullscreen passes, and the functions of a stream.
type Compiled = (Vec<Runnable>, Vec<FullscreenProgram>, Option<StreamPrograms>);

/// Links, checks and compiles the passes of a plan and, where the storage emits a stream, its functions.
fn compiled(plan: &Plan, target: &Target, registry: &Registry) -> Result<Compiled, Diagnostics> {
    let mut probed = plan.clone();
    if plan.selection.provides().contains(&Capability::Streams) {
        probed.passes.push(probe_pass(plan, READ_STREAM));
    }
    let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
    let span = &plan.variant.name.span;
    let mut passes = Vec::new();
    let mut fullscreen = Vec::new();
    let mut stream = None;
    for (number, source) in link(&probed, &linking, registry)?.passes.into_iter().enumerate() {
        let (pass, id) = (&probed.passes[number], PassId(number));
        let checked = check(source, target.profile, span)?;
        if pass.objects == Objects::Boxes {
            // It writes nothing, and what it drops has no fragment left.
            continue;
        }
        if pass.name == READ_STREAM {
            stream = Some(stream_programs(&checked, span)?);
        } else if pass.kind == Kind::Fullscreen {
            // A pass that samples what another pass drew has no textures here.
            fullscreen.extend(fullscreen_program(plan, id, &checked).ok());
        } else {
            for iteration in iterations(plan, id) {
                let runnable = Runnable::new(plan, (pass, id), &checked);
                let runnable = runnable.map_err(|unsupported| diagnostics(&checked, &unsupported, span))?;
                passes.push(Runnable { iteration, ..runnable });
            }
        }
    }
    passes.sort_by_key(|runnable| position(plan, runnable));
    Ok((passes, fullscreen, stream))
}

fn stream_programs(checked: &Checked, span: &SourceSpan) -> Result<StreamPrograms, Diagnostics> {
    let function = |name: &str| {
        Bytecode::function(checked.module(), checked.info(), name, &options(checked))
            .map_err(|unsupported| diagnostics(checked, &unsupported, span))
    };
    Ok(StreamPrograms { streamed: function("storage_streamed")?, composite: function("stream_composite")? })
}

/// Returns the loops around a command, the innermost last.
fn loops_around(plan: &Plan, command: usize) -> impl Iterator<Item = &fragbuf_codegen::Loop> {
    plan.frame.loops.iter().filter(move |one| (one.begin..one.end).contains(&command))
}

/// Returns the index of the command that runs a pass.
fn command(plan: &Plan, id: PassId) -> usize {
    let is_run = |command: &fragbuf_codegen::Command| command.action == Action::Pass(id);
    plan.frame.commands.iter().position(is_run).unwrap_or(0)
}

/// Returns the iterations in which a pass is checked. Where the number of iterations is known when code is generated, that is
/// each of them. One check stands for all iterations of any other loop, and for a pass outside of loops.
fn iterations(plan: &Plan, id: PassId) -> Vec<Option<u32>> {
    let Some(innermost) = loops_around(plan, command(plan, id)).last() else { return vec![None] };
    let count = plan.symbols.evaluate(&innermost.max_iterations, &|_| None);
    match (innermost.until, count.ok().and_then(|count| u32::try_from(count).ok())) {
        (LoopUntil::Times, Some(count)) => (0..count).map(Some).collect(),
        _ => vec![None],
    }
}

/// Returns the position of a runnable in a frame: the passes of a loop run once in every iteration.
fn position(plan: &Plan, runnable: &Runnable) -> (usize, u32, usize) {
    let at = command(plan, runnable.id);
    let outermost = loops_around(plan, at).next().map_or(at, |one| one.begin);
    (outermost, runnable.iteration.unwrap_or(0), at)
}

/// Returns whether a row has so low a retry limit that the search counts the attempts.
fn has_few_retries(plan: &Plan) -> bool {
    let value = |constant: &str| plan.constants.iter().find(|(name, _)| *name == constant).map(|(_, value)| *value);
    let mut limits = plan.selection.rows.iter().flat_map(|selected| retry_limits(&selected.row));
    limits.any(|limit| value(&limit.constant).is_some_and(|value| value < LEAST_RETRY_LIMIT))
}

/// Sets every retry limit to its minimum; returns whether there was one.
fn minimise_retries(selection: &mut Selection) -> bool {
    let mut found = false;
    for selected in &mut selection.rows {
        for limit in retry_limits(&selected.row) {
            found = true;
            selected.options.retain(|(name, _)| *name != *limit.name);
            selected.options.push((limit.name.to_string(), limit.range.0));
        }
    }
    found
}

fn retry_limits(row: &Row) -> impl Iterator<Item = &Parameter> {
    row.parameters.iter().filter(|parameter| parameter.is_retry_limit)
}
