//! What is checked: a variant on a target, as the programs that really run there.
//!
//! In: a variant, a target, the registry. Out: the plan, one program per stage of every pass, and the functions that read
//! a storage out. The marker functions of the templates become fences and interlocks here, as the target has them.

use fragbuf_backends::{Checked, Target, check};
use fragbuf_codegen::{EntryPoint, Form, LineMap, Linking, Plan, Stage, link, plan};
use fragbuf_interpreter::{Marker, Options, Program, Texture, Unsupported};
use fragbuf_model::{Diagnostic, Diagnostics, Selection, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Capability, Fact, Kind, Pass, Permits, Row, Soundness, Step, Template, Use,
};

use crate::stream::StreamPrograms;
use crate::turns::{Turn, turns};

/// `templates/shared/markers.wgsl`.
pub(crate) const MARKERS: [(&str, Marker); 4] = [
    ("memory_fence", Marker::Fence),
    ("is_helper_lane", Marker::HelperLane),
    ("critical_begin", Marker::CriticalBegin),
    ("critical_end", Marker::CriticalEnd),
];

/// Names of the passes that are added to a plan to ask questions.
const READ_OUT: &str = "read_out";
const READ_BOUND: &str = "read_bound";
const READ_STREAM: &str = "read_stream";

/// From a fragment to the words that are stored.
const PACK: &str = "fragment_pack";

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
    pub(crate) turns: Vec<Turn>,
    pub(crate) passes: Vec<Runnable>,
    /// The cursor after so many fragments of a pixel.
    pub(crate) walk: Program,
    pub(crate) read: Program,
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
    pub(crate) pass: Pass,
    /// Its place among the subject's turns, and the round of the loop that has been written out around it.
    pub(crate) turn: usize,
    pub(crate) round: u32,
    pub(crate) program: Program,
    /// From what the rasteriser gives to words: for a geometry pass.
    pub(crate) fragment: Option<FragmentPrograms>,
    pub(crate) source: Source,
}

