//! What is checked: a variant on a target, as the programs that really run there.
//!
//! In: a variant, a target, the registry. Out: the plan, one program per stage of every pass, and the functions that read
//! a storage out. The marker functions of the templates become fences and interlocks here, as the target has them.

use fragbuf_targets::{Checked, Target, check};
use fragbuf_codegen::{
    Action, EntryPoint, Form, LineMap, Linking, LoopUntil, PassId, Plan, PlannedPass, Stage, link, plan,
};
use fragbuf_frame::Run;
use fragbuf_interpreter::{Marker, Options, Program, Texture, Unsupported};
use fragbuf_model::{Diagnostic, Diagnostics, Selection, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Fact, Kind, Permits, Soundness};

use crate::question::{question, row};
use crate::read_out::ReadOut;
use crate::stream::StreamPrograms;

/// `templates/shared/markers.wgsl`.
pub(crate) const MARKERS: [(&str, Marker); 4] = [
    ("memory_fence", Marker::Fence),
    ("is_helper_lane", Marker::HelperLane),
    ("critical_begin", Marker::CriticalBegin),
    ("critical_end", Marker::CriticalEnd),
];

/// The name of the pass that is added to a plan whose storage hands fragments on.
const READ_STREAM: &str = "read_stream";

/// From a fragment to the words that are stored.
const PACK: &str = "fragment_pack";

/// Whether a fragment meets every constraint.
const ADMIT: &str = "admit";

/// How often a fragment tries before it gives up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tries {
    /// As the description says; a fragment that waits is taken to wait until something changes.
    AsStated,
    /// As seldom as the row allows: the way of giving up is tried.
    Least,
}

/// A variant on a target, ready to run.
#[derive(Debug)]
pub(crate) struct Subject {
    pub(crate) plan: Plan,
    pub(crate) passes: Vec<Runnable>,
    /// What a pixel holds.
    pub(crate) read_out: ReadOut,
    /// The bound of the storage, where a cull rests on it.
    pub(crate) bound: Option<Program>,
    /// What has left, where the storage hands fragments on.
    pub(crate) stream: Option<StreamPrograms>,
    pub(crate) has_fences: bool,
    /// Whether an interlock lets fragments in by the order of submission.
    pub(crate) has_ordered_interlock: bool,
    /// What every component of every uniform is.
    pub(crate) uniform: f32,
}

/// A pass that computes or draws.
#[derive(Debug)]
pub(crate) struct Runnable {
    pub(crate) pass: PlannedPass,
    pub(crate) id: PassId,
    /// The iteration of the loop around it, where their number is known beforehand: each is tried by itself. Other loops come
    /// back to the pass.
    pub(crate) iteration: Option<u32>,
    /// Whether a loop waits for its samples.
    pub(crate) is_awaited: bool,
    pub(crate) program: Program,
    /// From what the rasteriser gives to words: for a geometry pass.
    pub(crate) fragment: Option<FragmentPrograms>,
    pub(crate) source: Source,
}

/// How a fragment is made of what the rasteriser gives.
#[derive(Debug)]
pub(crate) struct FragmentPrograms {
    pub(crate) unpack: Program,
    /// Where there are constraints.
    pub(crate) admit: Option<Program>,
    /// Not for a pass that only counts.
    pub(crate) pack: Option<Program>,
}

/// A text and where its lines come from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    pub(crate) text: String,
    pub(crate) lines: LineMap,
    /// What lines of no known origin are in; empty for generated text.
    pub(crate) file: String,
}

