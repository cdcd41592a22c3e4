//! Programs of a plan, compiled from checked passes for the interpreter.
//!
//! Input: a pass that naga has checked. Output: its bytecode, and that of the functions that the checker calls by name. The
//! marker functions of the templates become fences and interlocks here, as the target supports them.

use fragbuf_codegen::{EntryPoint, PassId, Plan, PlannedPass, SourceMap, Stage};
use fragbuf_frame::PassRun;
use fragbuf_interpreter::{Bytecode, Marker, Options, Texture, Unsupported};
use fragbuf_model::{Diagnostic, Diagnostics, SourceSpan, codes};
use fragbuf_targets::Checked;
use fragbuf_templates::vocabulary::Kind;

/// The functions of `templates/shared/markers.wgsl`.
pub(crate) const MARKERS: [(&str, Marker); 4] = [
    ("memory_fence", Marker::Fence),
    ("is_helper_lane", Marker::HelperLane),
    ("critical_begin", Marker::CriticalBegin),
    ("critical_end", Marker::CriticalEnd),
];

/// The function from a fragment to the words that are stored.
const PACK: &str = "fragment_pack";

/// The function that returns whether a fragment meets every constraint.
const ADMIT: &str = "admit";

/// A pass that computes or draws.
#[derive(Debug)]
pub(crate) struct Runnable {
    pub(crate) pass: PlannedPass,
    pub(crate) id: PassId,
    /// The iteration of the loop around it, where the number of iterations is known beforehand: each is checked by itself.
    /// Other loops return to the pass.
    pub(crate) iteration: Option<u32>,
    /// Whether a loop waits for its samples.
    pub(crate) is_awaited: bool,
    pub(crate) program: Bytecode,
    /// From the rasteriser's output to words: for a geometry pass.
    pub(crate) fragment: Option<FragmentPrograms>,
    pub(crate) source: CheckedSource,
}

/// The functions that turn the rasteriser's output into the words of a fragment.
#[derive(Debug)]
pub(crate) struct FragmentPrograms {
    pub(crate) unpack: Bytecode,
    /// Where there are constraints.
    pub(crate) admit: Option<Bytecode>,
    /// Absent in a pass that only counts.
    pub(crate) pack: Option<Bytecode>,
}

/// The functions of a storage that emits fragments in a stream.
#[derive(Debug)]
pub(crate) struct StreamPrograms {
    /// Returns the colour that a pixel has emitted.
    pub(crate) streamed: Bytecode,
    /// Composites the segment between two consecutive fragments onto a colour.
    pub(crate) composite: Bytecode,
}

/// The source of a checked program, with the origin of each line.
#[derive(Clone, Debug, Default)]
pub(crate) struct CheckedSource {
    pub(crate) text: String,
    pub(crate) lines: SourceMap,
    /// The file of lines without a known span; empty for generated source.
    pub(crate) file: String,
}

impl CheckedSource {
    /// Returns the source of a checked pass.
    pub(crate) fn of(checked: &Checked) -> Self {
        let (text, lines) = (checked.pass().text.clone(), checked.pass().lines.clone());
        CheckedSource { text, lines, file: String::new() }
    }
}

impl Runnable {
    /// Compiles a pass, outside of any iteration.
    pub(crate) fn new(
        plan: &Plan,
        (pass, id): (&PlannedPass, PassId),
        checked: &Checked,
    ) -> Result<Self, Vec<Unsupported>> {
        let (module, info) = (checked.module(), checked.info());
        let options = options(checked);
        let stage = if pass.kind == Kind::Geometry { Stage::Fragment } else { Stage::Compute };
        let entry = |entry: &&EntryPoint| entry.stage == stage;
        let name = checked.pass().entry_points.iter().find(entry).map_or("", |entry| entry.name.as_str());
        let program = with_external_textures(Bytecode::entry_point(module, info, name, &options)?, plan)?;
        // The linker drops a function whose result is constant or unused.
        let linked =
            |name: &str| match module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(name)) {
                true => Bytecode::function(module, info, name, &options).map(Some),
                false => Ok(None),
            };
        let fragment = match stage {
            Stage::Fragment => Some(FragmentPrograms {
                unpack: Bytecode::function(module, info, "fragment_from_inputs", &options)?,
                admit: linked(ADMIT)?,
                pack: linked(PACK)?,
            }),
            _ => None,
        };
        let source = CheckedSource::of(checked);
        let is_awaited = plan.frame.waits_for_samples(id);
        Ok(Runnable { pass: pass.clone(), id, iteration: None, is_awaited, program, fragment, source })
    }

    /// Returns whether a run of a frame runs this.
    pub(crate) fn is_of(&self, run: PassRun) -> bool {
        self.id == run.pass && self.iteration.is_none_or(|iteration| iteration == run.iteration)
    }
}

/// The fragment stage of a fullscreen pass.
#[derive(Debug)]
pub(crate) struct FullscreenProgram {
    pub(crate) pass: String,
    pub(crate) id: PassId,
    pub(crate) program: Bytecode,
}

/// Compiles the fragment stage of a fullscreen pass.
pub(crate) fn fullscreen_program(
    plan: &Plan,
    id: PassId,
    checked: &Checked,
) -> Result<FullscreenProgram, Vec<Unsupported>> {
    let is_fragment = |entry: &&EntryPoint| entry.stage == Stage::Fragment;
    let name = checked.pass().entry_points.iter().find(is_fragment).map_or("", |entry| entry.name.as_str());
    let program = Bytecode::entry_point(checked.module(), checked.info(), name, &options(checked))?;
    Ok(FullscreenProgram { pass: checked.pass().name.clone(), id, program: with_external_textures(program, plan)? })
}

/// Returns the options that compile a checked pass. Guarded accesses are plain, as in the weakest target of the profile.
pub(crate) fn options(checked: &Checked) -> Options<'_> {
    let pass = checked.pass();
    Options {
        markers: &MARKERS,
        written_first: &pass.written_first,
        writes_workgroup_first: true,
        plain_functions: &pass.guarded,
    }
}

/// Returns the program if all textures that it reads are external.
fn with_external_textures(program: Bytecode, plan: &Plan) -> Result<Bytecode, Vec<Unsupported>> {
    let is_external = |texture: &Texture| {
        let mut external = plan.resources.iter().filter(|planned| planned.is_external());
        texture.binding.is_some_and(|(_, binding)| external.any(|planned| planned.binding == binding))
    };
    if program.textures.iter().all(is_external) { Ok(program) } else { program.without_textures() }
}

/// Turns what the interpreter does not support in a pass into diagnostics.
pub(crate) fn diagnostics(checked: &Checked, unsupported: &[Unsupported], span: &SourceSpan) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    for one in unsupported {
        let line = one.span.location(&checked.pass().text).line_number;
        let message = format!("pass `{}`, line {line}: {one}", checked.pass().name);
        let help = "the documentation of the interpreter lists what it supports";
        diagnostics.push(Diagnostic::new(codes::INTERNAL, span, message, help));
    }
    diagnostics
}