/// How a fragment is made of what the rasteriser gives.
#[derive(Debug)]
pub(crate) struct FragmentPrograms {
    pub(crate) unpack: Program,
    pub(crate) admit: Program,
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
        let registry = registry
            .clone()
            .with(row(READ_OUT, include_str!("read_out.wgsl"), "checker/read_out.wgsl"))
            .with(row(READ_BOUND, include_str!("read_bound.wgsl"), "checker/read_bound.wgsl"))
            .with(row(READ_STREAM, include_str!("read_stream.wgsl"), "checker/read_stream.wgsl"));
        let plan = plan(variant, &selection, &registry)?;
        let wants_bound = selection.rows.iter().any(|row| row.row.requires.contains(&Fact::BoundAnyInstant));
        let streams = selection.offers().contains(&Fact::Streams);
        let mut asking = plan.clone();
        for (anchor, is_asked) in [(READ_OUT, true), (READ_BOUND, wants_bound), (READ_STREAM, streams)] {
            if is_asked {
                asking.steps.push(Step::Pass(question(&plan, anchor)));
            }
        }
        let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
        let origin = &variant.name.origin;
        let turns = turns(&plan).map_err(|error| {
            let text = format!("the checker cannot run it: {error}");
            Diagnostics::from(Diagnostic::new(codes::INTERNAL, origin, text, "what it runs is in its documentation"))
        })?;
        let mut passes = Vec::new();
        let mut asked = Vec::new();
        for (text, pass) in link(&asking, &linking, &registry)?.passes.into_iter().zip(asking.passes()) {
            let checked = check(text, target.profile, origin)?;
            match pass.anchor.as_str() {
                READ_OUT | READ_BOUND | READ_STREAM => asked.push(checked),
                _ if pass.kind == Kind::Fullscreen => {}
                _ => {
                    for (turn, round) in turns.iter().enumerate().filter_map(|(at, turn)| round_of(at, turn, pass)) {
                        let made =
                            runnable(&plan, pass, &checked).map_err(|faults| refused(&checked, &faults, origin))?;
                        passes.push(Runnable { turn, round, ..made });
                    }
                }
            }
        }
        passes.sort_by_key(|runnable| runnable.turn);
        let ask = |anchor: &str, name: &str| {
            let checked = asked.iter().find(|checked| checked.pass().anchor == anchor);
            let checked: &Checked = checked.unwrap_or(&asked[0]);
            Program::function(checked.module(), checked.info(), name, &Options { markers: &MARKERS })
                .map_err(|faults| refused(checked, &faults, origin))
        };
        let stream = match streams {
            true => Some(StreamPrograms {
                streamed: ask(READ_STREAM, "storage_streamed")?,
                composite: ask(READ_STREAM, "stream_composite")?,
            }),
            false => None,
        };
        Ok(Some(Subject {
            passes,
            walk: ask(READ_OUT, "walk_to")?,
            read: ask(READ_OUT, "storage_read")?,
            bound: if wants_bound { Some(ask(READ_BOUND, "storage_bound")?) } else { None },
            stream,
            has_fences: target.offers.contains(&Capability::Fences),
            has_ordered_interlock: plan.requires.contains(&Capability::OrderedInterlock),
            uniform: 1.0,
            turns,
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

/// The turn's number and round, if it is of the pass.
fn round_of(at: usize, turn: &Turn, pass: &Pass) -> Option<(usize, u32)> {
    match turn {
        Turn::Step { step: Step::Pass(other), round } if other.anchor == pass.anchor => Some((at, *round)),
        _ => None,
    }
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

fn row(key: &str, text: &'static str, path: &'static str) -> Row {
    Row {
        template: Some(Template::new(path, text)),
        calls: vec!["addressing", "storage"],
        ..Row::new("pass", key, "what the checker asks", "")
    }
}

/// A pass that reads everything that the plan's passes touch, with their roles.
fn question(plan: &Plan, anchor: &str) -> Pass {
    let mut pass = Pass::compute(anchor, anchor, "1", "1");
    let mut passes = plan.passes();
    // What reads a pixel out in the frame itself may count: its resources are touched as there.
    if let Some(resolve) = passes.iter().rposition(|pass| pass.kind == Kind::Fullscreen) {
        let resolve = passes.remove(resolve);
        let in_shader = |usage: &&Use| matches!(usage.access, Access::Read | Access::Atomic);
        pass.uses = resolve.uses.iter().filter(in_shader).cloned().collect();
    }
    for other in passes {
        for role in &other.roles {
            if !pass.roles.iter().any(|known| known.contract == role.contract) {
                pass.roles.push(role.clone());
            }
        }
        for usage in &other.uses {
            let in_shader = matches!(usage.access, Access::Read | Access::Plain | Access::Atomic | Access::Coherent);
            if in_shader && !pass.uses.iter().any(|known| known.resource == usage.resource) {
                pass.uses.push(Use::new(&usage.resource, Access::Read));
            }
        }
    }
    pass
}

fn runnable(plan: &Plan, pass: &Pass, checked: &Checked) -> Result<Runnable, Vec<Unsupported>> {
    let (module, info) = (checked.module(), checked.info());
    let options = Options { markers: &MARKERS };
    let stage = if pass.kind == Kind::Geometry { Stage::Fragment } else { Stage::Compute };
    let entry = |entry: &&EntryPoint| entry.stage == stage;
    let name = checked.pass().entry_points.iter().find(entry).map_or("", |entry| entry.name.as_str());
    let program = with_brought(Program::entry_point(module, info, name, &options)?, plan)?;
    let fragment = match stage {
        Stage::Fragment => Some(FragmentPrograms {
            unpack: Program::function(module, info, "varyings_fragment", &options)?,
            admit: Program::function(module, info, "admit", &options)?,
            pack: match module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(PACK)) {
                true => Some(Program::function(module, info, PACK, &options)?),
                false => None,
            },
        }),
        _ => None,
    };
    let source = Source { text: checked.pass().text.clone(), lines: checked.pass().lines.clone(), file: String::new() };
    Ok(Runnable { pass: pass.clone(), turn: 0, round: 0, program, fragment, source })
}

/// The program, if it reads no textures but those that the caller brings.
fn with_brought(program: Program, plan: &Plan) -> Result<Program, Vec<Unsupported>> {
    let is_brought = |texture: &Texture| {
        let mut brought = plan.resources.iter().filter(|planned| planned.is_brought());
        texture.binding.is_some_and(|(_, binding)| brought.any(|planned| planned.binding == binding))
    };
    if program.textures.iter().all(is_brought) { Ok(program) } else { program.without_textures() }
}

fn refused(checked: &Checked, faults: &[Unsupported], origin: &fragbuf_model::Origin) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    for fault in faults {
        let line = fault.span.location(&checked.pass().text).line_number;
        let text = format!("pass `{}`, line {line}: {fault}", checked.pass().anchor);
        diagnostics.push(Diagnostic::new(codes::INTERNAL, origin, text, "what it does run is in its documentation"));
    }
    diagnostics
}