impl Subject {
    /// Makes everything; the mistakes are the description's, the target's or ours. `None`: there are no bounded tries to
    /// make the least of.
    pub(crate) fn new(
        variant: &Variant,
        target: &Target,
        registry: &Registry,
        tries: Tries,
    ) -> Result<Option<Self>, Diagnostics> {
        let mut offers = target.offers.to_vec();
        offers.push(Capability::OwnEntryPoints);
        let mut selection = variant.select(&offers).map_err(|refusal| {
            let hint = "choose another target, or add an `else` to the axis";
            let text = format!("{} cannot express it: {refusal}", target.name);
            Diagnostics::from(Diagnostic::new(codes::TARGET, &variant.name.origin, text, hint))
        })?;
        if tries == Tries::Least && !make_least(&mut selection) {
            return Ok(None);
        }
        let stream_row = row(READ_STREAM, include_str!("read_stream.wgsl"), "checker/read_stream.wgsl");
        let registry = registry.clone().with(stream_row);
        let plan = plan(variant, &selection, &registry)?;
        let wants_bound = selection.rows.iter().any(|row| row.row.requires.contains(&Fact::BoundAnyInstant));
        let streams = selection.offers().contains(&Fact::Streams);
        let mut asking = plan.clone();
        if streams {
            asking.passes.push(question(&plan, READ_STREAM));
        }
        let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
        let origin = &variant.name.origin;
        let mut passes = Vec::new();
        let mut asked = Vec::new();
        for (number, text) in link(&asking, &linking, &registry)?.passes.into_iter().enumerate() {
            let pass = &asking.passes[number];
            let checked = check(text, target.profile, origin)?;
            match pass.anchor.as_str() {
                READ_STREAM => asked.push(checked),
                _ if pass.kind == Kind::Fullscreen => {}
                _ => {
                    for iteration in iterations(&plan, PassId(number)) {
                        let id = PassId(number);
                        let made = runnable(&plan, (pass, id), &checked);
                        let made = made.map_err(|faults| refused(&checked, &faults, origin))?;
                        passes.push(Runnable { iteration, ..made });
                    }
                }
            }
        }
        passes.sort_by_key(|runnable| order(&plan, runnable));
        let ask = |checked: &Checked, name: &str| {
            Program::function(checked.module(), checked.info(), name, &options(checked))
                .map_err(|faults| refused(checked, &faults, origin))
        };
        let read_out = ReadOut::new(&plan, target.profile, &registry)?;
        let stream = match asked.first() {
            Some(checked) => Some(StreamPrograms {
                streamed: ask(checked, "storage_streamed")?,
                composite: ask(checked, "stream_composite")?,
            }),
            None => None,
        };
        Ok(Some(Subject {
            passes,
            bound: read_out.bound.clone().filter(|_| wants_bound),
            read_out,
            stream,
            has_fences: target.offers.contains(&Capability::Fences),
            has_ordered_interlock: plan.requires.contains(&Capability::OrderedInterlock),
            uniform: 1.0,
            plan,
        }))
    }

    /// What the rows state that may go wrong, hazard by hazard.
    pub(crate) fn permits(&self) -> impl Iterator<Item = &Permits> {
        self.plan.hazards.iter().map(|hazard| &hazard.permits)
    }

    /// Whether fragments may be lost, doubled or torn by design.
    pub(crate) fn is_racy(&self) -> bool {
        self.plan.soundness == Soundness::Racy
    }

    /// Whether fragments can be turned away without being counted as a loss.
    pub(crate) fn turns_away(&self) -> bool {
        self.bound.is_some() || self.is_handed_the_best()
    }

    /// Whether shaders turn fragments away that lie behind what the caller brings.
    pub(crate) fn hides(&self) -> bool {
        self.passes.iter().any(|pass| !pass.program.textures.is_empty())
    }

    /// Whether a row turns fragments away by what the pixel's others are, kept or not.
    pub(crate) fn is_handed_the_best(&self) -> bool {
        self.plan.selection.rows.iter().any(|selected| selected.row.requires.contains(&Fact::BestSuffice))
    }

    /// The number of the memory that a binding is; groups follow each other.
    pub(crate) fn memory_of(binding: Option<(u32, u32)>) -> usize {
        binding.map_or(usize::MAX, |(group, binding)| (group * 64 + binding) as usize)
    }
}

impl Runnable {
    /// Whether a run of a frame is this.
    pub(crate) fn is_of(&self, run: Run) -> bool {
        self.id == run.pass && self.iteration.is_none_or(|iteration| iteration == run.iteration)
    }
}

/// The loops around a command, the innermost last.
fn around(plan: &Plan, command: usize) -> impl Iterator<Item = &fragbuf_codegen::Loop> {
    plan.frame.loops.iter().filter(move |looped| (looped.begin..looped.end).contains(&command))
}

/// The command that runs a pass.
fn command(plan: &Plan, id: PassId) -> usize {
    let is_run = |command: &fragbuf_codegen::Command| command.action == Action::Pass(id);
    plan.frame.commands.iter().position(is_run).unwrap_or(0)
}

/// The iterations in which a pass is tried: each of a loop whose number of them is known when code is generated; one that
/// stands for all of any other loop, or for none.
fn iterations(plan: &Plan, id: PassId) -> Vec<Option<u32>> {
    let Some(looped) = around(plan, command(plan, id)).last() else { return vec![None] };
    let count = plan.symbols.evaluate(&looped.at_most, &|_| None);
    match (looped.until, count.ok().and_then(|count| u32::try_from(count).ok())) {
        (LoopUntil::Times, Some(count)) => (0..count).map(Some).collect(),
        _ => vec![None],
    }
}

/// Where a runnable comes in a frame: the passes of a loop come once in every iteration.
fn order(plan: &Plan, runnable: &Runnable) -> (usize, u32, usize) {
    let at = command(plan, runnable.id);
    let outermost = around(plan, at).next().map_or(at, |looped| looped.begin);
    (outermost, runnable.iteration.unwrap_or(0), at)
}

/// Sets every number of rows that lock to its least; whether there was one.
fn make_least(selection: &mut Selection) -> bool {
    let mut found = false;
    for selected in selection.rows.iter_mut().filter(|selected| selected.row.soundness == Soundness::Lock) {
        found |= !selected.row.parameters.is_empty();
        selected.options = selected.row.parameters.iter().map(|one| (one.name.to_string(), one.range.0)).collect();
    }
    found
}

fn runnable(plan: &Plan, (pass, id): (&PlannedPass, PassId), checked: &Checked) -> Result<Runnable, Vec<Unsupported>> {
    let (module, info) = (checked.module(), checked.info());
    let options = options(checked);
    let stage = if pass.kind == Kind::Geometry { Stage::Fragment } else { Stage::Compute };
    let entry = |entry: &&EntryPoint| entry.stage == stage;
    let name = checked.pass().entry_points.iter().find(entry).map_or("", |entry| entry.name.as_str());
    let program = with_brought(Program::entry_point(module, info, name, &options)?, plan)?;
    // What always holds, and what nothing reads, is not linked.
    let linked = |name: &str| match module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(name))
    {
        true => Program::function(module, info, name, &options).map(Some),
        false => Ok(None),
    };
    let fragment = match stage {
        Stage::Fragment => Some(FragmentPrograms {
            unpack: Program::function(module, info, "varyings_fragment", &options)?,
            admit: linked(ADMIT)?,
            pack: linked(PACK)?,
        }),
        _ => None,
    };
    let source = Source { text: checked.pass().text.clone(), lines: checked.pass().lines.clone(), file: String::new() };
    let is_awaited = plan.frame.waits_for_samples(id);
    Ok(Runnable { pass: pass.clone(), id, iteration: None, is_awaited, program, fragment, source })
}

pub(crate) fn options(checked: &Checked) -> Options<'_> {
    Options { markers: &MARKERS, written_first: &checked.pass().written_first }
}

/// The program, if it reads no textures but those that the caller brings.
fn with_brought(program: Program, plan: &Plan) -> Result<Program, Vec<Unsupported>> {
    let is_brought = |texture: &Texture| {
        let mut brought = plan.resources.iter().filter(|planned| planned.is_brought());
        texture.binding.is_some_and(|(_, binding)| brought.any(|planned| planned.binding == binding))
    };
    if program.textures.iter().all(is_brought) { Ok(program) } else { program.without_textures() }
}

pub(crate) fn refused(checked: &Checked, faults: &[Unsupported], origin: &fragbuf_model::Origin) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    for fault in faults {
        let line = fault.span.location(&checked.pass().text).line_number;
        let text = format!("pass `{}`, line {line}: {fault}", checked.pass().anchor);
        diagnostics.push(Diagnostic::new(codes::INTERNAL, origin, text, "what it does run is in its documentation"));
    }
    diagnostics
}
